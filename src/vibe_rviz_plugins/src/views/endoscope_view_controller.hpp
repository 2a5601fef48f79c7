#pragma once
#include <rviz/view_controller.h>

#include <memory>

#include "vibe_graphics/graphics/endoscope_lens.hpp"

namespace rviz {
class BoolProperty;
class EnumProperty;
class StringProperty;
class TfFrameProperty;
}  // namespace rviz

namespace vibe::rviz_plugins {

/// View of rviz from the camera at the tip of the endoscope, which it follows: what the trainee sees.
class EndoscopeViewController : public rviz::ViewController {
  Q_OBJECT
 public:
  EndoscopeViewController();
  ~EndoscopeViewController() override;

  void update(float dt, float ros_dt) override;
  void handleMouseEvent(rviz::ViewportMouseEvent& event) override;
  void reset() override;
  /// Another view that follows asks this one for its target frame; it gets none.
  rviz::Property* subProp(const QString& name) override;

  /// Projection of the lens; null while the view has no lens.
  const graphics::RoundCamera* roundCamera() const { return picture_ ? &picture_->camera() : nullptr; }

 protected:
  void onInitialize() override;
  void onActivate() override;

 private:
  void updateScope();
  void bendPicture();
  void expose(float passed);
  void showStatus(const QString& text);

  rviz::TfFrameProperty* frame_;
  rviz::FloatProperty* field_of_view_;
  rviz::EnumProperty* lens_;
  rviz::FloatProperty* sharpness_;
  rviz::BoolProperty* auto_exposure_;
  rviz::StringProperty* status_;
  std::unique_ptr<rviz::Property> stereo_;            ///< property of rviz that has no meaning here
  rviz::Property no_target_;                          ///< target frame for other views
  std::unique_ptr<graphics::EndoscopeLens> picture_;  ///< only while this view is active
  graphics::AutoExposure exposure_;
  double time_ = 0;      ///< that the view has been active, for the rate of the exposure [s]
  bool broken_ = false;  ///< the graphics card cannot draw the lens; not tried again
};

}  // namespace vibe::rviz_plugins

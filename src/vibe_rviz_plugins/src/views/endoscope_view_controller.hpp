#pragma once
#include <rviz/view_controller.h>

#include <memory>

#include "render/endoscope_lens.hpp"

namespace rviz {
class EnumProperty;
class StringProperty;
class TfFrameProperty;
}  // namespace rviz

namespace vibe {

/// What the trainee sees: rviz' view from the camera in the endoscope's tip, which it follows.
class EndoscopeViewController : public rviz::ViewController {
  Q_OBJECT
 public:
  EndoscopeViewController();
  ~EndoscopeViewController() override;

  void update(float dt, float ros_dt) override;
  void handleMouseEvent(rviz::ViewportMouseEvent& event) override;
  void reset() override;
  /// Other views ask the one before them for a target frame; that of the endoscope is not for them.
  rviz::Property* subProp(const QString& name) override;

  /// How pixels of the view become rays; null while the picture is not bent by a lens.
  const RoundCamera* roundCamera() const { return picture_ ? &picture_->camera() : nullptr; }

 protected:
  void onInitialize() override;
  void onActivate() override;

 private:
  void updateScope();
  void bendPicture();
  void tell(const QString& text);

  rviz::TfFrameProperty* frame_;
  rviz::FloatProperty* field_of_view_;
  rviz::EnumProperty* lens_;
  rviz::FloatProperty* sharpness_;
  rviz::StringProperty* status_;
  std::unique_ptr<rviz::Property> stereo_;  ///< rviz' own, which has no meaning here
  rviz::Property no_target_;                ///< what they are told
  std::unique_ptr<EndoscopeLens> picture_;  ///< only while this is the view in use
  bool broken_ = false;                     ///< the graphics card cannot do it: said once, not tried again
};

}  // namespace vibe

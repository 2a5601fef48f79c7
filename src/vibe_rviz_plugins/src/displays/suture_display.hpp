#pragma once
#include <vibe_msgs/SutureArray.h>

#include <memory>
#include <optional>

#include "displays/wall_listener.hpp"
#include "vibe_graphics/geometry/blood_shapes.hpp"
#include "vibe_graphics/geometry/suture_drawing.hpp"
#include "vibe_graphics/geometry/suture_shapes.hpp"
#include "vibe_graphics/graphics/suture_visual.hpp"
#include "vibe_rviz_plugins/display_base/message_display.hpp"

namespace rviz {
class BoolProperty;
class ColorProperty;
class EnumProperty;
class FloatProperty;
class VectorProperty;
}  // namespace rviz

namespace vibe::rviz_plugins {

class Legend;

/// Threads with bites, tension, T-tags, cinches, the recognised technique, and bleeding, from vibe_msgs/SutureArray.
class SutureDisplay : public MessageDisplay<vibe_msgs::SutureArray> {
  Q_OBJECT
 public:
  SutureDisplay();
  ~SutureDisplay() override;

 protected:
  void onInitialize() override;
  void onEnable() override;
  void onDisable() override;

 private Q_SLOTS:
  void changeStyle();
  void changeLegend();

 private:
  void addThreadProperties();
  void addPartProperties();
  void addBleedingProperties();
  void makeVisual() override;
  void clear() override;
  MessageReport read(const vibe_msgs::SutureArray& message) override;
  bool draw() override;
  void drawThreads();
  void drawLabels();
  bool drawBlood();
  std::optional<Eigen::Isometry3d> poseOfWall();
  bool showsTension() const { return style_.colouring == graphics::ThreadColour::Tension; }

  std::unique_ptr<graphics::SutureVisual> visual_;
  std::unique_ptr<Legend> legend_;
  graphics::SutureDrawing scene_;
  graphics::SutureStyle style_;
  graphics::BloodStyle blood_style_;
  WallListener wall_;
  graphics::BleedingShape blood_;
  graphics::ColouredShape shape_;  // a member to reuse its memory
  bool threads_changed_ = false, blood_changed_ = false;

  rviz::EnumProperty *colour_property_, *map_property_;
  rviz::FloatProperty *max_property_, *diameter_property_, *emphasis_property_, *label_height_property_;
  rviz::ColorProperty *slack_property_, *one_property_;
  rviz::BoolProperty *legend_property_, *bites_property_, *ends_property_, *label_property_, *corners_property_,
      *links_property_, *bleeding_property_;
  rviz::VectorProperty* down_property_;
};

}  // namespace vibe::rviz_plugins

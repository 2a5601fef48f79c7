#pragma once
#include <rviz/display.h>
#include <vibe_msgs/SutureArray.h>

#include <memory>
#include <optional>
#include <string>

#include "geometry/blood_shapes.hpp"
#include "geometry/suture_scene.hpp"
#include "geometry/suture_shapes.hpp"
#include "render/suture_visual.hpp"

namespace rviz {
class BoolProperty;
class ColorProperty;
class EnumProperty;
class FloatProperty;
class RosTopicProperty;
class VectorProperty;
}  // namespace rviz

namespace vibe {

class Legend;

/// Threads with bites, tension, T-tags, cinches, the recognised technique, and bleeding, from vibe_msgs/SutureArray.
class SutureDisplay : public rviz::Display {
  Q_OBJECT
 public:
  SutureDisplay();
  ~SutureDisplay() override;

  void onInitialize() override;
  void update(float wall_dt, float ros_dt) override;
  void reset() override;
  void setTopic(const QString& topic, const QString& datatype) override;

 protected:
  void onEnable() override;
  void onDisable() override;
  void fixedFrameChanged() override;

 private Q_SLOTS:
  void changeTopic();
  void changeStyle();
  void changeLegend();

 private:
  void addThreadProperties();
  void addPartProperties();
  void addBleedingProperties();
  void subscribe();
  void receive(const vibe_msgs::SutureArray::ConstPtr& message);
  void place();
  void draw();
  void drawLabels();
  void drawBlood();
  void report();
  bool showsTension() const { return style_.colouring == ThreadColour::Tension; }

  std::unique_ptr<SutureVisual> visual_;
  std::unique_ptr<Legend> legend_;
  ros::Subscriber subscriber_;
  vibe_msgs::SutureArray::ConstPtr shown_, latest_;  // latest_: not read yet
  SutureScene scene_;
  SutureStyle style_;
  BloodStyle blood_style_;
  ColouredShape shape_;  // kept for its memory
  bool threads_changed_ = false, blood_changed_ = false, waiting_ = true;
  std::string said_;            // last status of the message
  std::optional<bool> placed_;  // whether the transform was known; none: not asked yet

  rviz::RosTopicProperty* topic_property_;
  rviz::EnumProperty *colour_property_, *map_property_;
  rviz::FloatProperty *max_property_, *diameter_property_, *emphasis_property_, *label_height_property_;
  rviz::ColorProperty *slack_property_, *one_property_;
  rviz::BoolProperty *legend_property_, *bites_property_, *ends_property_, *label_property_, *corners_property_,
      *links_property_, *bleeding_property_;
  rviz::VectorProperty* down_property_;
};

}  // namespace vibe

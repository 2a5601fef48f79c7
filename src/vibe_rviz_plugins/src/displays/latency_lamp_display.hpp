#pragma once
#include <OgreRenderTargetListener.h>
#include <ros/publisher.h>
#include <sensor_msgs/JointState.h>
#include <vibe_msgs/DisplayTiming.h>

#include <memory>

#include "vibe_rviz_plugins/display_base/message_display.hpp"

namespace Ogre {
class RenderTarget;
}

namespace rviz {
class FloatProperty;
class StringProperty;
}  // namespace rviz

namespace vibe::rviz_plugins {

class Legend;

/// A lamp in the corner of the view that is green while a joint is above a threshold and magenta below, for measuring
/// how long a motion takes to become visible: by a program that reads its pixels, or by a camera in front of the
/// screen. Whenever it changes, the display publishes when it read the message and when it rendered the frame.
class LatencyLampDisplay : public MessageDisplay<sensor_msgs::JointState>, private Ogre::RenderTargetListener {
  Q_OBJECT
 public:
  LatencyLampDisplay();
  ~LatencyLampDisplay() override;

 protected:
  void onInitialize() override;
  void onEnable() override;
  void onDisable() override;

 private:
  void makeVisual() override;
  void clear() override;
  MessageReport read(const sensor_msgs::JointState& message) override;
  bool draw() override;
  void postRenderTargetUpdate(const Ogre::RenderTargetEvent& event) override;

  rviz::StringProperty* joint_property_;
  rviz::FloatProperty* threshold_property_;
  ros::Publisher publisher_;
  Ogre::RenderTarget* window_ = nullptr;
  std::unique_ptr<Legend> lamp_;
  vibe_msgs::DisplayTiming timing_;  // of the last change
  bool drawn_ = false;               // the lamp shows timing_.lit
  bool pending_ = false;             // the frame with it has not been rendered yet
};

}  // namespace vibe::rviz_plugins

#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <geometry_msgs/WrenchStamped.h>
#include <ros/ros.h>
#include <sensor_msgs/JointState.h>
#include <vibe_msgs/ProcedureEvent.h>

#include "hardware_messages.hpp"
#include "vibe_testing/whole_bite.hpp"

namespace vibe::hardware {

/// A hand whose device drives the simulator of a ROS graph, in wall time: it sees what the simulator publishes.
class GraphStomach : public test::HandAtDevice {
 public:
  test::SeenByHand look() override {
    act();
    frame();
    return seen_;
  }

 protected:
  GraphStomach() {
    const ros::TransportHints hints = ros::TransportHints().tcpNoDelay();
    subscribers_ = {handle_.subscribe("scope/setpoint_js", 10, &GraphStomach::onScope, this, hints),
                    handle_.subscribe("suturing_device/measured_js", 10, &GraphStomach::onDevice, this, hints),
                    handle_.subscribe("scope/measured_cf", 10, &GraphStomach::onForce, this, hints),
                    handle_.subscribe("procedure/events", 100, &GraphStomach::onEvent, this, hints)};
  }

  ros::NodeHandle handle_;

  /// Of what the person looks at [s]
  static double stepPeriod() { return 1.0 / 60; }
  /// What the hand does now; may let frames pass.
  virtual void act() = 0;
  /// What the device measures and sends after a time, a few times in a frame. @param dt  [s]
  virtual void send(double dt) = 0;

  const test::SeenByHand& seen() const { return seen_; }
  bool sees() const { return scope_ && device_; }  ///< the joints of the tool are known

  /// A machine that stands still lets the device stand still, too, so that nothing jumps.
  void frame() {
    for (int k = 0; k < kSamples; ++k) {
      ros::WallDuration(stepPeriod() / kSamples).sleep();
      const ros::WallTime now = ros::WallTime::now();
      send(std::min((now - last_).toSec(), kLongest));
      last_ = now;
      ros::spinOnce();
    }
  }

 private:
  static constexpr int kSamples = 8;
  static constexpr double kLongest = 0.01;  // [s]

  std::vector<ros::Subscriber> subscribers_;
  test::SeenByHand seen_;
  bool scope_ = false, device_ = false;
  ros::WallTime last_ = ros::WallTime::now();

  void onScope(const sensor_msgs::JointState& message) {
    scope_ |= readJoints(message, 0, kScopeJointCount, seen_.joints);
    seen_.time = message.header.stamp.toSec();
  }
  void onDevice(const sensor_msgs::JointState& message) {
    device_ |= readJoints(message, kScopeJointCount, kSuturingDeviceJointCount, seen_.joints);
  }
  void onForce(const geometry_msgs::WrenchStamped& message) {
    const auto& force = message.wrench.force;
    seen_.force = std::hypot(force.x, force.y, force.z);
  }
  void onEvent(const vibe_msgs::ProcedureEvent& message) {
    ++seen_.events.at(message.kind);
    if (message.kind == vibe_msgs::ProcedureEvent::GRAB_MISSED) seen_.gap = message.value;
  }
};

}  // namespace vibe::hardware

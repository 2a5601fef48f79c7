#pragma once

#include <cstdint>
#include <fstream>
#include <initializer_list>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <ros/ros.h>
#include <sensor_msgs/JointState.h>
#include <vibe_msgs/DisplayTiming.h>
#include <vibe_msgs/StepInput.h>
#include <vibe_msgs/StepTiming.h>

#include "lamp_watch.hpp"

namespace vibe::latency {

/// A table of times and values that grows while somebody measures: add() only copies, flush() writes.
class EventTable {
 public:
  /// @param columns  separated by commas
  /// @throws Error if the file cannot be written
  EventTable(const std::string& file, const std::string& columns);

  /// One row, from any thread: whole numbers first, such as times of the wall clock [ns], then real ones.
  void add(std::initializer_list<std::int64_t> numbers, std::initializer_list<double> values = {});
  /// Writes what has been added, from one thread. @throws Error if that fails
  void flush();

 private:
  struct Row {
    std::vector<std::int64_t> numbers;
    std::vector<double> values;
  };
  std::string file_;
  std::ofstream out_;  // not whole: a log
  std::mutex mutex_;
  std::vector<Row> rows_;

  void check();
};

/// What to watch, from private parameters.
struct ProbeParameters {
  std::string folder;                               ///< for the tables; required
  std::string joint = "tip_left_right";             ///< that blinks
  std::string device = "scope/input/joint_states";  ///< topic on which it comes in
  std::string state = "scope/setpoint_js";          ///< topic on which the simulator answers
  bool screen = true;                               ///< also watch the lamp on the screen
};

/// @throws Error for an unknown parameter, one of a wrong type, or an unknown joint
ProbeParameters readProbeParameters(const ros::NodeHandle& private_handle);

/// Writes when a joint passed each stage from a device to the screen, as tables: device.csv, input.csv, step.csv,
/// state.csv, display.csv, pixel.csv. All times are of the wall clock [ns]; `wall` is when the message came here.
class LatencyProbe {
 public:
  LatencyProbe(ros::NodeHandle handle, const ProbeParameters& parameters);

  void flush();
  /// Whether the lamp has been found, or is not looked for.
  bool seesLamp() const { return !lamp_ || lamp_->isFound(); }

 private:
  std::string joint_;
  std::size_t input_joint_;
  EventTable device_, input_, step_, state_, display_, pixel_;
  std::vector<ros::Subscriber> subscribers_;
  std::unique_ptr<LampWatch> lamp_;

  void listenToSteps(ros::NodeHandle& handle, const ros::TransportHints& hints);
  void listenToDisplay(ros::NodeHandle& handle, const ros::TransportHints& hints);
  void addJoint(EventTable& table, const sensor_msgs::JointState& message) const;
};

}  // namespace vibe::latency

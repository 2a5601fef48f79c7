#include "latency_probe.hpp"

#include <algorithm>
#include <iomanip>

#include "vibe_core/input/step_input.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_ros_utils/parameter_reader.hpp"
#include "vibe_ros_utils/wall_clock.hpp"

namespace vibe::latency {
namespace {

constexpr std::uint32_t kQueue = 10000;

std::int64_t ns(const ros::Time& time) {
  return static_cast<std::int64_t>(time.toNSec());
}

std::size_t indexOf(const std::string& joint) {
  const auto found = std::find(kJointNames.begin(), kJointNames.end(), joint);
  if (found == kJointNames.end()) throw Error("Parameter ~joint is '" + joint + "'; set it to a joint of the scope.");
  return static_cast<std::size_t>(found - kJointNames.begin());
}

}  // namespace

EventTable::EventTable(const std::string& file, const std::string& columns) : file_(file), out_(file) {
  out_ << columns << '\n' << std::setprecision(17) << std::flush;
  check();
}

void EventTable::add(std::initializer_list<std::int64_t> numbers, std::initializer_list<double> values) {
  const std::lock_guard<std::mutex> lock(mutex_);
  rows_.push_back({numbers, values});
}

void EventTable::flush() {
  std::vector<Row> rows;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    rows.swap(rows_);
  }
  for (const Row& row : rows) {
    const char* separator = "";
    for (const std::int64_t number : row.numbers) {
      out_ << separator << number;
      separator = ",";
    }
    for (const double value : row.values) out_ << ',' << value;
    out_ << '\n';
  }
  out_.flush();
  check();
}

void EventTable::check() {
  if (!out_) throw Error("Cannot write to '" + file_ + "'; check the folder and whether the disk is full.");
}

ProbeParameters readProbeParameters(const ros::NodeHandle& private_handle) {
  ros_utils::ParameterReader reader(private_handle);
  ProbeParameters parameters;
  parameters.folder = reader.required("folder", "a folder for the tables");
  reader.read("joint", parameters.joint);
  reader.read("device", parameters.device);
  reader.read("state", parameters.state);
  reader.read("screen", parameters.screen);
  reader.finish();
  indexOf(parameters.joint);
  return parameters;
}

LatencyProbe::LatencyProbe(ros::NodeHandle handle, const ProbeParameters& parameters)
    : joint_(parameters.joint),
      input_joint_(indexOf(parameters.joint)),
      device_(parameters.folder + "/device.csv", "wall,stamp,position"),
      input_(parameters.folder + "/input.csv", "wall,stamp,step,position"),
      step_(parameters.folder + "/step.csv", "wall,stamp,step,due,begin,solved,published"),
      state_(parameters.folder + "/state.csv", "wall,stamp,position"),
      display_(parameters.folder + "/display.csv", "wall,stamp,lit,received,rendered"),
      pixel_(parameters.folder + "/pixel.csv", "wall,lit") {
  const ros::TransportHints hints = ros::TransportHints().tcpNoDelay();
  using sensor_msgs::JointState;
  subscribers_.push_back(handle.subscribe<JointState>(
      parameters.device, kQueue, [this](const JointState::ConstPtr& m) { addJoint(device_, *m); }, {}, hints));
  subscribers_.push_back(handle.subscribe<JointState>(
      parameters.state, kQueue, [this](const JointState::ConstPtr& m) { addJoint(state_, *m); }, {}, hints));
  listenToSteps(handle, hints);
  listenToDisplay(handle, hints);
  if (parameters.screen)
    lamp_ = std::make_unique<LampWatch>([this](std::int64_t wall, bool lit) { pixel_.add({wall, lit ? 1 : 0}); });
}

void LatencyProbe::listenToSteps(ros::NodeHandle& handle, const ros::TransportHints& hints) {
  subscribers_.push_back(handle.subscribe<vibe_msgs::StepInput>(
      "applied_input", kQueue,
      [this](const vibe_msgs::StepInput::ConstPtr& m) {
        input_.add({ros_utils::wallTime(), ns(m->header.stamp), static_cast<std::int64_t>(m->step)},
                   {m->joints[input_joint_]});
      },
      {}, hints));
  subscribers_.push_back(handle.subscribe<vibe_msgs::StepTiming>(
      "step_timing", kQueue,
      [this](const vibe_msgs::StepTiming::ConstPtr& m) {
        step_.add({ros_utils::wallTime(), ns(m->header.stamp), static_cast<std::int64_t>(m->step), ns(m->due),
                   ns(m->begin), ns(m->solved), ns(m->published)});
      },
      {}, hints));
}

void LatencyProbe::listenToDisplay(ros::NodeHandle& handle, const ros::TransportHints& hints) {
  subscribers_.push_back(handle.subscribe<vibe_msgs::DisplayTiming>(
      "latency_lamp", kQueue,
      [this](const vibe_msgs::DisplayTiming::ConstPtr& m) {
        display_.add({ros_utils::wallTime(), ns(m->header.stamp), m->lit, ns(m->received), ns(m->rendered)});
      },
      {}, hints));
}

void LatencyProbe::addJoint(EventTable& table, const sensor_msgs::JointState& message) const {
  const auto found = std::find(message.name.begin(), message.name.end(), joint_);
  const auto index = static_cast<std::size_t>(found - message.name.begin());
  if (index < message.name.size() && index < message.position.size())
    table.add({ros_utils::wallTime(), ns(message.header.stamp)}, {message.position[index]});
}

void LatencyProbe::flush() {
  for (EventTable* table : {&device_, &input_, &step_, &state_, &display_, &pixel_}) table->flush();
}

}  // namespace vibe::latency

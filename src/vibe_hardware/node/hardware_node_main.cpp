// hardware_node: the haptic device and the input device as topics.
#include <ros/node_handle.h>
#include <ros/param.h>
#include <ros/ros.h>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "hardware_messages.hpp"
#include "vibe_core/clocks/step_timer.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_hardware/driver/polling.hpp"
#include "vibe_hardware/hid/hid_port.hpp"
#include "vibe_hardware/hid/hidraw_bus.hpp"
#include "vibe_hardware/hid/socket_bus.hpp"
#include "vibe_ros_utils/parameter_reader.hpp"
#include "vibe_ros_utils/startup.hpp"

namespace vibe::hardware {
namespace {

constexpr double kWait = 0.004;            // for a report; parameters wait as long at most [s]
constexpr double kButtonPeriod = 0.1;      // of buttons that do not change [s]
constexpr double kStatisticsPeriod = 0.1;  // [s]
constexpr double kCameraPatience = 1;      // a camera that is silent for longer tracks no more [s]
constexpr double kWarningPeriod = 1;       // [s]
constexpr double kTimerPeriod = 0.02;      // [s]
constexpr double kAfterHoming = 0.1;       // in which parameters belong to the positions before [s]
constexpr std::uint32_t kDeviceQueue = 100;
constexpr double kDelivery = 0.2;  // for listeners to receive that the buttons are released [s]
const char* const kTracked = "suturing_device/input/joint_states";  // by a camera, or driven by buttons

/// The drivers of both devices say the same about a bus that does not work.
void log(Severity severity, const std::string& sentence) {
  static std::mutex mutex;
  static std::string last;
  const std::lock_guard<std::mutex> lock(mutex);
  if (sentence == last) return;
  last = sentence;
  if (severity == Severity::Info) {
    ROS_INFO_STREAM(sentence);
  } else {
    ROS_WARN_STREAM(sentence);
  }
}

std::size_t indexOf(DeviceKind kind) {
  return static_cast<std::size_t>(kind);
}

/// Private parameters of hardware_node.
struct HardwareParameters {
  std::string config = "package://vibe_hardware/config/devices.yaml";
  std::string bus = "hidraw";  ///< or the folder of an emulator's sockets
  int realtime_priority = 0;   ///< of all threads, SCHED_FIFO; 0: ordinary threads
};

/// @throws Error for a parameter that is unknown or wrong
HardwareParameters readHardwareParameters(const ros::NodeHandle& private_handle) {
  ros_utils::ParameterReader reader(private_handle);
  HardwareParameters parameters;
  reader.read("config", parameters.config);
  reader.read("bus", parameters.bus);
  reader.read("realtime_priority", parameters.realtime_priority, 0, 99);
  double diagnostic_period = 1;  // diagnostic_updater reads it itself
  reader.read("diagnostic_period", diagnostic_period, 0.1, 60, "s");
  reader.finish();
  bool use_sim_time = false;
  ros::param::get("/use_sim_time", use_sim_time);
  if (use_sim_time) {
    throw Error(
        "Devices are sampled in wall time, but /use_sim_time is true; run 'rosparam delete /use_sim_time' before any "
        "node starts.");
  }
  return parameters;
}

/// @param bus  "hidraw", or a folder
std::unique_ptr<HidBus> makeBus(const std::string& bus) {
  if (bus == "hidraw") return std::make_unique<HidrawBus>();
  if (bus.find('/') != std::string::npos) return std::make_unique<SocketBus>(bus);
  throw Error("Parameter ~bus is '" + bus +
              "'; set it to hidraw or to the folder of an emulator's sockets, with a '/'.");
}

/// Both devices as topics: docs/interfaces.md. One thread per device; callbacks of ROS come from one thread of a
/// spinner, which must have been stopped before stop() or the end.
class HardwareNode {
 public:
  /// @throws Error for a wrong calibration or bus
  HardwareNode(ros::NodeHandle handle, const HardwareParameters& parameters)
      : joints_(Calibration::load(parameters.config)),
        buttons_(joints_.calibration()),
        haptic_bus_(makeBus(parameters.bus)),
        input_bus_(makeBus(parameters.bus)),
        haptic_(*haptic_bus_, joints_.calibration().devices[indexOf(DeviceKind::Haptic)], steadyTime,
                callbacksOf(DeviceKind::Haptic)),
        input_(*input_bus_, DeviceKind::Input, joints_.calibration().devices[indexOf(DeviceKind::Input)], steadyTime,
               callbacksOf(DeviceKind::Input)) {
    if (joints_.calibration().suturing_device) suturing_device_.emplace(*joints_.calibration().suturing_device);
    advertise(handle);
    publishState();
    startThreads();
  }

  ~HardwareNode() { stop(); }

  HardwareNode(const HardwareNode&) = delete;
  HardwareNode& operator=(const HardwareNode&) = delete;

  /// Lets go of the devices and releases the buttons. @return whether any was pressed
  bool stop() {
    haptic_thread_.reset();
    input_thread_.reset();
    const auto pressed = buttons_.pressed();
    const double now = steadyTime();
    onLost(DeviceKind::Haptic, now);
    onLost(DeviceKind::Input, now);
    return buttons_.pressed() != pressed;
  }

 private:
  std::mutex mutex_;  // of everything that more than one thread uses, down to the buses
  ScopeJoints joints_;
  ScopeButtons buttons_;
  std::optional<SuturingDeviceDrive> suturing_device_;
  std::array<DeviceStatistics, kDeviceKinds> device_statistics_;
  HapticStatistics haptic_statistics_;
  std::array<SilenceWatch, kDeviceKinds> silence_;
  std::uint64_t rejected_ = 0;
  double last_buttons_ = -1;         // time of the last message [s]
  double last_suturing_device_ = 0;  // time of the last motion [s]
  double camera_time_ = -1e9;  // arrival of the last message of another node on suturing_device/input/joint_states [s]
  std::string operating_state_;
  bool was_homed_ = false;
  StampSource scope_stamps_, haptic_stamps_, button_stamps_, suturing_device_stamps_;

  std::unique_ptr<HidBus> haptic_bus_, input_bus_;
  HapticDriver haptic_;
  DeviceDriver input_;
  double next_statistics_[kDeviceKinds] = {};

  ros::Publisher scope_publisher_, button_publisher_, haptic_publisher_, state_publisher_, suturing_device_publisher_;
  ros::Subscriber parameters_subscriber_, suturing_device_subscriber_;
  diagnostic_updater::Updater updater_;
  std::array<DiagnosticMemory, kDeviceKinds> memory_;
  ros::WallTimer timer_;
  std::unique_ptr<PollingThread> haptic_thread_, input_thread_;

  DeviceDriver::Callbacks callbacksOf(DeviceKind kind) {
    DeviceDriver::Callbacks callbacks;
    callbacks.sample = [this, kind](const DeviceSample& sample) { onSample(kind, sample); };
    callbacks.connected = [](const DeviceConnection&) {};
    callbacks.lost = [this, kind](double now) { onLost(kind, now); };
    callbacks.message = log;
    return callbacks;
  }

  void advertise(ros::NodeHandle& handle) {
    using sensor_msgs::JointState;
    scope_publisher_ = handle.advertise<JointState>("scope/input/joint_states", kDeviceQueue);
    button_publisher_ = handle.advertise<sensor_msgs::Joy>("scope/buttons", kDeviceQueue);
    haptic_publisher_ = handle.advertise<JointState>("haptic/measured_js", kDeviceQueue);
    state_publisher_ = handle.advertise<vibe_msgs::OperatingState>("haptic/operating_state", 1, true);
    const ros::TransportHints no_delay = ros::TransportHints().tcpNoDelay();
    parameters_subscriber_ = handle.subscribe("haptic/parameters", 1, &HardwareNode::onParameters, this, no_delay);
    if (suturing_device_) {
      suturing_device_publisher_ = handle.advertise<JointState>(kTracked, kDeviceQueue);
      suturing_device_subscriber_ = handle.subscribe(kTracked, 1, &HardwareNode::onSuturingDevice, this);
    }
    updater_.setHardwareID("none");
    for (const DeviceKind kind : {DeviceKind::Haptic, DeviceKind::Input}) {
      updater_.add(deviceName(kind), [this, kind](diagnostic_updater::DiagnosticStatusWrapper& status) {
        const std::lock_guard<std::mutex> lock(mutex_);
        const HapticStatistics* haptic = kind == DeviceKind::Haptic ? &haptic_statistics_ : nullptr;
        fillDiagnostics(device_statistics_[indexOf(kind)], haptic, rejected_, memory_[indexOf(kind)], status);
      });
    }
    timer_ = handle.createWallTimer(ros::WallDuration(kTimerPeriod), [this](const ros::WallTimerEvent&) {
      for (const DeviceKind kind : {DeviceKind::Haptic, DeviceKind::Input}) watchSilence(kind);
      updater_.update();
      publishState();
    });
  }

  void startThreads() {
    const auto failed = [](const std::string& what) { ROS_ERROR_STREAM("The driver of a device failed: " << what); };
    haptic_thread_ = std::make_unique<PollingThread>(
        [this] {
          haptic_.poll(kWait);
          storeStatistics(DeviceKind::Haptic, haptic_.device());
          return haptic_.device().connection() != nullptr;
        },
        failed);
    input_thread_ = std::make_unique<PollingThread>(
        [this] {
          input_.poll(kWait);
          storeStatistics(DeviceKind::Input, input_);
          return input_.connection() != nullptr;
        },
        failed);
  }

  void storeStatistics(DeviceKind kind, const DeviceDriver& device) {
    const double now = steadyTime();
    if (now < next_statistics_[indexOf(kind)]) return;
    next_statistics_[indexOf(kind)] = now + kStatisticsPeriod;
    const std::lock_guard<std::mutex> lock(mutex_);
    device_statistics_[indexOf(kind)] = device.statistics();
    if (kind == DeviceKind::Haptic) haptic_statistics_ = haptic_.statistics();
  }

  void onSample(DeviceKind kind, const DeviceSample& sample) {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (silence_[indexOf(kind)].arrived(steadyTime()))
      log(Severity::Info, "The " + std::string(deviceName(kind)) + " sends reports again.");
    if (joints_.take(kind, sample)) {
      haptic_.release(kAfterHoming);  // what it renders belongs to positions that no longer hold
      ROS_INFO("The joints of the scope are homed.");
    }
    publishJoints(kind, sample.time);
    publishButtons(sample.time, buttons_.take(kind, sample.buttons));
    if (joints_.leads(kind)) publishSuturingDevice(sample.time);
  }

  void onLost(DeviceKind kind, double now) {
    const std::lock_guard<std::mutex> lock(mutex_);
    silence_[indexOf(kind)].stop();
    joints_.lose(kind);
    next_statistics_[indexOf(kind)] = 0;
    if (buttons_.take(kind, 0)) publishButtons(now, true);
  }

  /// A request that a device does not answer keeps its thread for seconds, so its silence is noticed here.
  void watchSilence(DeviceKind kind) {
    const std::lock_guard<std::mutex> lock(mutex_);
    const double now = steadyTime();
    if (!silence_[indexOf(kind)].expired(now)) return;
    DeviceStatistics& statistics = device_statistics_[indexOf(kind)];
    statistics.state = LinkState::Silent;
    statistics.problem = "The " + std::string(deviceName(kind)) +
                         " does not answer: its buttons count as released and the scope stays where it is; check cable "
                         "and firmware.";
    log(Severity::Warning, statistics.problem);
    joints_.lose(kind);
    if (buttons_.take(kind, 0)) publishButtons(now, true);
  }

  void publishJoints(DeviceKind kind, double time) {
    if (kind == DeviceKind::Haptic) haptic_publisher_.publish(makeHapticJoints(joints_, haptic_stamps_.at(time)));
    // With every report of either device: the wheels of one must not wait for the next report of the other.
    if (!joints_.isKnown() || !joints_.calibration().uses(kind)) return;
    scope_publisher_.publish(makeScopeJoints(joints_, scope_stamps_.at(time)));
  }

  void publishButtons(double time, bool changed) {
    if (!changed && time - last_buttons_ < kButtonPeriod) return;
    last_buttons_ = time;
    button_publisher_.publish(makeButtons(buttons_.pressed(), button_stamps_.at(time)));
  }

  void publishSuturingDevice(double time) {
    if (!suturing_device_) return;
    const bool tracked = steadyTime() - camera_time_ < kCameraPatience;
    if (!tracked) suturing_device_->advance(buttons_, time - last_suturing_device_);
    last_suturing_device_ = time;
    if (tracked) return;
    suturing_device_publisher_.publish(makeSuturingDeviceJoints(*suturing_device_, suturing_device_stamps_.at(time)));
  }

  void publishState() {
    const std::lock_guard<std::mutex> lock(mutex_);
    const std::string state = operatingState(device_statistics_[indexOf(DeviceKind::Haptic)], haptic_statistics_);
    if (state == operating_state_ && joints_.isHomed() == was_homed_) return;
    operating_state_ = state;
    was_homed_ = joints_.isHomed();
    vibe_msgs::OperatingState message;
    message.header.stamp = ros::Time::now();
    message.state = state;
    message.is_homed = was_homed_;
    message.is_busy = false;
    state_publisher_.publish(message);
  }

  void onParameters(const vibe_msgs::HapticParameters& message) {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!message.touching) return haptic_.release();
    try {
      haptic_.setTarget(readHapticParameters(message, joints_));
    } catch (const Error& error) {
      ++rejected_;
      ROS_WARN_STREAM_THROTTLE(kWarningPeriod, "A message on haptic/parameters is ignored: " << error.what());
    }
  }

  void onSuturingDevice(const ros::MessageEvent<const sensor_msgs::JointState>& event) {
    if (event.getPublisherName() == ros::this_node::getName()) return;
    const std::lock_guard<std::mutex> lock(mutex_);
    if (event.getMessage()->header.stamp.isZero()) return;  // not valid
    try {
      suturing_device_->setPositions(readSuturingDeviceJoints(*event.getMessage()));
      camera_time_ = steadyTime();
    } catch (const Error& error) {
      ROS_WARN_STREAM_THROTTLE(kWarningPeriod,
                               "A message on suturing_device/input/joint_states is ignored: " << error.what());
    }
  }
};

void run() {
  ros::NodeHandle handle;
  const HardwareParameters parameters = readHardwareParameters(ros::NodeHandle("~"));
  if (parameters.realtime_priority > 0)
    for (const std::string& sentence : ros_utils::runInRealTime(parameters.realtime_priority))
      ROS_WARN_STREAM(sentence);
  HardwareNode node(handle, parameters);
  ros::AsyncSpinner spinner(1);
  spinner.start();
  ros_utils::waitForStop();
  spinner.stop();
  if (node.stop()) ros::WallDuration(kDelivery).sleep();
}

}  // namespace
}  // namespace vibe::hardware

int main(int argc, char** argv) {
  return vibe::ros_utils::runNodeWithGoodbye(argc, argv, "hardware_node", vibe::hardware::run);
}

#include "vision_node.hpp"

#include <algorithm>

#include "frame_input.hpp"
#include "vibe_core/clocks/step_timer.hpp"

namespace vibe::vision {
namespace {

constexpr double kWait = 0.05;           // for a frame [s]
constexpr double kSilentPeriods = 5;     // of frames after which instruments are lost
constexpr double kLeastSilence = 0.1;    // [s]
constexpr double kReportPeriod = 0.1;    // of reports without a frame [s]
constexpr double kDiagnosticTick = 0.1;  // [s]

double hostTime() {
  return ros::Time::now().toSec();
}

FramePipeline::Options pipelineOptions(const VisionParameters& parameters, double silence) {
  return {parameters.udp, isRecording(parameters.source), silence, hostTime};
}

}  // namespace

VisionNode::VisionNode(ros::NodeHandle handle, ros::NodeHandle private_handle, const std::string& name,
                       const VisionParameters& parameters)
    : parameters_(parameters),
      silence_(std::max(kLeastSilence, kSilentPeriods / parameters.options.rate)),
      pipeline_(VisionConfig::load(parameters.config), pipelineOptions(parameters, silence_)),
      publisher_(handle, pipeline_.config(), parameters),
      updater_(handle, private_handle, name) {
  if (parameters.fromTopic())
    input_ = std::make_unique<TopicInput>(handle, parameters);
  else
    input_ = std::make_unique<Capture>(openSource(parameters.source, parameters.options));
  instruments_.resize(pipeline_.config().instruments.size());
  instrument_memory_.resize(instruments_.size());
  camera_.expected_rate = parameters.options.rate;
  camera_.recorded = isRecording(parameters.source);
  addDiagnostics();
  reset_service_ = private_handle.advertiseService("reset", &VisionNode::onReset, this);
  next_silence_ = steadyTime() + silence_;
  thread_ = std::thread(&VisionNode::run, this);
  timer_ = handle.createWallTimer(ros::WallDuration(kDiagnosticTick), [this](const ros::WallTimerEvent&) {
    logStatus();
    updater_.update();
  });
}

VisionNode::~VisionNode() {
  timer_.stop();
  stop_ = true;
  thread_.join();
}

void VisionNode::addDiagnostics() {
  using diagnostic_updater::DiagnosticStatusWrapper;
  updater_.setHardwareID(parameters_.source);
  updater_.add("camera", [this](DiagnosticStatusWrapper& status) {
    const std::lock_guard<std::mutex> lock(mutex_);
    camera_.source = input_->statistics();
    camera_.dropped = input_->dropped();
    camera_.status = input_->status();
    fillCameraDiagnostics(camera_, steadyTime(), camera_memory_, status);
    for (DurationHistogram* times : {&camera_.transport, &camera_.wait, &camera_.track, &camera_.publish, &camera_.age})
      times->clear();
  });
  for (std::size_t i = 0; i < instruments_.size(); ++i) {
    updater_.add(pipeline_.config().instruments[i].name, [this, i](DiagnosticStatusWrapper& status) {
      const std::lock_guard<std::mutex> lock(mutex_);
      fillInstrumentDiagnostics(instruments_[i], instrument_memory_[i], status);
    });
  }
}

void VisionNode::run() {
  try {
    while (!stop_) takeFrame();
  } catch (const std::exception& error) {
    ROS_FATAL_STREAM("Tracking failed: " << error.what());
    ros::requestShutdown();
  }
}

void VisionNode::takeFrame() {
  Frame frame;
  const ReadResult read = input_->take(frame, kWait);
  if (reset_.exchange(false)) {
    pipeline_.reset();
    publisher_.reset();
  }
  if (read != ReadResult::Frame) return reportSilence(read);
  next_silence_ = steadyTime() + silence_;
  const FrameResult* result = pipeline_.process(frame);
  if (result != nullptr) note(*result, publisher_.publish(*result));
}

void VisionNode::reportSilence(ReadResult read) {
  if (read != ReadResult::Timeout) ros::WallDuration(read == ReadResult::End ? kWait : 0.001).sleep();
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    camera_.last = read;
  }
  if (steadyTime() < next_silence_) return;
  next_silence_ = steadyTime() + kReportPeriod;
  const FrameResult& result = pipeline_.reportSilence();
  publisher_.publishSilence(result);
  const std::lock_guard<std::mutex> lock(mutex_);
  for (std::size_t i = 0; i < instruments_.size(); ++i) instruments_[i].add(result.measurements[i], result.samples[i]);
}

void VisionNode::note(const FrameResult& result, double publish_time) {
  const std::lock_guard<std::mutex> lock(mutex_);
  camera_.last = ReadResult::Frame;
  camera_.last_frame = steadyTime();
  ++camera_.frames;
  camera_.disordered = pipeline_.disordered();
  camera_.transport.add(result.times.transport);
  camera_.wait.add(result.times.wait);
  camera_.track.add(result.times.track);
  camera_.publish.add(publish_time);
  camera_.age.add(result.tracked_at - result.frame.stamp);
  if (const UdpSender* sender = pipeline_.sender()) {
    camera_.sent = sender->sent();
    camera_.failed = sender->failed();
  }
  for (std::size_t i = 0; i < instruments_.size(); ++i) instruments_[i].add(result.measurements[i], result.samples[i]);
}

/// Says once what the camera is, and what is wrong with it.
void VisionNode::logStatus() {
  const std::string status = input_->status();
  if (status == last_status_) return;
  last_status_ = status;
  ROS_INFO_STREAM(status);
}

bool VisionNode::onReset(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response) {
  reset_ = true;
  response.success = true;
  response.message = "All instruments are searched anew in the next frame.";
  return true;
}

}  // namespace vibe::vision

#pragma once
#include <ros/ros.h>
#include <std_srvs/Trigger.h>

#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "frame_input.hpp"
#include "vibe_vision/predict/frame_pipeline.hpp"
#include "vision_diagnostics.hpp"
#include "vision_parameters.hpp"
#include "vision_publisher.hpp"

namespace vibe::vision {

/// Camera or image topic in, joints of the instruments out: docs/interfaces.md, "vision_node". One thread takes the
/// newest frame, tracks, sends the datagram and publishes; callbacks come from the threads of the handle's queue.
class VisionNode {
 public:
  /// @param name  of the node or nodelet, for diagnostics
  /// @throws Error for a wrong configuration or address
  VisionNode(ros::NodeHandle handle, ros::NodeHandle private_handle, const std::string& name,
             const VisionParameters& parameters);
  ~VisionNode();  ///< stops the thread
  VisionNode(const VisionNode&) = delete;
  VisionNode& operator=(const VisionNode&) = delete;

 private:
  VisionParameters parameters_;
  double silence_;  // without a frame after which instruments are lost [s]
  FramePipeline pipeline_;
  VisionPublisher publisher_;
  std::unique_ptr<FrameInput> input_;

  std::mutex mutex_;  // of what the thread notes for the diagnostics
  CameraDiagnostics camera_, camera_memory_;
  std::vector<InstrumentDiagnostics> instruments_, instrument_memory_;

  diagnostic_updater::Updater updater_;
  ros::ServiceServer reset_service_;
  ros::WallTimer timer_;
  std::string last_status_;
  std::atomic<bool> reset_{false}, stop_{false};
  double next_silence_ = 0;  // when the next report without a frame is due, steady clock [s]
  std::thread thread_;

  void addDiagnostics();
  void run();
  void takeFrame();
  void reportSilence(ReadResult result);
  void note(const FrameResult& result, double publish_time);
  void logStatus();
  bool onReset(std_srvs::Trigger::Request&, std_srvs::Trigger::Response& response);
};

}  // namespace vibe::vision

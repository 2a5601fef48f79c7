#include "simulator/services.hpp"

#include <std_srvs/SetBool.h>
#include <vibe_msgs/LoadScene.h>
#include <vibe_msgs/Reset.h>
#include <vibe_msgs/Snapshot.h>
#include <vibe_msgs/Step.h>

namespace vibe::sim {

template <typename Service, typename Work>
void Services::offer(const std::string& name, Work work) {
  using Request = typename Service::Request;
  using Response = typename Service::Response;
  const boost::function<bool(Request&, Response&)> callback = [work](Request& request, Response& response) {
    const Reply reply = work(request);
    response.success = reply.success;
    response.message = reply.message;
    return true;
  };
  servers_.push_back(handle_.advertiseService(name, callback));
}

Services::Services(const ros::NodeHandle& handle, Stepper& stepper) : handle_(handle) {
  handle_.setCallbackQueue(&queue_);
  offer<std_srvs::SetBool>("pause",
                           [&stepper](const std_srvs::SetBool::Request& r) { return stepper.setPaused(r.data); });
  offer<vibe_msgs::Step>("step", [&stepper](const vibe_msgs::Step::Request& r) { return stepper.takeSteps(r.n); });
  offer<vibe_msgs::Reset>(
      "reset", [&stepper](const vibe_msgs::Reset::Request& r) { return stepper.reset(r.seed, r.keep_time); });
  offer<vibe_msgs::Snapshot>(
      "save_snapshot", [&stepper](const vibe_msgs::Snapshot::Request& r) { return stepper.saveSnapshot(r.file); });
  offer<vibe_msgs::Snapshot>(
      "load_snapshot", [&stepper](const vibe_msgs::Snapshot::Request& r) { return stepper.loadSnapshot(r.file); });
  offer<vibe_msgs::LoadScene>("load_scene",
                              [&stepper](const vibe_msgs::LoadScene::Request& r) { return stepper.loadScene(r.file); });
  spinner_ = std::make_unique<ros::AsyncSpinner>(4, &queue_);
  spinner_->start();
}

Services::~Services() {
  spinner_->stop();
}

}  // namespace vibe::sim

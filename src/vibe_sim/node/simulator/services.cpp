#include "simulator/services.hpp"

#include "conversions/conversions.hpp"

#include <std_srvs/SetBool.h>
#include <vibe_msgs/LoadScene.h>
#include <vibe_msgs/Reset.h>
#include <vibe_msgs/Snapshot.h>
#include <vibe_msgs/StateCommand.h>
#include <vibe_msgs/Step.h>

namespace vibe::sim {

namespace {

constexpr std::uint32_t kCommandQueue = 10;

// Both tools are always powered and homed, and there is one pause, that of the simulation.
void obeyStateCommand(SimulationThread& thread, Publishers& publishers, const std::string& topic,
                      const std::string& command) {
  if (command == "enable" || command == "resume") {
    thread.setPaused(false);
  } else if (command == "pause") {
    thread.setPaused(true);
  } else if (command != "home") {
    publishers.complain("A message on " + topic + " is ignored: there is no command " + quoted(command) +
                        "; send pause, resume, enable or home.");
  }
}

}  // namespace

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

Services::Services(const ros::NodeHandle& handle, SimulationThread& thread, Publishers& publishers) : handle_(handle) {
  handle_.setCallbackQueue(&queue_);
  for (const char* const topic : {"scope/state_command", "suturing_device/state_command"})
    commands_.push_back(handle_.subscribe<vibe_msgs::StateCommand>(
        topic, kCommandQueue, [&thread, &publishers, topic](const vibe_msgs::StateCommand::ConstPtr& command) {
          obeyStateCommand(thread, publishers, topic, command->string);
        }));
  offer<std_srvs::SetBool>("pause",
                           [&thread](const std_srvs::SetBool::Request& r) { return thread.setPaused(r.data); });
  offer<std_srvs::SetBool>("organ/hold_breath",
                           [&thread](const std_srvs::SetBool::Request& r) { return thread.holdBreath(r.data); });
  offer<vibe_msgs::Step>("step", [&thread](const vibe_msgs::Step::Request& r) { return thread.takeSteps(r.n); });
  offer<vibe_msgs::Reset>("reset",
                          [&thread](const vibe_msgs::Reset::Request& r) { return thread.reset(r.seed, r.keep_time); });
  offer<vibe_msgs::Snapshot>("save_snapshot",
                             [&thread](const vibe_msgs::Snapshot::Request& r) { return thread.saveSnapshot(r.file); });
  offer<vibe_msgs::Snapshot>("load_snapshot", [&thread](const vibe_msgs::Snapshot::Request& r) {
    return thread.loadSnapshot(r.file, r.other_scene ? OtherScene::Taken : OtherScene::Refused);
  });
  offer<vibe_msgs::LoadScene>("load_scene",
                              [&thread](const vibe_msgs::LoadScene::Request& r) { return thread.loadScene(r.file); });
  spinner_ = std::make_unique<ros::AsyncSpinner>(4, &queue_);
  spinner_->start();
}

Services::~Services() {
  spinner_->stop();
}

}  // namespace vibe::sim

#pragma once

#include <memory>
#include <vector>

#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/service_server.h>
#include <ros/spinner.h>
#include <ros/subscriber.h>

#include "publishing/publishers.hpp"
#include "simulator/simulation_thread.hpp"

namespace vibe::sim {

/// The services of the simulator, and the commands of CRTK to its state. Each service answers when the work is done.
/// They have threads of their own, because a call may wait for steps that need inputs.
class Services {
 public:
  Services(const ros::NodeHandle& handle, SimulationThread& thread, Publishers& publishers);
  ~Services();

 private:
  ros::NodeHandle handle_;
  ros::CallbackQueue queue_;
  std::vector<ros::ServiceServer> servers_;
  std::vector<ros::Subscriber> commands_;
  std::unique_ptr<ros::AsyncSpinner> spinner_;

  template <typename Service, typename Work>
  void offer(const std::string& name, Work work);
};

}  // namespace vibe::sim

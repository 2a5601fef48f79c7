#pragma once
#include <ros/node_handle.h>

#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

namespace vibe::rviz_plugins {

/// Calls the services of the simulator in a separate thread, so that the panel does not wait for a service that is slow
/// or hangs. One call at a time.
class ServiceCaller {
 public:
  struct Answer {
    bool success;
    std::string sentence;  ///< answer of the simulator, or the reason why there is none
  };
  /// Called in the thread of the calls.
  using Report = std::function<void(const Answer&)>;

  explicit ServiceCaller(Report report);
  /// Abandons the call in progress.
  ~ServiceCaller();

  // Full names. Returns false if a call is in progress.
  bool pause(const std::string& service, bool paused);
  bool step(const std::string& service, unsigned n);
  /// Uses the seed of the scene; stamps continue.
  bool reset(const std::string& service);

  bool isBusy();
  /// Drops the connection of the call in progress, which then reports that it was given up. Returns immediately; has no
  /// effect on a call that is about to connect, so call again while it is busy.
  void giveUp();

 private:
  Report report_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::function<Answer()> work_;
  bool busy_ = false, ends_ = false, given_up_ = false;
  ros::ServiceClient client_;  // of the call in progress
  std::thread thread_;

  template <class Service>
  bool start(const std::string& name, const Service& service);
  template <class Service>
  Answer call(const std::string& name, Service service);
  void run();
};

}  // namespace vibe::rviz_plugins

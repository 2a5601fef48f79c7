#pragma once
#include <ros/node_handle.h>
#include <ros/service.h>
#include <std_srvs/SetBool.h>
#include <vibe_msgs/Reset.h>
#include <vibe_msgs/Step.h>
#include <chrono>
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

  explicit ServiceCaller(Report report) : report_(std::move(report)), thread_([this] { run(); }) {}
  /// Abandons the call in progress.
  ~ServiceCaller() {
    {
      std::lock_guard<std::mutex> lock(mutex_);
      ends_ = true;
    }
    changed_.notify_all();
    // A call that has not begun yet when its connection is dropped would connect again, so drop until it is over.
    for (giveUp(); isBusy(); giveUp()) std::this_thread::sleep_for(std::chrono::milliseconds(20));
    thread_.join();
  }

  // Full names. Returns false if a call is in progress.
  bool pause(const std::string& service, bool paused) {
    std_srvs::SetBool request;
    request.request.data = paused;
    return start(service, request);
  }

  bool step(const std::string& service, unsigned n) {
    vibe_msgs::Step request;
    request.request.n = n;
    return start(service, request);
  }

  /// Uses the seed of the scene; stamps continue.
  bool reset(const std::string& service) {
    vibe_msgs::Reset request;
    request.request.seed = 0;
    request.request.keep_time = true;
    return start(service, request);
  }

  bool isBusy() {
    std::lock_guard<std::mutex> lock(mutex_);
    return busy_;
  }

  /// Drops the connection of the call in progress, which then reports that it was given up. Returns immediately; has no
  /// effect on a call that is about to connect, so call again while it is busy.
  void giveUp() {
    std::lock_guard<std::mutex> lock(mutex_);
    if (!busy_) return;
    given_up_ = true;
    client_.shutdown();
  }

 private:
  Report report_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::function<Answer()> work_;
  bool busy_ = false, ends_ = false, given_up_ = false;
  ros::ServiceClient client_;  // of the call in progress
  std::thread thread_;

  template <class Service>
  bool start(const std::string& name, const Service& service) {
    std::lock_guard<std::mutex> lock(mutex_);
    if (busy_ || ends_) return false;
    busy_ = true;
    given_up_ = false;
    work_ = [this, name, service] { return call(name, service); };
    changed_.notify_all();
    return true;
  }

  template <class Service>
  Answer call(const std::string& name, Service service) {
    if (!ros::service::exists(name, false))
      return {false, "There is no service " + name + "; start the simulator or set the namespace."};
    // persistent, because only the connection of such a client can be dropped while it waits
    ros::ServiceClient client = ros::NodeHandle().serviceClient<Service>(name, true);
    {
      std::lock_guard<std::mutex> lock(mutex_);
      client_ = client;
      if (given_up_) return {false, "The call of " + name + " was given up."};
    }
    const bool answered = client.call(service);
    std::lock_guard<std::mutex> lock(mutex_);
    if (given_up_) return {false, "The call of " + name + " was given up; the simulator may still carry it out."};
    if (!answered)
      return {false, "The service " + name + " did not answer; check whether the simulator is still running."};
    return {static_cast<bool>(service.response.success), service.response.message};
  }

  void run() {
    std::unique_lock<std::mutex> lock(mutex_);
    while (!ends_) {
      if (!work_) {
        changed_.wait(lock);
        continue;
      }
      const auto work = std::move(work_);
      work_ = nullptr;
      lock.unlock();
      const Answer answer = work();
      lock.lock();
      client_ = ros::ServiceClient();
      busy_ = false;
      lock.unlock();
      report_(answer);
      lock.lock();
    }
  }
};

}  // namespace vibe::rviz_plugins

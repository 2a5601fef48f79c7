#pragma once
#include <ros/node_handle.h>

#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

namespace vibe {

/// Calls the simulator's services from a thread of its own, so that nobody waits: neither for a service that takes
/// long nor for one that hangs. One call at a time.
class ServiceCaller {
 public:
  struct Answer {
    bool success;
    std::string sentence;  ///< the simulator's, or why there is none
  };
  /// Called from the thread of the calls.
  using Report = std::function<void(const Answer&)>;

  explicit ServiceCaller(Report report);
  /// Gives up the call under way.
  ~ServiceCaller();

  // Full names; false: a call is under way.
  bool pause(const std::string& service, bool paused);
  bool step(const std::string& service, unsigned n);
  /// With the scene's seed; stamps go on.
  bool reset(const std::string& service);

  bool isBusy();
  /// Drops the connection of the call under way, which then answers that it was given up. Returns at once; has no
  /// effect on a call that is about to connect, so ask again while it is busy.
  void giveUp();

 private:
  Report report_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::function<Answer()> work_;
  bool busy_ = false, ends_ = false, given_up_ = false;
  ros::ServiceClient client_;  // of the call under way
  std::thread thread_;

  template <class Service>
  bool start(const std::string& name, const Service& service);
  template <class Service>
  Answer call(const std::string& name, Service service);
  void run();
};

}  // namespace vibe

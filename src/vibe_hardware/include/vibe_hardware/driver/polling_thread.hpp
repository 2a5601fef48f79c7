#pragma once
#include <atomic>
#include <functional>
#include <string>
#include <thread>

namespace vibe::hardware {

/// Calls a function again and again until it is destroyed.
class PollingThread {
 public:
  /// @param poll    is called all the time; it waits itself, or returns false to be called again in 5 ms
  /// @param failed  gets the sentence of an exception that `poll` lets out; polling goes on after one second
  PollingThread(std::function<bool()> poll, std::function<void(const std::string&)> failed);
  ~PollingThread();
  PollingThread(const PollingThread&) = delete;
  PollingThread& operator=(const PollingThread&) = delete;

 private:
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace vibe::hardware

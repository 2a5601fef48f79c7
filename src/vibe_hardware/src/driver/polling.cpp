#include "vibe_hardware/driver/polling.hpp"

#include <chrono>
#include <exception>

namespace vibe::hardware {

namespace {

constexpr std::chrono::milliseconds kIdle{5};
constexpr int kAfterFailure = 200;  // idle periods

}  // namespace

PollingThread::PollingThread(std::function<bool()> poll, std::function<void(const std::string&)> failed)
    : thread_([this, poll = std::move(poll), failed = std::move(failed)] {
        int idle = 0;
        while (!stop_) {
          if (idle > 0) {
            --idle;
            std::this_thread::sleep_for(kIdle);
            continue;
          }
          try {
            if (!poll()) idle = 1;
          } catch (const std::exception& error) {
            failed(error.what());
            idle = kAfterFailure;
          }
        }
      }) {}

PollingThread::~PollingThread() {
  stop_ = true;
  thread_.join();
}

bool SilenceWatch::arrived(double now) {
  const bool ends_silence = reported_;
  last_ = now;
  watching_ = true;
  reported_ = false;
  return ends_silence;
}

bool SilenceWatch::expired(double now) {
  if (!watching_ || now - last_ < kLimit) return false;
  watching_ = false;
  reported_ = true;
  return true;
}

}  // namespace vibe::hardware

#include "vibe_vision/camera/capture.hpp"

#include <chrono>
#include <utility>

namespace vibe::vision {

void LatestFrame::put(Frame frame) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (is_fresh_) ++dropped_;
    is_fresh_ = true;
    std::swap(frame_, frame);  // the older one is released outside of the lock
  }
  changed_.notify_one();
}

void LatestFrame::close() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    is_closed_ = true;
  }
  changed_.notify_all();
}

ReadResult LatestFrame::take(Frame& frame, double timeout) {
  std::unique_lock<std::mutex> lock(mutex_);
  changed_.wait_for(lock, std::chrono::duration<double>(timeout), [this] { return is_fresh_ || is_closed_; });
  if (!is_fresh_) return is_closed_ ? ReadResult::End : ReadResult::Timeout;
  is_fresh_ = false;
  frame = std::exchange(frame_, Frame());
  return ReadResult::Frame;
}

std::uint64_t LatestFrame::dropped() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return dropped_;
}

Capture::Capture(std::unique_ptr<FrameSource> source) : source_(std::move(source)), thread_([this] { run(); }) {}

Capture::~Capture() {
  shall_stop_ = true;
  thread_.join();
}

void Capture::run() {
  constexpr double kReadPatience = 0.1;  // of one read: after this it sees whether it shall stop [s]
  try {
    ReadResult result = ReadResult::Timeout;
    while (!shall_stop_ && result != ReadResult::End) {
      Frame frame;
      result = source_->read(frame, kReadPatience);
      is_gone_ = result == ReadResult::Gone;
      if (result == ReadResult::Frame) latest_.put(std::move(frame));
    }
    if (result == ReadResult::End) latest_.close();
  } catch (const std::exception& error) {
    const std::lock_guard<std::mutex> lock(mutex_);
    failure_ = error.what();
    latest_.close();
  }
}

ReadResult Capture::take(Frame& frame, double timeout) {
  const ReadResult result = latest_.take(frame, timeout);
  return result == ReadResult::Timeout && is_gone_ ? ReadResult::Gone : result;
}

std::string Capture::status() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return failure_.empty() ? source_->status() : failure_;
}

}  // namespace vibe::vision

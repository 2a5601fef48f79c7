#include "vibe_vision/camera/capture.hpp"

#include <atomic>
#include <chrono>
#include <mutex>
#include <thread>
#include <utility>

namespace vibe::vision {
namespace {

constexpr double kReadPatience = 0.1;  // of one read: after this the thread sees whether it shall stop [s]

}  // namespace

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

struct Capture::Impl {
  std::unique_ptr<FrameSource> source;
  std::atomic<bool> shall_stop{false};
  std::atomic<bool> is_gone{false};  // at the last read
  LatestFrame latest;
  mutable std::mutex mutex;
  std::string failure;
  std::thread thread;

  explicit Impl(std::unique_ptr<FrameSource> s) : source(std::move(s)), thread([this] { run(); }) {}

  void run() {
    try {
      while (!shall_stop && step()) {
      }
    } catch (const std::exception& error) {
      const std::lock_guard<std::mutex> lock(mutex);
      failure = error.what();
      latest.close();
    }
  }

  bool step() {
    Frame frame;
    const ReadResult result = source->read(frame, kReadPatience);
    is_gone = result == ReadResult::Gone;
    if (result == ReadResult::Frame) latest.put(std::move(frame));
    if (result == ReadResult::End) latest.close();
    return result != ReadResult::End;
  }
};

Capture::Capture(std::unique_ptr<FrameSource> source) : impl_(std::make_unique<Impl>(std::move(source))) {}

Capture::~Capture() {
  impl_->shall_stop = true;
  impl_->thread.join();
}

ReadResult Capture::take(Frame& frame, double timeout) {
  const ReadResult result = impl_->latest.take(frame, timeout);
  return result == ReadResult::Timeout && impl_->is_gone ? ReadResult::Gone : result;
}

std::uint64_t Capture::dropped() const {
  return impl_->latest.dropped();
}

SourceStatistics Capture::statistics() const {
  return impl_->source->statistics();
}

std::string Capture::status() const {
  {
    const std::lock_guard<std::mutex> lock(impl_->mutex);
    if (!impl_->failure.empty()) return impl_->failure;
  }
  return impl_->source->status();
}

}  // namespace vibe::vision

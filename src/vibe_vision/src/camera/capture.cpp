#include "vibe_vision/camera/capture.hpp"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <utility>

namespace vibe::vision {
namespace {

constexpr double kReadPatience = 0.1;  // of one read: after this the thread sees whether it shall stop [s]

}  // namespace

struct Capture::Impl {
  std::unique_ptr<FrameSource> source;
  std::atomic<bool> shall_stop{false};
  mutable std::mutex mutex;
  std::condition_variable changed;
  Frame newest;
  bool is_fresh = false;
  ReadResult state = ReadResult::Timeout;  // of the last read
  std::uint64_t dropped = 0;
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
      state = ReadResult::End;
    }
    changed.notify_all();
  }

  bool step() {
    Frame frame;
    const ReadResult result = source->read(frame, kReadPatience);
    {
      const std::lock_guard<std::mutex> lock(mutex);
      state = result;
      if (result == ReadResult::Frame) {
        if (is_fresh) ++dropped;
        is_fresh = true;
        std::swap(newest, frame);  // the older one is released outside of the lock
      }
    }
    if (result == ReadResult::Frame) changed.notify_one();
    return result != ReadResult::End;
  }
};

Capture::Capture(std::unique_ptr<FrameSource> source) : impl_(std::make_unique<Impl>(std::move(source))) {}

Capture::~Capture() {
  impl_->shall_stop = true;
  impl_->thread.join();
}

ReadResult Capture::take(Frame& frame, double timeout) {
  std::unique_lock<std::mutex> lock(impl_->mutex);
  const auto isOver = [this] { return impl_->is_fresh || impl_->state == ReadResult::End; };
  impl_->changed.wait_for(lock, std::chrono::duration<double>(timeout), isOver);
  if (impl_->is_fresh) {
    impl_->is_fresh = false;
    frame = std::exchange(impl_->newest, Frame());
    return ReadResult::Frame;
  }
  return impl_->state == ReadResult::Frame ? ReadResult::Timeout : impl_->state;
}

std::uint64_t Capture::dropped() const {
  const std::lock_guard<std::mutex> lock(impl_->mutex);
  return impl_->dropped;
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

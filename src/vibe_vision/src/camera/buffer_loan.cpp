#include "camera/buffer_loan.hpp"

namespace vibe::vision {

void BufferLoan::detach() {
  const std::lock_guard<std::mutex> lock(mutex_);
  stream_ = nullptr;
}

std::shared_ptr<const void> BufferLoan::lend(ArvBuffer* buffer) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (lent_ >= kMost) return nullptr;
    ++lent_;
  }
  return {static_cast<const void*>(buffer),
          [self = shared_from_this(), buffer](const void*) { self->takeBack(buffer); }};
}

void BufferLoan::takeBack(ArvBuffer* buffer) {
  const std::lock_guard<std::mutex> lock(mutex_);
  --lent_;
  if (stream_) {
    arv_stream_push_buffer(stream_, buffer);
  } else {
    g_object_unref(buffer);
  }
}

}  // namespace vibe::vision

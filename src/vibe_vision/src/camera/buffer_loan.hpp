#pragma once
#include <memory>
#include <mutex>

#include "camera/aravis_pointer.hpp"

namespace vibe::vision {

/// Buffers of a stream that consumers hold without a copy. Each returns to the stream with its last owner, or is freed
/// if the stream has gone in the meantime. At most kMost are lent, so that the stream never runs out of buffers.
class BufferLoan : public std::enable_shared_from_this<BufferLoan> {
 public:
  static constexpr int kBuffers = 16;  ///< of a stream
  static constexpr int kMost = 8;      ///< lent at once

  explicit BufferLoan(ArvStream* stream) : stream_(stream) {}
  /// The stream ends: buffers that come back later are freed.
  void detach();
  /// @return keeps the buffer; nothing if too many are lent, and then the buffer still belongs to the caller
  std::shared_ptr<const void> lend(ArvBuffer* buffer);

 private:
  std::mutex mutex_;
  ArvStream* stream_;
  int lent_ = 0;

  void takeBack(ArvBuffer* buffer);
};

}  // namespace vibe::vision

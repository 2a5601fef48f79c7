#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <string>

#include <arv.h>

#include "vibe_vision/camera/frame_source.hpp"

namespace vibe::vision {

struct Unref {
  void operator()(gpointer object) const { g_object_unref(object); }
};
template <class T>
using AravisPointer = std::unique_ptr<T, Unref>;

/// Takes the error of a call of Aravis, and frees it.
class AravisError {
 public:
  AravisError() = default;
  ~AravisError() { g_clear_error(&error_); }
  AravisError(const AravisError&) = delete;
  AravisError& operator=(const AravisError&) = delete;

  GError** slot() {
    g_clear_error(&error_);
    return &error_;
  }
  explicit operator bool() const { return error_ != nullptr; }
  std::string text() const { return error_ ? error_->message : ""; }

 private:
  GError* error_ = nullptr;
};

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

/// A connected GigE Vision or USB3 Vision camera that sends frames, until it is destroyed.
class AravisCamera {
 public:
  struct Facts {
    std::string name;                                                              ///< maker, type and serial number
    int x = 0, y = 0, width = 0, height = 0, sensor_width = 0, sensor_height = 0;  ///< [px]
    double exposure = 0, rate = 0;                                                 ///< [s], [Hz]
    bool follows_ptp = false;
    std::string notes;  ///< what was asked for and could not be had
  };

  /// @param name  address, serial number or name; empty: the first that is found
  /// @throws Error with the reason and a remedy
  AravisCamera(const std::string& name, const SourceOptions& options);
  ~AravisCamera();
  AravisCamera(const AravisCamera&) = delete;
  AravisCamera& operator=(const AravisCamera&) = delete;

  const Facts& facts() const { return facts_; }
  bool isLost() const { return is_lost_; }                ///< the control channel has gone
  bool lacksPriority() const { return lacks_priority_; }  ///< real-time priority was asked for and is not permitted
  void abandon() { is_lost_ = true; }                     ///< do not wait for its answer when it is destroyed
  /// The next buffer, also an incomplete one; give it to giveBack() or to loan(). @param timeout [s]
  ArvBuffer* pop(double timeout);
  void giveBack(ArvBuffer* buffer) { arv_stream_push_buffer(stream_.get(), buffer); }
  BufferLoan& loan() { return *loan_; }

 private:
  AravisPointer<ArvCamera> camera_;
  AravisPointer<ArvStream> stream_;
  std::shared_ptr<BufferLoan> loan_;
  Facts facts_;
  int priority_ = 0;
  std::atomic<bool> is_lost_{false}, lacks_priority_{false};

  void connect(const std::string& name);
  void note(const AravisError& error, const std::string& wish);
  void setFormat(const SourceOptions& options);
  void setRegion(const SourceOptions& options);
  void setTimes(const SourceOptions& options);
  void setPackets(const SourceOptions& options);
  void readFacts();
  bool followsPtp();
  void start();
  static void onStream(void* self, ArvStreamCallbackType type, ArvBuffer* buffer);
};

}  // namespace vibe::vision

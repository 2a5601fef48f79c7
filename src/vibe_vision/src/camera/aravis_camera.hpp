#pragma once
#include <atomic>
#include <memory>
#include <string>

#include "camera/aravis_pointer.hpp"
#include "camera/buffer_loan.hpp"
#include "vibe_vision/camera/frame_source.hpp"

namespace vibe::vision {

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

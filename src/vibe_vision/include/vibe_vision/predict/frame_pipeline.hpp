#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "vibe_vision/config/vision_config.hpp"
#include "vibe_vision/datagram/datagram.hpp"
#include "vibe_vision/predict/predictor.hpp"
#include "vibe_vision/track/tracker.hpp"

namespace vibe::vision {

/// What one frame says about the joints of one instrument: as measured, and as the predictors know them.
struct JointSample {
  LostReason reason = LostReason::NoFrame;       ///< None: tracked
  bool has_rotation = false;                     ///< the configuration names a joint for it
  double slide = 0, rotation = 0;                ///< measured [m], [rad]; NaN if lost or not shown
  double variance[2] = {0, 0};                   ///< of slide and rotation [m^2], [rad^2]
  double covariance = 0;                         ///< of slide with rotation [m rad]
  MotionEstimate slide_motion, rotation_motion;  ///< at the stamp of the frame; only if tracked

  bool tracked() const { return reason == LostReason::None; }  ///< false: `reason` says why not
};

/// Turns measurements of an instrument into positions of its joints, and predicts these. Joint = sign * measured value
/// + offset, as configured.
class InstrumentPredictor {
 public:
  /// Knows no motion yet.
  explicit InstrumentPredictor(const InstrumentConfig& instrument) : instrument_(instrument) {}

  /// Takes a measurement. @param time  of the frame [s]
  JointSample update(double time, const Measurement& measurement);
  /// Forgets the motion, for a clock that was set back.
  void reset() { slide_.reset(), rotation_.reset(); }

 private:
  InstrumentConfig instrument_;
  Predictor slide_{kSlidePrior}, rotation_{kRotationPrior};
};

/// Where the time of one frame went [s]; fields as in vibe_msgs/InstrumentTrackArray.
struct StageTimes {
  double transport = 0, wait = 0, track = 0, publish = 0;  ///< before, in and after the tracker, in this order
};

/// Everything about one frame.
struct FrameResult {
  Frame frame;                       ///< as it came; without image after reportSilence()
  Measurements measurements;         ///< of the tracker, one per instrument
  std::vector<JointSample> samples;  ///< of the joints, one per instrument
  StageTimes times;                  ///< publish is filled by the publisher
  double tracked_at = 0;             ///< end of tracking [s]
};

/// What a frame gives to send; sequence and age are left 0.
/// @param samples  one per instrument, as measurements
TrackDatagram makeDatagram(const Frame& frame, const Measurements& measurements,
                           const std::vector<JointSample>& samples);

/// From a frame to the datagram: tracks, updates the predictors, sends. Not thread-safe.
class FramePipeline {
 public:
  struct Options {
    std::string udp;                    ///< host:port; empty: no datagrams
    bool recorded = false;              ///< no age and transport: stamps are not of today
    double silence = 0.1;               ///< without a frame after which instruments are lost [s]
    std::function<double()> host_time;  ///< [s]
  };
  /// @throws Error for a configuration that cannot be tracked, or an address that cannot be resolved
  FramePipeline(const VisionConfig& config, const Options& options);

  /// @return nullptr if the frame's stamp is not later than the last: its result must not be published. A clock set
  ///         back by more than a second begins anew. Valid until the next call
  const FrameResult* process(const Frame& frame);
  /// All instruments lost: no frame. Stamps continue those of the frames.
  const FrameResult& reportSilence();
  void reset();  ///< forgets places and motions; the next stamp has to be later than the last all the same

  const VisionConfig& config() const { return tracker_.config(); }  ///< as it was given
  const UdpSender* sender() const { return sender_.get(); }         ///< for its counts; null: no datagrams are sent
  std::uint64_t disordered() const { return disordered_; }          ///< frames that process() refused, for their stamps

 private:
  Options options_;
  Tracker tracker_;
  std::vector<InstrumentPredictor> predictors_;
  std::unique_ptr<UdpSender> sender_;
  FrameResult result_;
  double last_stamp_ = 0;     // published [s]; 0: none
  double last_frame_ = 0;     // stamp of the last frame [s]; 0: none
  double last_frame_at_ = 0;  // when it was tracked [s]
  std::uint32_t sequence_ = 0;
  std::uint64_t disordered_ = 0;

  bool isInOrder(double stamp);
  void send();
};

}  // namespace vibe::vision

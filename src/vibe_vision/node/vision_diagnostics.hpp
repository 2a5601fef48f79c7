#pragma once
#include <diagnostic_updater/diagnostic_updater.h>

#include <array>
#include <string>

#include "vibe_core/clocks/step_timer.hpp"
#include "vibe_vision/camera/frame_source.hpp"
#include "vibe_vision/datagram/datagram.hpp"
#include "vibe_vision/predict/frame_pipeline.hpp"

namespace vibe::vision {

/// What the entry of the camera on /diagnostics reports. The owner adds times and counts; the window begins with the
/// last entry.
struct CameraDiagnostics {
  double expected_rate = 0;                                ///< [Hz]
  bool recorded = false;                                   ///< no age and transport: stamps are not of today
  ReadResult last = ReadResult::Timeout;                   ///< of the last attempt to get a frame
  double last_frame = -1e9;                                ///< when the last frame was tracked, steady clock [s]
  std::uint64_t frames = 0, disordered = 0;                ///< tracked; thrown away since their stamps do not grow
  DurationHistogram transport, wait, track, publish, age;  ///< of the window [s]

  // as they are now
  SourceStatistics source;
  std::uint64_t dropped = 0, sent = 0, failed = 0;
  std::string status;
  double reported = -1;  ///< when there was an entry [s], steady clock; -1: never
};

/// ERROR if no frames come; WARN if since the last entry frames were lost, incomplete, unreadable, dropped or in
/// disorder, datagrams failed, the rate is below 90 % of the expected one, or a recording has ended.
/// @param now  steady clock [s]. @param memory  as it was then
void fillCameraDiagnostics(const CameraDiagnostics& camera, double now, CameraDiagnostics& memory,
                           diagnostic_updater::DiagnosticStatusWrapper& status);

constexpr std::size_t kLostReasons = 10;

struct InstrumentDiagnostics {
  std::array<std::uint64_t, kLostReasons> frames{};  ///< by LostReason; the first: tracked
  std::uint64_t reacquired = 0;
  Doubt doubt = Doubt::None;  ///< of the last tracked frame
  double score = 0;
  JointSample last;

  void add(const Measurement& measurement, const JointSample& sample);
};

/// ERROR if it was lost in all frames since the last entry, with the reason; WARN if in some.
void fillInstrumentDiagnostics(const InstrumentDiagnostics& instrument, InstrumentDiagnostics& memory,
                               diagnostic_updater::DiagnosticStatusWrapper& status);

}  // namespace vibe::vision

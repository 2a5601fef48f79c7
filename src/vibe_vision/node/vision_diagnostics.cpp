#include "vision_diagnostics.hpp"

#include <cmath>

namespace vibe::vision {
namespace {

using diagnostic_msgs::DiagnosticStatus;
using diagnostic_updater::DiagnosticStatusWrapper;

constexpr double kSilence = 1;    // without a frame after which the camera counts as silent [s]
constexpr double kLowRate = 0.9;  // of the expected rate

void warnIf(bool condition, const std::string& sentence, DiagnosticStatusWrapper& status) {
  if (condition) status.mergeSummary(DiagnosticStatus::WARN, sentence);
}

void addTimes(const std::string& name, const DurationHistogram& times, DiagnosticStatusWrapper& status) {
  status.addf(name + " [ms]", "%.3f", 1e3 * times.quantile(0.5));
  status.addf(name + ", longest [ms]", "%.3f", 1e3 * times.max());
}

void addCamera(const CameraDiagnostics& camera, double rate, DiagnosticStatusWrapper& status) {
  status.add("source", camera.status);
  status.addf("rate [Hz]", "%.1f", rate);
  status.add("frames", camera.frames);
  status.add("lost frames", camera.source.lost);
  status.add("incomplete frames", camera.source.incomplete);
  status.add("unreadable frames", camera.source.unreadable);
  status.add("dropped frames", camera.dropped);
  status.add("frames with disordered stamps", camera.disordered);
  status.add("reconnects", camera.source.reconnects);
  status.add("datagrams sent", camera.sent);
  status.add("datagrams failed", camera.failed);
  if (!camera.recorded) addTimes("age of a frame after tracking", camera.age, status);
  if (!camera.recorded) addTimes("transport", camera.transport, status);
  addTimes("wait", camera.wait, status);
  addTimes("track", camera.track, status);
  addTimes("publish", camera.publish, status);
}

void compare(const CameraDiagnostics& camera, const CameraDiagnostics& memory, DiagnosticStatusWrapper& status) {
  warnIf(camera.source.lost > memory.source.lost, "frames were lost", status);
  warnIf(camera.source.incomplete > memory.source.incomplete, "frames were incomplete", status);
  warnIf(camera.source.unreadable > memory.source.unreadable, camera.status, status);
  warnIf(camera.dropped > memory.dropped, "frames came faster than they were tracked", status);
  warnIf(camera.disordered > memory.disordered, "stamps of frames did not grow", status);
  warnIf(camera.failed > memory.failed, "datagrams could not be sent", status);
}

}  // namespace

void fillCameraDiagnostics(const CameraDiagnostics& camera, double now, CameraDiagnostics& memory,
                           DiagnosticStatusWrapper& status) {
  const double span = now - memory.reported;
  const double rate = memory.reported >= 0 && span > 0 ? static_cast<double>(camera.frames - memory.frames) / span : 0;
  if (camera.last == ReadResult::End) {
    status.summary(DiagnosticStatus::WARN, "the recording has ended");
  } else if (camera.last == ReadResult::Gone || now - camera.last_frame > kSilence) {
    status.summary(DiagnosticStatus::ERROR, "no images: " + camera.status);
  } else {
    status.summary(DiagnosticStatus::OK, "running");
    warnIf(memory.reported >= 0 && rate < kLowRate * camera.expected_rate, "the rate is low", status);
  }
  compare(camera, memory, status);
  addCamera(camera, rate, status);
  memory = camera;
  memory.reported = now;
}

void InstrumentDiagnostics::add(const Measurement& measurement, const JointSample& sample) {
  ++frames[static_cast<std::size_t>(sample.reason)];
  if (sample.tracked() && measurement.reacquired) ++reacquired;
  score = measurement.score;
  if (sample.tracked()) doubt = measurement.doubt;
  last = sample;
}

void fillInstrumentDiagnostics(const InstrumentDiagnostics& instrument, InstrumentDiagnostics& memory,
                               DiagnosticStatusWrapper& status) {
  std::uint64_t lost = 0, most = 0;
  auto reason = LostReason::NoFrame;
  for (std::size_t i = 1; i < kLostReasons; ++i) {
    const std::uint64_t since = instrument.frames[i] - memory.frames[i];
    lost += since;
    if (since > most) reason = static_cast<LostReason>(i);
    most = std::max(most, since);
  }
  const std::uint64_t tracked = instrument.frames[0] - memory.frames[0];
  if (tracked == 0) {
    status.summaryf(DiagnosticStatus::ERROR, "lost: %s", toText(reason));
  } else if (lost > 0) {
    status.summaryf(DiagnosticStatus::WARN, "lost in %llu of %llu frames: %s", static_cast<unsigned long long>(lost),
                    static_cast<unsigned long long>(lost + tracked), toText(reason));
  } else {
    status.summary(DiagnosticStatus::OK, "tracked");
  }
  warnIf(instrument.doubt != Doubt::None && tracked > 0, toText(instrument.doubt), status);
  status.add("tracked frames", instrument.frames[0]);
  for (std::size_t i = 1; i < kLostReasons; ++i)
    status.add(std::string("lost frames: ") + toText(static_cast<LostReason>(i)), instrument.frames[i]);
  status.add("found again by a search", instrument.reacquired);
  status.addf("score", "%.3f", instrument.score);
  status.addf("slide [mm]", "%.3f", 1e3 * instrument.last.slide);
  status.addf("standard deviation of the slide [um]", "%.2f", 1e6 * std::sqrt(instrument.last.variance[0]));
  if (instrument.last.has_rotation) status.addf("rotation [deg]", "%.2f", instrument.last.rotation * 180 / M_PI);
  memory = instrument;
}

}  // namespace vibe::vision

#pragma once
#include <unistd.h>

#include <cstdio>
#include <string>
#include <vector>

#include "vibe_core/program/error.hpp"
#include "vibe_vision/calibrate/calibration_check.hpp"
#include "vibe_vision/camera/frame_source.hpp"

namespace vibe::vision {

constexpr int kHolds = 0, kDoesNotHold = 1, kNotShown = 3;  ///< exit status of a check

/// Reads a motion of some seconds into a check. @throws Error if a camera is silent, or there is no frame at all
inline void watchMotion(FrameSource& source, const VisionConfig& config, double seconds, CalibrationCheck& check) {
  constexpr double kPatience = 10;  // without a frame [s]
  Frame frame;
  ReadResult result = ReadResult::Timeout;
  double first = -1, told = 0, silent = 0;
  while ((result = source.read(frame, 1)) != ReadResult::End && silent < kPatience) {
    if (result != ReadResult::Frame) {
      silent += 1;
      continue;
    }
    silent = 0;
    requireSize(config.camera, frame.sensor_width, frame.sensor_height, "the images have",
                "use the configuration of the camera that took them");
    if (first < 0) first = told = frame.stamp;
    if (frame.stamp - first > seconds) return;
    check.add(frame);
    if (!isatty(STDERR_FILENO) || frame.stamp - told < 1) continue;
    told = frame.stamp;
    std::fprintf(stderr, "\r%.0f of %.0f s:", frame.stamp - first, seconds);
    for (const CheckedInstrument& i : check.result())
      std::fprintf(stderr, " %s %.1f to %.1f mm ", i.name.c_str(), 1e3 * i.from, 1e3 * i.to);
  }
  if (isatty(STDERR_FILENO)) std::fprintf(stderr, "\n");
  if (first < 0 || result != ReadResult::End) throw Error(source.status() + "; no frames came for the check");
}

inline const char* toWord(Verdict verdict) {
  return verdict == Verdict::Holds ? "holds" : verdict == Verdict::Wrong ? "WRONG" : "not shown";
}

/// Prints what a motion said. @return the exit status
inline int printCheck(const VisionConfig& config, const std::vector<CheckedInstrument>& instruments) {
  std::string wrong, unknown;
  for (std::size_t i = 0; i < instruments.size(); ++i) {
    const CheckedInstrument& checked = instruments[i];
    std::printf("%s: seen in %llu of %llu frames, from %.1f to %.1f mm of %.1f to %.1f mm\n", checked.name.c_str(),
                static_cast<unsigned long long>(checked.tracked), static_cast<unsigned long long>(checked.frames),
                1e3 * checked.from, 1e3 * checked.to, 1e3 * config.instruments[i].lower,
                1e3 * config.instruments[i].upper);
    for (const CheckedQuantity& q : checked.quantities) {
      std::printf("  %-12s %-9s  %s\n", q.name.c_str(), toWord(q.verdict), q.text.c_str());
      std::string* list = q.verdict == Verdict::Wrong ? &wrong : q.verdict == Verdict::Unknown ? &unknown : nullptr;
      if (list != nullptr) *list += (list->empty() ? "" : ", ") + checked.name + " " + q.name;
    }
  }
  if (!wrong.empty()) std::printf("The calibration does not hold: %s.\n", wrong.c_str());
  if (!unknown.empty()) std::printf("The motion does not show: %s.\n", unknown.c_str());
  if (wrong.empty() && unknown.empty()) std::printf("The calibration holds.\n");
  return !wrong.empty() ? kDoesNotHold : unknown.empty() ? kHolds : kNotShown;
}

}  // namespace vibe::vision

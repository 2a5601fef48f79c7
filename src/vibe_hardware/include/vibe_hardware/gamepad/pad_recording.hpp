#pragma once
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "vibe_hardware/gamepad/pad_source.hpp"

namespace vibe::hardware {

/// A recorded pad session in the text format of evemu (evemu-record, evemu-play): lines N (name), I (bus, vendor,
/// product, version), B (bits of buttons), A (axes: code, minimum, maximum, fuzz, flat), E (events: time, type, code,
/// value).
struct PadRecording {
  PadInfo info;                  ///< of the pad that was recorded
  PadState state;                ///< before the first event: axes in the middle of their range, buttons up
  std::vector<PadEvent> events;  ///< times do not decrease
};

/// @throws Error "file:line: what is wrong; remedy"
PadRecording loadPadRecording(const std::string& file);
/// The same from text. @param place  name used in errors
PadRecording parsePadRecording(const std::string& text, const std::string& place);

/// Plays a recording as if the pad were there. Its time begins with the first call of update(); after the last event
/// the pad is gone.
std::unique_ptr<PadSource> playPadRecording(PadRecording recording);

/// Writes a pad session, event by event.
class PadRecorder {
 public:
  /// @throws Error if the file cannot be written
  PadRecorder(const std::string& file, const PadInfo& info, const PadState& state);
  ~PadRecorder();
  PadRecorder(const PadRecorder&) = delete;
  PadRecorder& operator=(const PadRecorder&) = delete;

  /// Writes an event, its time counted from the first one; it is in the file with the next EV_SYN.
  void add(const PadEvent& event);

  /// To be called before a pad is there. Leaves the file as it is. @throws Error if it cannot be written
  static void checkFile(const std::string& file);

 private:
  std::FILE* file_;
  double begin_ = -1;  // time of the first event [s]

  void writeHeader(const PadInfo& info, const PadState& state);
};

}  // namespace vibe::hardware

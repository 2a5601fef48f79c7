#include "vibe_hardware/gamepad/pad_recording.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <sstream>
#include <vector>

#include <linux/input-event-codes.h>

#include "vibe_core/files/files.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe::hardware {

namespace {

constexpr double kLongest = 86400;  // a day [s]

/// Reads the lines of a recording one by one.
class RecordingParser {
 public:
  explicit RecordingParser(std::string place) : place_(std::move(place)) {}

  void line(const std::string& text) {
    ++number_;
    if (text.empty() || text[0] == '#' || text == "\r") return;
    if (text.size() < 2 || text[1] != ':') fail("is no line of a recording; write 'E: ...' or begin a comment with #");
    const std::string rest = text.substr(2);
    switch (text[0]) {
      case 'N':
        return readName(rest);
      case 'I':
        return readId(rest);
      case 'B':
        return readBits(rest);
      case 'A':
        return readAxis(rest);
      case 'E':
        return readEvent(rest);
      case 'P':
      case 'L':
      case 'S':
        return;  // properties, lamps, switches: not used
      default:
        fail(std::string("begins with the unknown letter '") + text[0] + "'; known are N, I, P, B, A, L, S, E");
    }
  }

  PadRecording finish() {
    if (recording_.events.empty()) throw Error(place_ + ": has no events; record some with vibe_gamepad --record");
    return recording_;
  }

 private:
  std::string place_;
  int number_ = 0;
  PadRecording recording_;
  std::vector<int> bytes_ = std::vector<int>(EV_CNT, 0);  // of the bits so far, by event type

  [[noreturn]] void fail(const std::string& what) const {
    throw Error(place_ + ":" + std::to_string(number_) + ": " + what);
  }

  void readName(const std::string& rest) {
    const std::size_t begin = rest.find_first_not_of(' ');
    recording_.info.name = begin == std::string::npos ? "" : rest.substr(begin);
  }

  void readId(const std::string& rest) {
    PadInfo& info = recording_.info;
    std::istringstream stream(rest);
    if (!(stream >> std::hex >> info.bus >> info.vendor >> info.product >> info.version))
      fail("needs four hexadecimal numbers: bus, vendor, product, version");
  }

  void readBits(const std::string& rest) {
    std::istringstream stream(rest);
    int type = 0, bits = 0;
    stream >> std::hex >> type;
    if (!stream || type < 0 || type >= EV_CNT) fail("needs an event type from 00 to 1f and bytes in hexadecimal");
    while (stream >> bits) {
      if (bits < 0 || bits > 0xff) fail("has a byte that is not from 00 to ff; write bytes in hexadecimal");
      const int first = 8 * bytes_[static_cast<std::size_t>(type)]++;
      for (int bit = 0; type == EV_KEY && bit < 8; ++bit)
        if ((bits >> bit & 1) != 0 && first + bit < KEY_CNT) recording_.state.buttons[first + bit];
    }
    if (!stream.eof()) fail("has something that is not a byte; write bytes in hexadecimal");
  }

  void readAxis(const std::string& rest) {
    std::istringstream stream(rest);
    int code = 0;
    PadAxis axis;
    if (!(stream >> std::hex >> code >> std::dec >> axis.minimum >> axis.maximum) || code < 0 || code >= ABS_CNT)
      fail("needs a code in hexadecimal and the axis' minimum and maximum");
    if (axis.minimum > axis.maximum) fail("has a minimum that is above its maximum; write them in order");
    if (axis.minimum == axis.maximum) return;  // some pads describe axes that they do not have
    axis.is_known = false;
    recording_.state.axes[code] = axis;
  }

  void readEvent(const std::string& rest) {
    std::istringstream stream(rest);
    PadEvent event;
    if (!(stream >> event.time >> std::hex >> event.type >> event.code >> std::dec >> event.value))
      fail("needs a time, type and code in hexadecimal, and a value");
    const double last = recording_.events.empty() ? event.time : recording_.events.back().time;
    if (!(event.time >= last)) fail("goes back in time; sort the events by time");
    if (!recording_.events.empty() && event.time - recording_.events.front().time > kLongest)
      fail("is more than a day after the first event; shorten the recording");
    recording_.events.push_back(event);
  }
};

/// The events of a recording, when they are due.
class RecordedPad : public PadSource {
 public:
  explicit RecordedPad(PadRecording recording) : recording_(std::move(recording)), state_(recording_.state) {
    recording_.info.is_recording = true;
  }

  const PadInfo& info() const override { return recording_.info; }
  const PadState& state() const override { return state_; }
  PadMotors* motors() override { return nullptr; }
  std::uint64_t eventCount() const override { return next_; }
  std::uint64_t dropCount() const override { return 0; }
  void setListener(std::function<void(const PadEvent&)> listener) override { listener_ = std::move(listener); }

  bool update(double now) override {
    const std::vector<PadEvent>& events = recording_.events;
    if (begin_ < 0) begin_ = now;
    if (next_ == events.size()) return false;
    const double due = now - begin_ + events.front().time;
    for (; next_ < events.size() && events[next_].time <= due; ++next_) {
      state_.apply(events[next_]);
      if (listener_) listener_(events[next_]);
    }
    return true;
  }

 private:
  PadRecording recording_;
  PadState state_;
  std::size_t next_ = 0;
  double begin_ = -1;  // steady time of the first event [s]
  std::function<void(const PadEvent&)> listener_;
};

}  // namespace

PadRecording parsePadRecording(const std::string& text, const std::string& place) {
  RecordingParser parser(place);
  std::istringstream stream(text);
  std::string line;
  while (std::getline(stream, line)) parser.line(line);
  return parser.finish();
}

PadRecording loadPadRecording(const std::string& file) {
  PadRecording recording = parsePadRecording(readTextFile(file, "recording of a gamepad"), file);
  recording.info.path = file;
  return recording;
}

std::unique_ptr<PadSource> playPadRecording(PadRecording recording) {
  return std::make_unique<RecordedPad>(std::move(recording));
}

namespace {

std::FILE* openFile(const std::string& file, const char* mode) {
  std::FILE* result = std::fopen(file.c_str(), mode);  // not whole: a log
  if (result == nullptr)
    throw Error("Cannot write the pad recording '" + file + "' (" + std::strerror(errno) + "); choose another file.");
  return result;
}

}  // namespace

PadRecorder::PadRecorder(const std::string& file, const PadInfo& info, const PadState& state)
    : file_(openFile(file, "w")) {
  writeHeader(info, state);
}

void PadRecorder::checkFile(const std::string& file) {
  std::error_code unknown;
  const bool is_new = !std::filesystem::exists(file, unknown);
  std::fclose(openFile(file, "a"));
  if (is_new) std::filesystem::remove(file, unknown);
}

PadRecorder::~PadRecorder() {
  std::fclose(file_);
}

void PadRecorder::writeHeader(const PadInfo& info, const PadState& state) {
  std::fprintf(file_, "# EVEMU 1.3\nN: %s\n", info.name.c_str());
  std::fprintf(file_, "I: %04x %04x %04x %04x\n", static_cast<unsigned>(info.bus), static_cast<unsigned>(info.vendor),
               static_cast<unsigned>(info.product), static_cast<unsigned>(info.version));
  std::fprintf(file_, "P: 00 00 00 00 00 00 00 00\nB: 00 0b 00 00 00 00 00 00 00\n");
  std::vector<int> bytes(KEY_CNT / 8, 0);
  for (const auto& [code, button] : state.buttons) bytes[static_cast<std::size_t>(code) / 8] |= 1 << code % 8;
  for (std::size_t first = 0; first < bytes.size(); first += 8) {
    std::fprintf(file_, "B: 01");
    for (std::size_t i = first; i < first + 8; ++i) std::fprintf(file_, " %02x", static_cast<unsigned>(bytes[i]));
    std::fprintf(file_, "\n");
  }
  std::vector<int> axes(8, 0);
  for (const auto& [code, axis] : state.axes) axes[static_cast<std::size_t>(code) / 8] |= 1 << code % 8;
  std::fprintf(file_, "B: 03");
  for (const int byte : axes) std::fprintf(file_, " %02x", static_cast<unsigned>(byte));
  std::fprintf(file_, "\n");
  for (const auto& [code, axis] : state.axes)
    std::fprintf(file_, "A: %02x %d %d 0 0 0\n", static_cast<unsigned>(code), axis.minimum, axis.maximum);
  // the format has no state at the beginning, so it begins with events that bring the axes to where they are
  for (const auto& [code, axis] : state.axes)
    if (axis.is_known)
      std::fprintf(file_, "E: 0.000000 %04x %04x %d\n", static_cast<unsigned>(EV_ABS), static_cast<unsigned>(code),
                   axis.value);
  std::fprintf(file_, "E: 0.000000 0000 0000 0\n");
  std::fflush(file_);
}

void PadRecorder::add(const PadEvent& event) {
  if (begin_ < 0) begin_ = event.time;
  std::fprintf(file_, "E: %.6f %04x %04x %d\n", std::max(0.0, event.time - begin_), static_cast<unsigned>(event.type),
               static_cast<unsigned>(event.code), event.value);
  if (event.type == EV_SYN) std::fflush(file_);
}

}  // namespace vibe::hardware

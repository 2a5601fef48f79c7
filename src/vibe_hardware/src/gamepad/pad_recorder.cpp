#include <linux/input-event-codes.h>

#include <algorithm>
#include <filesystem>
#include <vector>

#include "vibe_core/common/error.hpp"
#include "vibe_hardware/gamepad/pad_recording.hpp"

namespace vibe::hardware {
namespace {

std::FILE* openFile(const std::string& file, const char* mode) {
  std::FILE* result = std::fopen(file.c_str(), mode);
  if (result == nullptr) throw Error("Cannot write the pad recording '" + file + "'; check its folder.");
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

#include "vibe_hardware/emulator/recorded_hand.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string_view>

#include "vibe_core/files/csv_row.hpp"
#include "vibe_core/files/files.hpp"
#include "vibe_core/files/number_text.hpp"
#include "vibe_core/input/joint_unit.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_core/scene/words.hpp"

namespace vibe::hardware {
namespace {

// Numbers of columns: 0 is the time, then joints, then buttons.
constexpr int kFirstOptional = 1 + kScopeJointCount, kFirstButton = 1 + kJointCount;

std::vector<std::string> columnNames() {
  std::vector<std::string> names{"time"};
  names.insert(names.end(), kJointNames.begin(), kJointNames.end());
  names.insert(names.end(), kButtonNames.begin(), kButtonNames.end());
  return names;
}

std::string show(double value, int joint) {
  return formatted("%.4g %s", value, jointUnit(joint));
}

}  // namespace

HandLimits handLimits(const Calibration& calibration) {
  HandLimits limits;
  for (std::size_t joint = 0; joint < kJointCount; ++joint) {
    if (joint < kScopeJointCount) {
      limits[joint] = {calibration.joints[joint].lower, calibration.joints[joint].upper};
    } else if (calibration.suturing_device) {
      const ButtonDrive& drive = (*calibration.suturing_device)[joint - kScopeJointCount];
      limits[joint] = {drive.lower, drive.upper};
    }
  }
  return limits;
}

/// Reads the text of a recording line by line.
class RecordingReader {
 public:
  RecordingReader(std::string_view text, std::string place, const HandLimits& limits)
      : rest_(text), place_(std::move(place)), limits_(limits) {}

  RecordedHand read() {
    std::string_view line;
    if (!next(line)) throw Error(place_ + ": is empty; the first line has the names of the columns, then rows follow.");
    readHeader(line);
    while (next(line)) readRow(line);
    if (hand_.rows_.empty()) fail("has no row below the names of the columns; add at least one");
    return std::move(hand_);
  }

 private:
  [[noreturn]] void fail(const std::string& what_and_remedy) const {
    const char* end = what_and_remedy.back() == '?' ? "" : ".";
    throw Error(place_ + ":" + std::to_string(line_) + ": " + what_and_remedy + end);
  }

  /// The next line that counts.
  bool next(std::string_view& line) {
    while (!rest_.empty()) {
      const std::size_t end = rest_.find('\n');
      line = trimmed(rest_.substr(0, end));
      rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
      ++line_;
      if (!line.empty() && line.front() != '#') return true;
    }
    return false;
  }

  void readHeader(std::string_view line) {
    const std::vector<std::string> names = columnNames();
    std::vector<bool> seen(names.size(), false);
    for (const std::string& cell : cellsOf(line)) {
      const auto found = std::find(names.begin(), names.end(), cell);
      if (found == names.end()) fail("column '" + cell + "' is not known; " + suggestKey(cell, names));
      const auto column = found - names.begin();
      if (seen[column]) fail("column '" + names[column] + "' is there twice; remove one");
      seen[column] = true;
      columns_.push_back(static_cast<int>(column));
    }
    for (int column = 0; column < kFirstOptional; ++column)
      if (!seen[column]) fail("column '" + names[column] + "' is missing; add it");
  }

  void readRow(std::string_view line) {
    const std::vector<std::string> cells = cellsOf(line);
    if (cells.size() != columns_.size())
      fail("has " + std::to_string(cells.size()) + " values; write " + std::to_string(columns_.size()) +
           ", one for each column");
    RecordedHand::Row row;
    for (std::size_t i = 0; i < cells.size(); ++i) readCell(cells[i], columns_[i], row);
    if (!hand_.rows_.empty() && row.time <= hand_.rows_.back().time)
      fail("time " + std::to_string(row.time) + " does not follow the time of the row before; sort the rows by time");
    if (hand_.rows_.empty() && row.time < 0) fail("time is negative; begin at 0 or later");
    if (hand_.rows_.size() == RecordedHand::kMaxRows) fail("is too long; shorten the recording");
    hand_.rows_.push_back(row);
  }

  void readCell(const std::string& cell, int column, RecordedHand::Row& row) const {
    const std::string name = columnNames()[column];
    const double value = numberOf(cell).value_or(std::nan(""));
    if (!std::isfinite(value)) fail(name + ": '" + cell + "' is not a finite number; write one, with a point");
    if (column == 0) {
      row.time = value;
    } else if (column < kFirstButton) {
      checkRange(value, column - 1);
      row.sample.joints[column - 1] = value;
    } else {
      if (value != 0 && value != 1) fail(name + ": '" + cell + "' is not 0 or 1; write 1 while it is pressed");
      row.sample.buttons[column - kFirstButton] = value != 0 ? 1 : 0;
    }
  }

  /// A hand pushes a little beyond a limit; values in other units are far beyond.
  void checkRange(double value, int joint) const {
    const JointRange& range = limits_[joint];
    const double width = range.upper - range.lower;
    if (value >= range.lower - width && value <= range.upper + width) return;
    fail(std::string(kJointNames[joint]) + ": " + show(value, joint) +
         " is far beyond the limits of the calibration, " + show(range.lower, joint) + " to " +
         show(range.upper, joint) + "; write positions in m and rad");
  }

  std::string_view rest_;
  std::string place_;
  const HandLimits& limits_;
  int line_ = 0;
  std::vector<int> columns_;
  RecordedHand hand_;
};

RecordedHand RecordedHand::load(const std::string& file, const HandLimits& limits) {
  if (std::filesystem::is_directory(file))
    throw Error("'" + file + "' is a folder; name the CSV file of a hand in it.");
  return parse(readTextFile(file, "recorded hand"), file, limits);
}

RecordedHand RecordedHand::parse(const std::string& text, const std::string& place, const HandLimits& limits) {
  return RecordingReader(text, place, limits).read();
}

HandSample RecordedHand::at(double time) const {
  const auto after =
      std::upper_bound(rows_.begin(), rows_.end(), time, [](double t, const Row& row) { return t < row.time; });
  if (after == rows_.begin()) return rows_.front().sample;
  const Row& from = *(after - 1);
  if (after == rows_.end()) return from.sample;
  HandSample sample = from.sample;
  const double part = (time - from.time) / (after->time - from.time);
  for (std::size_t i = 0; i < sample.joints.size(); ++i)
    sample.joints[i] += part * (after->sample.joints[i] - from.sample.joints[i]);
  return sample;
}

}  // namespace vibe::hardware

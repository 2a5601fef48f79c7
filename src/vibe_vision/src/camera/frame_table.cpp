#include "camera/frame_table.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>

#include "vibe_core/files/csv_row.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe::vision {
namespace {

constexpr double kMaxSequence = 9e15;  // integers that a double holds

/// A line below the first one, which names the columns.
struct Line {
  const std::vector<std::string>& names;
  std::string place;  ///< "file:7: "
  std::vector<std::string> values;

  double number(const std::string& name, double otherwise) const {
    const auto column = std::find(names.begin(), names.end(), name);
    if (column == names.end()) return otherwise;
    const std::string& text = values[static_cast<std::size_t>(column - names.begin())];
    const double value = numberOf(text).value_or(-1);
    if (!std::isfinite(value) || value < 0)
      throw Error(place + name + " is \"" + text + "\"; it must be a number of seconds, 0 or more.");
    if (name == "sequence" && (value != std::floor(value) || value >= kMaxSequence))
      throw Error(place + name + " is \"" + text + "\"; it must be a whole number.");
    return value;
  }

  /// @param exposure  of all frames if the file does not say
  FrameTable::Row row(std::size_t index, double exposure) const {
    if (values.size() != names.size())
      throw Error(place + std::to_string(values.size()) + " values, but the first line names " +
                  std::to_string(names.size()) + " columns; complete or remove this line.");
    const double stamp = number("stamp", 0), time = number("exposure", exposure);
    return {static_cast<std::uint64_t>(number("sequence", static_cast<double>(index))), stamp, time};
  }
};

}  // namespace

FrameTable FrameTable::load(const std::string& file, double exposure) {
  std::ifstream stream(file);
  if (!stream) throw Error(file + ": cannot be read; check that it exists and its permissions.");
  std::string line;
  std::getline(stream, line);
  line.erase(std::remove(line.begin(), line.end(), '#'), line.end());  // before the names, as many programs write
  const std::vector<std::string> names = cellsOf(line);
  if (std::find(names.begin(), names.end(), "stamp") == names.end())
    throw Error(file +
                ":1: no column is called stamp; the first line must name the columns, such as "
                "\"sequence,stamp,exposure\".");
  FrameTable table{{}, file};
  for (int number = 2; std::getline(stream, line); ++number) {
    if (trimmed(line).empty()) continue;
    const std::string place = file + ":" + std::to_string(number) + ": ";
    const Row row = Line{names, place, cellsOf(line)}.row(table.rows.size(), exposure);
    if (!table.rows.empty() && row.stamp <= table.rows.back().stamp)
      throw Error(place + "stamp does not increase; sort the lines by time.");
    if (!table.rows.empty() && row.sequence <= table.rows.back().sequence)
      throw Error(place + "sequence does not increase; sort the lines by time.");
    table.rows.push_back(row);
  }
  return table;
}

}  // namespace vibe::vision

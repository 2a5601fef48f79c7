#include "camera/frame_table.hpp"

#include <cmath>
#include <cstdlib>
#include <fstream>

#include "vibe_core/program/error.hpp"

namespace vibe::vision {
namespace {

constexpr double kMaxSequence = 9e15;  // integers that a double holds

std::vector<std::string> cells(const std::string& line) {
  std::vector<std::string> all(1);
  for (const char c : line) {
    if (c == ',') all.emplace_back();
    if (c != ',' && c != ' ' && c != '\t' && c != '\r' && c != '#') all.back() += c;
  }
  return all;
}

class Reader {
 public:
  Reader(const std::string& file, double exposure) : file_(file), exposure_(exposure), stream_(file) {
    if (!stream_) throw Error(file + ": cannot be read; check that it exists and its permissions.");
  }

  FrameTable read() {
    FrameTable table;
    table.file = file_;
    header();
    std::string line;
    while (std::getline(stream_, line)) {
      ++line_;
      if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
      table.rows.push_back(row(cells(line), table.rows.size()));
      if (table.rows.size() > 1) checkOrder(table.rows[table.rows.size() - 2], table.rows.back());
    }
    return table;
  }

 private:
  std::string file_;
  double exposure_;
  std::ifstream stream_;
  int line_ = 1;
  int stamp_ = -1, sequence_ = -1, exposure_column_ = -1;
  std::size_t columns_ = 0;

  std::string place() const { return file_ + ":" + std::to_string(line_) + ": "; }

  void header() {
    std::string line;
    std::getline(stream_, line);
    const std::vector<std::string> names = cells(line);
    columns_ = names.size();
    for (int i = 0; i < static_cast<int>(names.size()); ++i) {
      if (names[i] == "stamp") stamp_ = i;
      if (names[i] == "sequence") sequence_ = i;
      if (names[i] == "exposure") exposure_column_ = i;
    }
    if (stamp_ < 0) {
      throw Error(place() + "no column is called stamp; the first line must name the columns, such as " +
                  "\"sequence,stamp,exposure\".");
    }
  }

  FrameTable::Row row(const std::vector<std::string>& values, std::size_t index) const {
    if (values.size() != columns_) {
      throw Error(place() + std::to_string(values.size()) + " values, but the first line names " +
                  std::to_string(columns_) + " columns; complete or remove this line.");
    }
    FrameTable::Row row;
    row.stamp = number(values[stamp_], "stamp");
    row.exposure = exposure_column_ < 0 ? exposure_ : number(values[exposure_column_], "exposure");
    row.sequence = sequence_ < 0 ? index : sequence(values[sequence_]);
    return row;
  }

  double number(const std::string& text, const char* name) const {
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    if (!text.empty() && *end == '\0' && std::isfinite(value) && value >= 0) return value;
    throw Error(place() + name + " is \"" + text + "\"; it must be a number of seconds, 0 or more.");
  }

  std::uint64_t sequence(const std::string& text) const {
    const double value = number(text, "sequence");
    if (value == std::floor(value) && value < kMaxSequence) return static_cast<std::uint64_t>(value);
    throw Error(place() + "sequence is \"" + text + "\"; it must be a whole number.");
  }

  void checkOrder(const FrameTable::Row& before, const FrameTable::Row& after) const {
    if (after.stamp <= before.stamp) throw Error(place() + "stamp does not increase; sort the lines by time.");
    if (after.sequence <= before.sequence) throw Error(place() + "sequence does not increase; sort the lines by time.");
  }
};

}  // namespace

FrameTable FrameTable::load(const std::string& file, double exposure) {
  return Reader(file, exposure).read();
}

}  // namespace vibe::vision

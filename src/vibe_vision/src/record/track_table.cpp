#include "vibe_vision/record/track_table.hpp"

#include <algorithm>
#include <cinttypes>
#include <cmath>

#include "vibe_core/files/number_text.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe::vision {
namespace {

const char* const kColumns =
    "sequence,stamp,instrument,tracked,reason,slide,slide_deviation,rotation,rotation_deviation,score,visible,x,y,"
    "along,lateral,scale,tilt,contrast,reacquired,doubt";

/// A name for a CSV field.
std::string field(const std::string& text) {
  if (text.find_first_of(",\"") == std::string::npos) return text;
  std::string result = "\"";
  for (const char c : text) result += c == '"' ? std::string("\"\"") : std::string(1, c);
  return result + "\"";
}

/// Enough digits for 1e-9 m; empty for what is not known.
std::string number(double value) {
  if (!std::isfinite(value)) return "";
  return formatted("%.10g", value);
}

std::string rowOf(const Measurement& m) {
  if (!m.tracked()) return std::string("0,") + toWord(m.reason) + ",,,,,0,,,,,,,,,0,";
  const bool turns = std::isfinite(m.rotation);
  std::string row = "1,,";
  row += number(m.slide) + "," + number(std::sqrt(m.covariance(0, 0))) + ",";
  row += turns ? number(m.rotation) + "," + number(std::sqrt(m.covariance(1, 1))) : std::string(",");
  for (const double value :
       {m.score, m.visible, m.pixel.x(), m.pixel.y(), m.along, m.lateral, m.scale, m.tilt, m.contrast})
    row += "," + number(value);
  return row + (m.reacquired ? ",1," : ",0,") + toWord(m.doubt);
}

double percent(std::uint64_t part, std::uint64_t whole) {
  return whole == 0 ? 0 : 100.0 * static_cast<double>(part) / static_cast<double>(whole);
}

}  // namespace

TrackTable::TrackTable(const std::string& file, const VisionConfig& config)
    : whole_(file, "The table"), out_(whole_.part()) {
  if (!out_) throw Error(file + ": cannot be written; give a file in an existing folder that you may write to");
  for (const InstrumentConfig& instrument : config.instruments) names_.push_back(field(instrument.name));
  out_ << kColumns << "\n";
}

void TrackTable::add(const Frame& frame, const Measurements& measurements) {
  const std::string stamp = formatted("%.9f", frame.stamp);
  for (std::size_t i = 0; i < measurements.size(); ++i) {
    out_ << frame.sequence << "," << stamp << "," << names_.at(i) << "," << rowOf(measurements[i]) << "\n";
  }
}

void TrackTable::close() {
  out_.close();
  whole_.finish(static_cast<bool>(out_));
}

TrackSummary::TrackSummary(const VisionConfig& config) {
  for (const InstrumentConfig& instrument : config.instruments) {
    instruments_.emplace_back();
    instruments_.back().name = instrument.name;
  }
}

void TrackSummary::add(const Measurements& measurements, double seconds) {
  seconds_.push_back(seconds);
  for (std::size_t i = 0; i < measurements.size(); ++i) {
    Instrument& instrument = instruments_.at(i);
    const Measurement& m = measurements[i];
    if (!m.tracked()) {
      ++instrument.lost[m.reason];
      continue;
    }
    ++instrument.tracked;
    if (m.reacquired) ++instrument.reacquired;
    if (m.doubt != Doubt::None) ++instrument.doubtful[m.doubt];
  }
}

std::string TrackSummary::text() const {
  std::string text;
  for (const Instrument& instrument : instruments_) {
    text += formatted("%s: tracked in %" PRIu64 " of %" PRIu64 " frames, %.2f %%; found anew %" PRIu64 " times\n",
                      instrument.name.substr(0, 60).c_str(), instrument.tracked, frames(),
                      percent(instrument.tracked, frames()), instrument.reacquired);
    for (const auto& [reason, count] : instrument.lost) {
      text += formatted("  lost in %" PRIu64 " frames, %.2f %%: %s\n", count, percent(count, frames()), toText(reason));
    }
    for (const auto& [doubt, count] : instrument.doubtful)
      text += "  doubtful in " + std::to_string(count) + " frames: " + toText(doubt) + "\n";
  }
  if (seconds_.empty()) return text;
  std::vector<double> sorted = seconds_;
  std::sort(sorted.begin(), sorted.end());
  return text + formatted("time per frame, one thread: %.3f ms median, %.3f ms p99, %.3f ms max\n",
                          1e3 * sorted[sorted.size() / 2], 1e3 * sorted[sorted.size() * 99 / 100], 1e3 * sorted.back());
}

}  // namespace vibe::vision

#include "bench/score.hpp"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>

#include <sched.h>

#include <Eigen/LU>

namespace vibe::vision::evidence {

bool pinThread() {
  const int processor = sched_getcpu();
  if (processor < 0) return false;
  cpu_set_t set;
  CPU_ZERO(&set);
  CPU_SET(static_cast<std::size_t>(processor), &set);
  return sched_setaffinity(0, sizeof set, &set) == 0;
}

TimeSummary summarise(std::vector<double> times) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  if (times.empty()) return {nan, nan};
  std::sort(times.begin(), times.end());
  return {times.front(), times[times.size() / 2]};
}

namespace {

constexpr double kTurn = 2 * 3.14159265358979323846;
constexpr double kClear = 0.99;

double ratio(double part, double whole) {
  return whole > 0 ? part / whole : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

void Scorer::add(const BenchScene& scene, const std::vector<RenderedFrame>& frames, const MethodRun& run,
                 const std::vector<MarkerBound>& bounds) {
  const std::size_t instrument = method_->instrument(scene);
  const double scale = scene.scene.instruments[instrument].nominal.axis.pixels_per_metre;
  for (std::size_t i = 0; i < run.estimates.size(); ++i) addFrame(frames[i].truth[instrument], run.estimates[i], scale);
  for (std::size_t i = 0; i < run.searches.size(); ++i)
    addSearch(frames[i * run.search_stride].truth[instrument], run.searches[i], scale);
  for (const MarkerBound& bound : bounds) {
    bound_squares_ += bound.along * bound.along;
    rotation_bound_squares_ += bound.rotation * bound.rotation;
    ++bound_count_;
  }
  for (const double error : run.lead_errors) lead_squares_ += error * error;
  lead_count_ += static_cast<double>(run.lead_errors.size());
  track_times_.insert(track_times_.end(), run.track_times.begin(), run.track_times.end());
  search_times_.insert(search_times_.end(), run.search_times.begin(), run.search_times.end());
}

void Scorer::addFrame(const SyntheticTruth& truth, const Estimate& estimate, double scale) {
  ++sum_.frames;
  if (truth.visible >= limits_.visible) ++sum_.visible;
  if (truth.visible >= kClear) ++sum_.clear;
  if (truth.visible < limits_.phantom) ++sum_.hidden;
  if (!estimate.found) return;
  ++sum_.reports;
  if (estimate.doubted) ++sum_.doubted;
  if (truth.visible < limits_.phantom) {
    ++sum_.phantom;
    return;
  }
  const double error = estimate.along - truth.along;
  if (std::abs(error) > limits_.wrong * scale) ++sum_.wrong;
  if (std::abs(error) > limits_.outlier) return;
  if (truth.visible >= limits_.visible) ++sum_.tracked;
  if (truth.visible >= kClear) ++sum_.clear_tracked;
  const double turn = method_->givesRotation() ? std::remainder(estimate.rotation - truth.rotation, kTurn) : 0;
  errors_ += error;
  squares_ += error * error;
  turn_squares_ += turn * turn;
  ++count_;
  if (method_->statesCovariance()) addConsistency(error, turn, estimate);
}

void Scorer::addConsistency(double error, double turn, const Estimate& estimate) {
  double nees = 0, limit = 3.841;  // 95 % of chi squared with one degree of freedom
  if (method_->givesRotation()) {
    const Eigen::Vector2d errors(error, turn);
    nees = errors.dot(estimate.covariance.inverse() * errors);
    limit = 5.991;  // two
  } else {
    nees = error * error / estimate.covariance(0, 0);
  }
  nees_sum_ += nees;
  ++nees_count_;
  if (nees <= limit) ++nees_inside_;
}

void Scorer::addSearch(const SyntheticTruth& truth, const Estimate& estimate, double scale) {
  if (truth.visible < limits_.visible) return;
  ++sum_.searched;
  if (!estimate.found) return;
  ++sum_.search_found;
  if (std::abs(estimate.along - truth.along) > limits_.wrong * scale) ++sum_.search_wrong;
}

Score Scorer::score() const {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Score score = sum_;
  score.method = method_->name();
  score.rms = std::sqrt(ratio(squares_, count_));
  score.bias = ratio(errors_, count_);
  score.rotation_rms = method_->givesRotation() ? std::sqrt(ratio(turn_squares_, count_)) : nan;
  score.bound = std::sqrt(ratio(bound_squares_, bound_count_));
  score.rotation_bound = method_->givesRotation() ? std::sqrt(ratio(rotation_bound_squares_, bound_count_)) : nan;
  const double freedom = method_->givesRotation() ? 2 : 1;
  const double degrees = freedom * nees_count_;
  score.nees = ratio(nees_sum_, degrees);
  score.nees_low = degrees > 0 ? quantile(boost::math::chi_squared(degrees), 0.025) / degrees : nan;
  score.nees_high = degrees > 0 ? quantile(boost::math::chi_squared(degrees), 0.975) / degrees : nan;
  score.nees_inside = ratio(nees_inside_, nees_count_);
  score.lead_rms = std::sqrt(ratio(lead_squares_, lead_count_));
  score.track = summarise(track_times_);
  score.search = summarise(search_times_);
  return score;
}

namespace {

constexpr double kDegrees = 180 / 3.14159265358979323846;

double percent(double part, double whole) {
  return 100 * part / whole;
}

/// A number, or a dash where nothing was measured.
std::string text(const char* format, double value) {
  if (!std::isfinite(value)) return "-";
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, format, value);
  return buffer;
}

std::string timeText(const TimeSummary& time) {
  return text("%.0f", 1e6 * time.least) + "/" + text("%.0f", 1e6 * time.median);
}

std::string consistencyText(const Score& s) {
  if (!std::isfinite(s.nees)) return "-";
  return text("%.2f", s.nees) + " [" + text("%.2f", s.nees_low) + ", " + text("%.2f", s.nees_high) + "] " +
         (s.consistent() ? "in " : "OUT");
}

std::string phantomText(const Score& s) {
  return s.hidden > 0 ? text("%.0f", s.phantom) + "/" + text("%.0f", s.hidden) : "-";
}

struct Column {
  const char* title;
  int width;  ///< negative: to the left
  std::function<std::string(const Score&)> text;
};

const std::vector<Column>& columns() {
  static const std::vector<Column> all = {
      {"method", -18, [](const Score& s) { return s.method; }},
      {"RMS px", 7, [](const Score& s) { return text("%.4f", s.rms); }},
      {"bias px", 8, [](const Score& s) { return text("%+.4f", s.bias); }},
      {"x CRB", 6, [](const Score& s) { return text("%.2f", s.boundRatio()); }},
      {"rot deg", 7, [](const Score& s) { return text("%.3f", kDegrees * s.rotation_rms); }},
      {"found%", 6, [](const Score& s) { return text("%.1f", percent(s.tracked, s.visible)); }},
      {"clear%", 6, [](const Score& s) { return text("%.1f", percent(s.clear_tracked, s.clear)); }},
      {"wrong%", 6, [](const Score& s) { return text("%.2f", percent(s.wrong, s.reports)); }},
      {"phantom", 7, phantomText},
      {"in 95%", 6, [](const Score& s) { return text("%.1f", 100 * s.nees_inside); }},
      {"NEES", 23, consistencyText},
      {"lead mm", 7, [](const Score& s) { return text("%.3f", 1e3 * s.lead_rms); }},
      {"track us", 9, [](const Score& s) { return timeText(s.track); }},
      {"search us", 11, [](const Score& s) { return timeText(s.search); }},
      {"s.ok%", 5, [](const Score& s) { return text("%.1f", percent(s.search_found - s.search_wrong, s.searched)); }}};
  return all;
}

std::string padded(const std::string& text, int width) {
  const std::string space(static_cast<std::size_t>(std::max(0, std::abs(width) - static_cast<int>(text.size()))), ' ');
  return width < 0 ? text + space : space + text;
}

}  // namespace

void printHeader(std::ostream& out, const ScoreLimits& limits) {
  char line[400];
  std::snprintf(
      line, sizeof line,
      "error: along the axis against the truth at mid-exposure, errors <= %.0f px; found: right reports in "
      "frames with >= %.0f %% of the marker visible\n(clear: fully visible); wrong: reports off by > %.1f "
      "mm; phantom: reports/frames with < %.0f %% visible;\nCRB: Cramer-Rao bound; NEES: mean and its 95 %% "
      "band; lead: the slide %.0f ms ahead;\ntimes: thread CPU, least/median; s.ok: right reports of a search\n",
      limits.outlier, 100 * limits.visible, 1e3 * limits.wrong, 100 * limits.phantom, 1e3 * kLead);
  out << line;
}

void printCell(std::ostream& out, const CellResult& result) {
  out << "\n" << result.cell.name() << "\n ";
  for (const Column& column : columns()) out << ' ' << padded(column.title, column.width);
  for (const Score& score : result.scores) {
    out << "\n ";
    for (const Column& column : columns()) out << ' ' << padded(column.text(score), column.width);
  }
  out << "\n  both instruments in one tracker: track " << timeText(result.track) << " us, search "
      << timeText(result.search) << " us\n"
      << std::flush;
}

void writeCsv(std::ostream& out, const std::vector<CellResult>& results) {
  out << "scene,marker_px,exposure_s,speed_m_s,width,height,method,frames,visible,tracked,clear,clear_tracked,reports,"
         "wrong,hidden,phantom,rms_px,bias_px,rotation_rms_deg,bound_px,bound_ratio,rotation_bound_deg,nees,nees_low,"
         "nees_high,nees_inside,lead_rms_m,track_min_s,track_median_s,search_min_s,search_median_s,searched,search_"
         "found,"
         "search_wrong\n";
  out.precision(6);
  for (const CellResult& result : results) {
    const Cell& c = result.cell;
    for (const Score& s : result.scores)
      out << c.scene << ',' << c.marker << ',' << c.exposure.value_or(0) << ',' << c.speed << ',' << c.width << ','
          << c.height << ',' << s.method << ',' << s.frames << ',' << s.visible << ',' << s.tracked << ',' << s.clear
          << ',' << s.clear_tracked << ',' << s.reports << ',' << s.wrong << ',' << s.hidden << ',' << s.phantom << ','
          << s.rms << ',' << s.bias << ',' << kDegrees * s.rotation_rms << ',' << s.bound << ',' << s.boundRatio()
          << ',' << kDegrees * s.rotation_bound << ',' << s.nees << ',' << s.nees_low << ',' << s.nees_high << ','
          << s.nees_inside << ',' << s.lead_rms << ',' << s.track.least << ',' << s.track.median << ','
          << s.search.least << ',' << s.search.median << ',' << s.searched << ',' << s.search_found << ','
          << s.search_wrong << '\n';
    out << c.scene << ',' << c.marker << ',' << c.exposure.value_or(0) << ',' << c.speed << ',' << c.width << ','
        << c.height << ",both" << std::string(21, ',') << result.track.least << ',' << result.track.median << ','
        << result.search.least << ',' << result.search.median << ",,,\n";
  }
}

}  // namespace vibe::vision::evidence

#include "bench/score.hpp"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
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
  if (truth.visible < limits_.phantom) ++sum_.hidden;
  if (!estimate.found) return;
  ++sum_.reports;
  if (estimate.doubt != Doubt::None) ++sum_.doubted;
  if (truth.visible < limits_.phantom) {
    ++sum_.phantom;
    return;
  }
  const double error = estimate.along - truth.along;
  if (std::abs(error) > limits_.wrong * scale) ++sum_.wrong;
  if (std::abs(error) > limits_.outlier) return;
  if (truth.visible >= limits_.visible) ++sum_.tracked;
  const double turn = method_->givesRotation() ? std::remainder(estimate.rotation - truth.rotation, kTurn) : 0;
  errors_ += error;
  squares_ += error * error;
  turn_squares_ += turn * turn;
  ++count_;
  if (method_->statesCovariance()) addConsistency(error, turn, estimate);
}

void Scorer::addConsistency(double error, double turn, const Estimate& estimate) {
  const Eigen::Vector2d errors(error, turn);
  nees_sum_ += method_->givesRotation() ? errors.dot(estimate.covariance.inverse() * errors)
                                        : error * error / estimate.covariance(0, 0);
  ++nees_count_;
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
  const double degrees = (method_->givesRotation() ? 2 : 1) * nees_count_;
  score.nees = ratio(nees_sum_, degrees);
  score.nees_low = degrees > 0 ? quantile(boost::math::chi_squared(degrees), 0.025) / degrees : nan;
  score.nees_high = degrees > 0 ? quantile(boost::math::chi_squared(degrees), 0.975) / degrees : nan;
  score.lead_rms = std::sqrt(ratio(lead_squares_, lead_count_));
  score.track = summarise(track_times_);
  score.search = summarise(search_times_);
  return score;
}

}  // namespace vibe::vision::evidence

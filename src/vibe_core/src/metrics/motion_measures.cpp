#include "vibe_core/metrics/motion_measures.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "arithmetic/elementary.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe {
namespace {

constexpr double kSlow = 0.05;          // share of the speed of rest at which a movement begins and ends
constexpr double kMinJerk = 1e-6;       // dimensionless; below it there is only rounding: a reach has 204.8
constexpr double kGridRounding = 1e-6;  // of a period: steps that fill it but for rounding fill it

std::optional<double> ratio(double a, double b) {
  if (!(b > 0)) return std::nullopt;
  return a / b;
}

}  // namespace

std::optional<double> logDimensionlessJerk(const std::vector<double>& speed, double period) {
  const std::size_t count = speed.size();
  if (count < 3 || !(period > 0)) return std::nullopt;
  double peak = 0, sum = 0;
  for (double v : speed) peak = std::max(peak, std::abs(v));
  if (!(peak > 0)) return std::nullopt;
  for (std::size_t i = 1; i + 1 < count; ++i) {
    const double difference = (speed[i + 1] - 2 * speed[i] + speed[i - 1]) / peak;
    sum += difference * difference;
  }
  // T^3 sum (difference / period^2)^2 period: the period drops out but for the number of samples
  const auto samples = static_cast<double>(count);
  const double jerk = samples * samples * samples * sum;
  if (!(jerk > kMinJerk) || !std::isfinite(jerk)) return std::nullopt;
  return -math::log(jerk);
}

MotionRecorder::MotionRecorder(const MotionSettings& settings, std::shared_ptr<SpectralArcLength> spectrum)
    : settings_(settings), spectrum_(std::move(spectrum)), peaks_(settings.rest_reach / settings.rest_time) {
  if (!(settings.sample_period > 0 && settings.rest_reach > 0 && settings.rest_time > 0 && settings.tremor_period > 0))
    throw Error("A MotionRecorder needs times and a reach above 0; correct its settings.");
  if (!spectrum_) spectrum_ = std::make_shared<SpectralArcLength>(kLongestMovement);
  speed_.reserve(kLongestMovement);
  points_.reserve(kLongestMovement + 1);
  steady_.reserve(kLongestMovement + 1);
  recent_.reserve(std::max(1L, std::lround(settings.tremor_period / settings.sample_period)));
  piece_.reserve(kLongestMovement);
}

void MotionRecorder::begin(const Eigen::Vector3d& position, double dt) {
  if (period_ == 0) {
    // whole steps: between steps the speed is not known well enough for a jerk
    period_ = dt * std::max(1.0, std::ceil(settings_.sample_period / dt * (1 - kGridRounding)));
    window_ = std::max(1, static_cast<int>(std::lround(settings_.rest_time / period_)));
  }
  started_ = true;
  last_ = position;
  since_sample_ = 0;
  speed_.clear();
  points_.assign(1, position);
  steady_.assign(1, position);
  recent_.assign(std::max(1L, std::lround(settings_.tremor_period / period_)), position);
  oldest_ = 0;
}

void MotionRecorder::add(const Eigen::Vector3d& position, double dt) {
  if (!position.allFinite() || !(dt > 0) || !std::isfinite(dt))
    throw Error("A MotionRecorder was given a position or a step that is not a finite number; leave such steps out.");
  if (!started_) return begin(position, dt);
  sums_.time += dt;
  sums_.path_length += (position - last_).norm();
  const Eigen::Vector3d from = last_;
  double gone = 0;  // of dt
  while (since_sample_ + (dt - gone) >= period_ * (1 - kGridRounding)) {
    gone = std::min(gone + period_ - since_sample_, dt);
    since_sample_ = 0;
    sample(from + gone / dt * (position - from));
  }
  since_sample_ += dt - gone;
  last_ = position;
}

void MotionRecorder::sample(const Eigen::Vector3d& point) {
  const double speed = (point - points_.back()).norm() / period_;
  sums_.max_speed = std::max(sums_.max_speed, speed);
  speed_.push_back(speed);
  points_.push_back(point);
  steady_.push_back(steadied(point));
  peaks_.add((steady_.back() - steady_[steady_.size() - 2]).norm() / period_);
  if (moving_) {
    if (static_cast<int>(speed_.size()) >= window_ && atRest()) return endMovement();
    if (speed_.size() == kLongestMovement) measure(kLongestMovement);
  } else if (!atRest()) {
    beginMovement();
  } else if (static_cast<int>(speed_.size()) > window_) {
    drop(1);
  }
}

/// The mean of the last points.
Eigen::Vector3d MotionRecorder::steadied(const Eigen::Vector3d& point) {
  recent_[oldest_] = point;
  oldest_ = (oldest_ + 1) % recent_.size();
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const auto& p : recent_) sum += p;
  return sum / static_cast<double>(recent_.size());
}

/// Whether the point has stayed near where it was rest_time ago.
bool MotionRecorder::atRest() const {
  const std::size_t first = steady_.size() - 1 - std::min(steady_.size() - 1, static_cast<std::size_t>(window_));
  return std::all_of(steady_.begin() + static_cast<std::ptrdiff_t>(first), steady_.end(),
                     [&](const auto& p) { return (p - steady_[first]).norm() <= settings_.rest_reach; });
}

/// Speed below which a movement begins and ends.
double MotionRecorder::slowSpeed() const {
  return kSlow * settings_.rest_reach / settings_.rest_time;
}

/// First sample of [from, to) that is as slow as a movement begins and ends; to: none.
int MotionRecorder::firstSlow(int from, int to) const {
  const double slow = slowSpeed();
  return static_cast<int>(
      std::find_if(speed_.begin() + from, speed_.begin() + to, [&](double v) { return v <= slow; }) - speed_.begin());
}

void MotionRecorder::beginMovement() {
  moving_ = true;
  ++sums_.movements;
  const int count = static_cast<int>(speed_.size());
  int start = 0;  // keep the last slow sample before the movement
  for (int slow = firstSlow(0, count); slow < count; slow = firstSlow(slow + 1, count)) start = slow;
  drop(start);
}

void MotionRecorder::endMovement() {
  const int count = static_cast<int>(speed_.size()), rest = std::max(0, count - window_);
  const int slow = firstSlow(rest, count);
  measure(slow < count ? slow + 1 : rest);
  moving_ = false;
}

/// Adds the first samples to the sums and drops them.
void MotionRecorder::measure(int samples) {
  const double duration = samples * period_;
  sums_.movement_time += duration;
  piece_.assign(speed_.begin(), speed_.begin() + samples);
  for (double v : piece_) way_sum_ += v * period_;
  straight_sum_ += (points_[samples] - points_[0]).norm();
  if (const auto jerk = logDimensionlessJerk(piece_, period_)) {
    jerk_sum_ += duration * *jerk;
    jerk_time_ += duration;
  }
  if (const auto arc = spectrum_->of(piece_, period_)) {
    arc_sum_ += duration * *arc;
    arc_time_ += duration;
  }
  drop(samples);
}

void MotionRecorder::drop(int samples) {
  speed_.erase(speed_.begin(), speed_.begin() + samples);
  points_.erase(points_.begin(), points_.begin() + samples);
  steady_.erase(steady_.begin(), steady_.begin() + samples);
}

void MotionRecorder::finish() {
  if (moving_) {
    // a stand at the end that was too short for a rest: of it one sample belongs to the movement
    const double slow = slowSpeed();
    int count = static_cast<int>(speed_.size());
    while (count > 1 && speed_[count - 1] <= slow && speed_[count - 2] <= slow) --count;
    measure(count);
  }
  peaks_.finish();
  moving_ = false;
  started_ = false;
}

MotionMeasures MotionRecorder::measures() const {
  MotionMeasures m = sums_;
  if (moving_) m.movement_time += static_cast<double>(speed_.size()) * period_;
  m.idle_time = std::max(0.0, m.time - m.movement_time);
  m.submovements = peaks_.count();
  m.mean_speed = ratio(m.path_length, m.time);
  m.economy = ratio(straight_sum_, way_sum_);
  m.log_dimensionless_jerk = ratio(jerk_sum_, jerk_time_);
  m.spectral_arc_length = ratio(arc_sum_, arc_time_);
  return m;
}

}  // namespace vibe

#include "vibe_vision/calibrate/axis_fit.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "calibrate/fitting.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_core/scene/yaml_source.hpp"

namespace vibe::vision {
namespace {

constexpr double kSignificance = 0.01;
constexpr double kDistinctSlides = 1e-6;  // [m]
constexpr double kNoisyStop = 0.5;        // residual that deserves a warning [px]

void checkStops(const std::vector<AxisStop>& stops) {
  std::set<long long> slides;
  for (const AxisStop& stop : stops) {
    if (!std::isfinite(stop.slide) || !stop.pixel.allFinite()) {
      throw Error(stop.name + ": has no finite position; leave this stop out");
    }
    slides.insert(std::llround(stop.slide / kDistinctSlides));
  }
  if (slides.size() < kFewestStops) {
    throw Error("the instrument stood at " + std::to_string(slides.size()) + " different slides, " +
                std::to_string(kFewestStops) + " are needed at the least; add stops over the whole range");
  }
}

/// Pixels per metre as a vector: the median over all pairs does not mind a few outliers.
Eigen::Vector2d roughVelocity(const std::vector<AxisStop>& stops) {
  std::vector<double> x, y;
  for (std::size_t i = 0; i < stops.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const double distance = stops[i].slide - stops[j].slide;
      if (std::abs(distance) < kDistinctSlides) continue;
      const Eigen::Vector2d velocity = (stops[i].pixel - stops[j].pixel) / distance;
      x.push_back(velocity.x());
      y.push_back(velocity.y());
    }
  }
  return {median(x), median(y)};
}

/// Fits along and across the axis with the stops that are used.
class Fitter {
 public:
  explicit Fitter(const std::vector<AxisStop>& stops) : stops_(stops), used_(stops.size(), true) {
    const Eigen::Vector2d velocity = roughVelocity(stops);
    double reach = 0;
    for (const AxisStop& stop : stops) reach = std::max(reach, std::abs(stop.slide - stops.front().slide));
    if (velocity.norm() * reach < kShortestPath) {
      throw Error("the marker moved by " + withDecimals(velocity.norm() * reach, 1) +
                  " px only while the slide changed by " + showQuantity(reach, "m") +
                  "; check that the slides belong to these images and are in metres or have a unit");
    }
    rough_ = velocity;
  }

  AxisFit run() {
    AxisFit result;
    result.perspective_observed = true;
    fitFrom(true);
    leaveOutliersOut();
    const double deviation = std::sqrt(along_.covariance(2, 2));
    result.perspective_deviation = deviation;
    if (along_.freedom > 0)
      perspective_bound_ = std::abs(axis_.perspective) + studentQuantile(0.05, along_.freedom) * deviation;
    const double t = axis_.perspective / std::max(deviation, 1e-300);
    if (along_.freedom < 1 || studentTail(t, along_.freedom) > kSignificance) {
      result.perspective_observed = false;
      std::fill(used_.begin(), used_.end(), true);
      fitFrom(false);
      leaveOutliersOut();
    }
    finish(result);
    return result;
  }

 private:
  const std::vector<AxisStop>& stops_;
  std::vector<bool> used_;
  Eigen::Vector2d rough_;
  SlideAxis axis_;
  LinearFit along_, across_;
  bool with_perspective_ = true;
  double perspective_bound_ = 0;  // 95 %; 0: not known [1/m]

  std::size_t usedCount() const { return static_cast<std::size_t>(std::count(used_.begin(), used_.end(), true)); }

  Eigen::Vector2d residual(const AxisStop& stop) const {
    const Eigen::Vector2d d = axis_.direction, n(-d.y(), d.x());
    const Eigen::Vector2d from_origin = stop.pixel - axis_.origin;
    return {from_origin.dot(d) - alongOf(axis_, stop.slide), from_origin.dot(n)};
  }

  void fitFrom(bool with_perspective) {
    with_perspective_ = with_perspective;
    axis_ = {};
    axis_.direction = rough_.normalized();
    axis_.pixels_per_metre = rough_.norm();
    std::vector<double> x, y;
    for (const AxisStop& stop : stops_) {
      const Eigen::Vector2d origin = stop.pixel - rough_ * stop.slide;
      x.push_back(origin.x());
      y.push_back(origin.y());
    }
    axis_.origin = {median(x), median(y)};
    iterate();
  }

  /// Gauss-Newton; the problem is nearly linear.
  void iterate() {
    constexpr int kIterations = 20;
    for (int i = 0; i < kIterations; ++i) step();
  }

  void step() {
    const auto rows = static_cast<Eigen::Index>(usedCount());
    Eigen::MatrixXd a(rows, with_perspective_ ? 3 : 2), c(rows, 2);
    Eigen::VectorXd along(rows), across(rows);
    Eigen::Index row = 0;
    for (std::size_t i = 0; i < stops_.size(); ++i) {
      if (!used_[i]) continue;
      const double s = stops_[i].slide, near = 1 + axis_.perspective * s;
      const Eigen::Vector2d r = residual(stops_[i]);
      a(row, 0) = 1;
      a(row, 1) = s / near;
      if (with_perspective_) a(row, 2) = -axis_.pixels_per_metre * s * s / (near * near);
      c.row(row) << 1, alongOf(axis_, s);
      along(row) = r.x();
      across(row++) = r.y();
    }
    along_ = solveLinear(a, along);
    across_ = solveLinear(c, across);
    const Eigen::Vector2d d = axis_.direction, n(-d.y(), d.x());
    axis_.origin += along_.solution(0) * d + across_.solution(0) * n;
    axis_.direction = (d + across_.solution(1) * n).normalized();
    axis_.pixels_per_metre += along_.solution(1);
    if (with_perspective_) axis_.perspective += along_.solution(2);
  }

  /// Largest deleted Studentised residual of along and across, and whose it is.
  void leaveOutliersOut() {
    const std::size_t most = stops_.size() / 4;
    for (std::size_t removed = 0; removed < most; ++removed) {
      std::size_t worst = stops_.size();
      double smallest = kSignificance / static_cast<double>(2 * usedCount());  // Bonferroni
      Eigen::Index row = 0;
      for (std::size_t i = 0; i < stops_.size(); ++i) {
        if (!used_[i]) continue;
        const double tail = std::min(along_.deletedTail(row), across_.deletedTail(row));
        ++row;
        if (tail >= smallest) continue;
        smallest = tail;
        worst = i;
      }
      if (worst == stops_.size()) return;
      used_[worst] = false;
      iterate();
    }
  }

  void finish(AxisFit& result) {
    for (std::size_t i = 0; i < stops_.size(); ++i) {
      const Eigen::Vector2d r = residual(stops_[i]);
      result.stops.push_back({r.x(), r.y(), !used_[i]});
    }
    double along = 0, across = 0, metres = 0;
    for (std::size_t i = 0; i < stops_.size(); ++i) {
      if (!used_[i]) continue;
      along += std::pow(result.stops[i].along, 2);
      across += std::pow(result.stops[i].across, 2);
      metres += std::pow(result.stops[i].along / pixelsPerMetre(axis_, stops_[i].slide), 2);
    }
    const auto count = static_cast<double>(usedCount());
    result.rms_along = std::sqrt(along / count);
    result.rms_across = std::sqrt(across / count);
    axis_.residual_rms = std::sqrt(metres / count);
    setCovariance();
    result.axis = axis_;
    warn(result);
  }

  void setCovariance() {
    const int along[] = {0, 3, 4}, across[] = {1, 2};
    const int size = with_perspective_ ? 3 : 2;
    for (int i = 0; i < size; ++i) {
      for (int j = 0; j < size; ++j) axis_.covariance(along[i], along[j]) = along_.covariance(i, j);
    }
    for (int i = 0; i < 2; ++i) {
      for (int j = 0; j < 2; ++j) axis_.covariance(across[i], across[j]) = across_.covariance(i, j);
    }
  }

  void warn(AxisFit& result) const {
    double lowest = 1e9, highest = -1e9;
    for (std::size_t i = 0; i < stops_.size(); ++i) {
      lowest = std::min(lowest, stops_[i].slide);
      highest = std::max(highest, stops_[i].slide);
      if (used_[i]) continue;
      const double error = result.stops[i].along / pixelsPerMetre(axis_, stops_[i].slide);
      result.warnings.push_back(stops_[i].name + " deviates by " + withDecimals(1e3 * error, 3) + " mm along and " +
                                withDecimals(result.stops[i].across, 2) +
                                " px across the axis from the other stops and is left out; check its slide of " +
                                withDecimals(1e3 * stops_[i].slide, 3) + " mm");
    }
    if (!result.perspective_observed) {
      const double reach = (highest - lowest) / 2;
      result.warnings.push_back(
          "the perspective is not observable with these stops and is set to 0; if it is there, it moves the ends of "
          "the range by " +
          withDecimals(1e3 * perspective_bound_ * reach * reach, 3) +
          " mm at most (95 %); use more stops or better gauges if that is too much");
    }
    if (result.rms_along > kNoisyStop) {
      result.warnings.push_back("the stops scatter by " + withDecimals(1e3 * axis_.residual_rms, 3) +
                                " mm; use gauge blocks instead of a ruler, and approach each stop from the same side");
    }
  }
};

}  // namespace

AxisFit fitAxis(const std::vector<AxisStop>& stops) {
  checkStops(stops);
  return Fitter(stops).run();
}

}  // namespace vibe::vision

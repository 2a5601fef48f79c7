#include <algorithm>
#include <cmath>
#include <cstdio>

#include "calibrate/least_squares.hpp"
#include "vibe_core/common/error.hpp"
#include "vibe_vision/calibrate/axis_fit.hpp"

namespace vibe {
namespace {

constexpr double kShortestPath = 20;  // [px]
constexpr std::size_t kFewestSamples = 5;
constexpr double kMinPixelError = 0.02;  // [px]; below, samples are not left out

std::string withDecimals(double value, int decimals) {
  char text[40];
  std::snprintf(text, sizeof text, "%.*f", decimals, value);
  return text;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Samples with their distances along and across a line.
struct Line {
  Eigen::Vector2d point = Eigen::Vector2d::Zero(), direction = Eigen::Vector2d::UnitX();

  double along(const MotionSample& sample) const { return (sample.pixel - point).dot(direction); }
  double across(const MotionSample& sample) const {
    return (sample.pixel - point).dot(Eigen::Vector2d(-direction.y(), direction.x()));
  }
};

/// The two samples that are furthest apart give the first line.
Line roughLine(const std::vector<MotionSample>& samples) {
  Line line;
  double longest = 0;
  for (const MotionSample& a : samples) {
    for (const MotionSample& b : samples) {
      const Eigen::Vector2d difference = b.pixel - a.pixel;
      if (difference.norm() <= longest) continue;
      longest = difference.norm();
      line = {a.pixel, difference.normalized()};
    }
  }
  if (longest < kShortestPath) {
    throw Error("the marker moved by " + withDecimals(longest, 1) +
                " px only; move the instrument over its whole range");
  }
  return line;
}

/// Least squares across the line, with Tukey-like trimming of what is far beyond the median.
LinearFit fitLine(const std::vector<MotionSample>& samples, Line& line) {
  constexpr int kIterations = 10;
  constexpr double kFar = 5 * 1.4826;  // of the median residual: 5 standard deviations
  LinearFit fit;
  for (int i = 0; i < kIterations; ++i) {
    std::vector<double> sizes;
    for (const MotionSample& sample : samples) sizes.push_back(std::abs(line.across(sample)));
    const double limit = i == 0 ? 1e9 : std::max(kFar * median(sizes), kMinPixelError);
    std::vector<const MotionSample*> near;
    for (const MotionSample& sample : samples)
      if (std::abs(line.across(sample)) <= limit) near.push_back(&sample);
    Eigen::MatrixXd a(static_cast<Eigen::Index>(near.size()), 2);
    Eigen::VectorXd b(a.rows());
    for (Eigen::Index row = 0; row < a.rows(); ++row) {
      a.row(row) << 1, line.along(*near[static_cast<std::size_t>(row)]);
      b(row) = line.across(*near[static_cast<std::size_t>(row)]);
    }
    fit = solveLinear(a, b);
    const Eigen::Vector2d n(-line.direction.y(), line.direction.x());
    line.point += fit.solution(0) * n;
    line.direction = (line.direction + fit.solution(1) * n).normalized();
  }
  return fit;
}

/// Size of the marker as a function of its place, from the first sample.
LinearFit fitSize(const std::vector<MotionSample>& samples, const Line& line) {
  Eigen::MatrixXd a(static_cast<Eigen::Index>(samples.size()), 2);
  Eigen::VectorXd b(a.rows());
  for (Eigen::Index row = 0; row < a.rows(); ++row) {
    a.row(row) << 1, line.along(samples[static_cast<std::size_t>(row)]);
    b(row) = samples[static_cast<std::size_t>(row)].pixels_per_metre;
  }
  return solveLinear(a, b);
}

void check(const std::vector<MotionSample>& samples) {
  if (samples.size() < kFewestSamples) {
    throw Error("the marker was found in " + std::to_string(samples.size()) + " images, " +
                std::to_string(kFewestSamples) + " are needed at the least; take more images along the whole range");
  }
  for (const MotionSample& sample : samples) {
    if (!sample.pixel.allFinite() || !(sample.pixels_per_metre > 0))
      throw Error("a sample of the motion is not finite or has no scale; leave it out");
  }
}

bool pointsBackwards(const std::vector<MotionSample>& samples, const Line& line, const Eigen::Vector2d& direction) {
  if (direction.norm() > 0) return line.direction.dot(direction) < 0;
  std::vector<double> later;
  for (std::size_t i = samples.size() / 2; i < samples.size(); ++i) later.push_back(line.along(samples[i]));
  return median(later) < line.along(samples.front());
}

}  // namespace

MotionFit fitMotion(const std::vector<MotionSample>& samples, const ScaleTrust& trust,
                    const Eigen::Vector2d& direction) {
  check(samples);
  Line line = roughLine(samples);
  if (pointsBackwards(samples, line, direction)) line.direction = -line.direction;
  const LinearFit across = fitLine(samples, line);
  line.point += line.along(samples.front()) * line.direction;
  MotionFit result;
  result.axis.origin = line.point;
  result.axis.direction = line.direction;
  result.rms_across = std::sqrt(across.residual.squaredNorm() / static_cast<double>(across.residual.size()));

  const LinearFit size = fitSize(samples, line);
  double lowest = 0, highest = 0;
  for (const MotionSample& sample : samples) {
    lowest = std::min(lowest, line.along(sample));
    highest = std::max(highest, line.along(sample));
  }
  const double k = size.solution(0) + size.solution(1) * (lowest + highest) / 2;
  result.axis.pixels_per_metre = k;
  result.size_change = size.solution(1) * (highest - lowest) / k;
  const double slant = 1 - std::cos(trust.slant);
  const double noise = std::sqrt(size.residual.squaredNorm() / static_cast<double>(samples.size()) /
                                 static_cast<double>(samples.size())) /
                       k;
  result.scale_uncertainty = std::sqrt(trust.print * trust.print + slant * slant + noise * noise +
                                       result.size_change * result.size_change / 4);
  result.axis.covariance(1, 1) = across.covariance(0, 0);
  result.axis.covariance(2, 2) = across.covariance(1, 1);
  result.axis.covariance(1, 2) = result.axis.covariance(2, 1) = across.covariance(0, 1);
  result.axis.covariance(3, 3) = std::pow(result.scale_uncertainty * k, 2);

  const double change_deviation = std::sqrt(size.covariance(1, 1)) * (highest - lowest) / k;
  if (std::abs(result.size_change) > 0.003 && std::abs(result.size_change) > 3 * change_deviation) {
    result.warnings.push_back("the marker looks " + withDecimals(100 * std::abs(result.size_change), 1) +
                              " % larger at one end than at the other, so the axis is not parallel to the sensor; "
                              "calibrate with stops, or turn the camera");
  }
  return result;
}

}  // namespace vibe

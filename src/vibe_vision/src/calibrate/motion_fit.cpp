#include <algorithm>
#include <cmath>

#include "calibrate/fitting.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_vision/calibrate/axis_fit.hpp"

namespace vibe::vision {
namespace {

constexpr std::size_t kFewestSamples = 5;

/// Size of the marker as a function of its place, from the first sample.
LinearFit fitSize(const std::vector<MotionSample>& samples, const StraightLine& line) {
  Eigen::MatrixXd a(static_cast<Eigen::Index>(samples.size()), 2);
  Eigen::VectorXd b(a.rows());
  for (Eigen::Index row = 0; row < a.rows(); ++row) {
    a.row(row) << 1, line.along(samples[static_cast<std::size_t>(row)].pixel);
    b(row) = samples[static_cast<std::size_t>(row)].pixels_per_metre;
  }
  return solveLinear(a, b);
}

void checkSamples(const std::vector<MotionSample>& samples) {
  if (samples.size() < kFewestSamples) {
    throw Error("the marker was found in " + std::to_string(samples.size()) + " images, " +
                std::to_string(kFewestSamples) + " are needed at the least; take more images along the whole range");
  }
  for (const MotionSample& sample : samples) {
    if (!sample.pixel.allFinite() || !(sample.pixels_per_metre > 0))
      throw Error("a sample of the motion is not finite or has no scale; leave it out");
  }
}

bool pointsBackwards(const std::vector<MotionSample>& samples, const StraightLine& line,
                     const Eigen::Vector2d& direction) {
  if (direction.norm() > 0) return line.direction.dot(direction) < 0;
  std::vector<double> later;
  for (std::size_t i = samples.size() / 2; i < samples.size(); ++i) later.push_back(line.along(samples[i].pixel));
  return median(later) < line.along(samples.front().pixel);
}

}  // namespace

MotionFit fitMotion(const std::vector<MotionSample>& samples, const ScaleTrust& trust,
                    const Eigen::Vector2d& direction) {
  checkSamples(samples);
  std::vector<Eigen::Vector2d> points;
  for (const MotionSample& sample : samples) points.push_back(sample.pixel);
  Eigen::Matrix2d across;
  StraightLine line = StraightLine::fit(points, &across);
  if (pointsBackwards(samples, line, direction)) line.direction = -line.direction;
  line.point += line.along(samples.front().pixel) * line.direction;
  MotionFit result;
  result.axis.origin = line.point;
  result.axis.direction = line.direction;
  std::vector<double> distances;
  for (const Eigen::Vector2d& point : points) distances.push_back(std::abs(line.across(point)));
  result.rms_across = 1.4826 * median(distances);

  const LinearFit size = fitSize(samples, line);
  double lowest = 0, highest = 0;
  for (const MotionSample& sample : samples) {
    lowest = std::min(lowest, line.along(sample.pixel));
    highest = std::max(highest, line.along(sample.pixel));
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
  result.axis.covariance(1, 1) = across(0, 0);
  result.axis.covariance(2, 2) = across(1, 1);
  result.axis.covariance(1, 2) = result.axis.covariance(2, 1) = across(0, 1);
  result.axis.covariance(3, 3) = std::pow(result.scale_uncertainty * k, 2);

  const double change_deviation = std::sqrt(size.covariance(1, 1)) * (highest - lowest) / k;
  if (std::abs(result.size_change) > 0.003 && std::abs(result.size_change) > 3 * change_deviation) {
    result.warnings.push_back("the marker looks " + withDecimals(100 * std::abs(result.size_change), 1) +
                              " % larger at one end than at the other, so the axis is not parallel to the sensor; "
                              "calibrate with stops, or turn the camera");
  }
  return result;
}

}  // namespace vibe::vision

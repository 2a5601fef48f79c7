#include "geometry/blood_jet.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "geometry/blood_colour.hpp"
#include "vibe_rviz_plugins/geometry/tube.hpp"

namespace vibe::rviz_plugins {
namespace {

using Eigen::Vector3d;

constexpr double kGravity = 9.81;         // [m/s^2]
constexpr double kHeartRate = 72 / 60.0;  // [1/s]
constexpr double kMeanSpeed = 0.5;   // of blood leaving a small artery into gas [m/s]; rises some 13 mm; design choice
constexpr double kPulse = 0.3;       // part of the speed that pulses
constexpr double kMinJet = 0.55e-3;  // [m]
constexpr int kJetPoints = 24;

/// Path of blood with the mean initial speed, slightly oblique so that it does not fall back onto itself.
struct Flight {
  Vector3d leave;  // unit

  Vector3d at(double t, double speed, const Vector3d& from, const Vector3d& down) const {
    return from + speed * t * leave + 0.5 * kGravity * t * t * down;
  }
};

Flight flightOf(const Wound& wound, const Vector3d& down) {
  const Vector3d inward = wound.inward.norm() > 0.5 ? wound.inward : Vector3d(-down);
  const Vector3d aside = Eigen::AngleAxisd(M_PI * wobble(wound.number, 9), inward) * anyNormal(inward);
  return {(inward + 0.45 * aside).normalized()};
}

}  // namespace

double jetSpeed(double time) {
  const double beat = time * kHeartRate, phase = 2 * M_PI * (beat - std::floor(beat));
  return kMeanSpeed * (1 + kPulse * (std::sin(phase) + 0.5 * std::sin(2 * phase)));
}

double jetDuration(const Wound& wound, double drop, const BloodStyle& style) {
  const double rising = -kMeanSpeed * flightOf(wound, style.down).leave.dot(style.down);  // against gravity [m/s]
  return (rising + std::sqrt(rising * rising + 2 * kGravity * drop)) / kGravity;
}

std::vector<Vector3d> jetPath(const Wound& wound, double duration, const BloodStyle& style) {
  const Flight flight = flightOf(wound, style.down);
  std::vector<Vector3d> line;
  for (int k = 0; k < kJetPoints; ++k)
    line.push_back(flight.at(duration * k / (kJetPoints - 1), kMeanSpeed, wound.place, style.down));
  return line;
}

std::vector<Vector3d> jetLine(const Wound& wound, double duration, const BloodStyle& style) {
  const Flight flight = flightOf(wound, style.down);
  std::vector<Vector3d> line;
  for (int k = 0; k < kJetPoints; ++k) {
    const double t = duration * k / (kJetPoints - 1);
    line.push_back(flight.at(t, jetSpeed(style.time - t), wound.place, style.down));
  }
  return line;
}

void appendJet(const Wound& wound, const std::vector<Vector3d>& line, const BloodStyle& style, ColouredShape& shape) {
  constexpr std::size_t kWhole = 15;
  const double steady = std::sqrt(wound.rate / (M_PI * kMeanSpeed));
  const double radius = std::max(kMinJet, steady) * std::sqrt(style.emphasis);
  std::vector<TubePoint> jet;
  for (std::size_t k = 0; k < kWhole; ++k) {
    const double swell = 1 + 0.35 * std::sin(2 * M_PI * (0.19 * static_cast<double>(k) - style.time * 5));
    jet.push_back({line[k], radius * swell * (1 - 0.3 * static_cast<double>(k) / kWhole), packedOf(kBrightBlood)});
  }
  appendTube(jet, 8, shape);
  // drops differ in size and deviate from the path
  for (std::size_t k = kWhole; k < line.size(); ++k) {
    const auto number = static_cast<int>(3 * k);
    const Vector3d stray(wobble(wound.number, number), wobble(wound.number, number + 1),
                         wobble(wound.number, number + 2));
    const double size = 0.95 + 0.5 * wobble(wound.number + 7, number);
    appendBall(line[k] + 1.3 * radius * stray, radius * size, packedOf(kBrightBlood), 8, shape);
  }
}

}  // namespace vibe::rviz_plugins

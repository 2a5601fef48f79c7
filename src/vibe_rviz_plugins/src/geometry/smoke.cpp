#include "geometry/smoke.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace vibe::rviz_plugins {
namespace {

bool anyDoseFell(const std::vector<float>& before, const std::vector<float>& now) {
  for (std::size_t i = 0; i < now.size(); ++i)
    if (now[i] < before[i]) return true;
  return false;
}

/// The part of what came in evenly over a time that is still there at its end.
double leftOfSteady(double ages) {
  return ages > 0 ? -std::expm1(-ages) / ages : 1;
}

}  // namespace

Smoke::Smoke(const TissueMesh& mesh) : share_(mesh.particle_count, 0) {
  const std::vector<std::uint32_t>& corners = mesh.particle_triangles;
  for (std::size_t t = 0; t + 2 < corners.size(); t += 3) {
    const auto place = [&](std::size_t k) { return Eigen::Vector3f(&mesh.particle_rest[3 * corners[t + k]]); };
    const double area = 0.5 * static_cast<double>((place(1) - place(0)).cross(place(2) - place(0)).norm());
    for (std::size_t k = 0; k < 3; ++k) share_[corners[t + k]] += area / 3 / (M_PI * kSpotRadius * kSpotRadius);
  }
}

void Smoke::see(const TissueFrame& frame) {
  const double passed = frame.time - time_;
  time_ = frame.time;
  const bool follows = dose_.size() == frame.dose.size() && passed >= 0 && !anyDoseFell(dose_, frame.dose);
  double burnt = 0;
  for (std::size_t i = 0; follows && i < dose_.size(); ++i)
    burnt += share_[i] * static_cast<double>(frame.dose[i] - dose_[i]);
  dose_ = frame.dose;
  const double ages = passed / kSmokeLife;
  const bool counts = follows && std::isfinite(burnt);  // messages may hold anything
  energy_ = counts ? energy_ * std::exp(-ages) + burnt * leftOfSteady(ages) : 0;
}

double Smoke::extinction() const {
  return std::min(kDensestSmoke, kSmokePerJoule * energy_);
}

}  // namespace vibe::rviz_plugins

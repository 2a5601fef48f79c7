#include "vibe_graphics/geometry/argon_traces.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace vibe::graphics {

namespace {

bool anyGradeFell(const std::vector<std::uint8_t>& before, const std::vector<std::uint8_t>& now) {
  for (std::size_t i = 0; i < before.size(); ++i)
    if ((now.empty() ? 0 : now[i]) < before[i]) return true;
  return false;
}

/// In steps that a picture of 8 bits can tell, so that few frames change anything.
float stepped(double value) {
  return static_cast<float>(std::round(256 * value) / 256);
}

}  // namespace

double browning(double age) {
  return 1 - std::exp2(-age / kTanAge);
}

ScarAge::ScarAge(const TissueMesh& mesh)
    : render_offsets_(mesh.render_offsets),
      render_particles_(mesh.render_particles),
      render_weights_(mesh.render_weights),
      grade_(mesh.particle_count, 0),
      since_(mesh.particle_count, 0),
      of_particle_(mesh.particle_count, 0) {}

bool ScarAge::see(const TissueFrame& frame) {
  const bool anew = frame.time < time_ || anyGradeFell(grade_, frame.grade);
  time_ = frame.time;
  bool changed = false;
  for (std::size_t i = 0; i < grade_.size(); ++i) {
    const std::uint8_t grade = frame.grade.empty() ? std::uint8_t{0} : frame.grade[i];
    if (grade == 0 && grade_[i] == 0) continue;
    if (anew || grade > grade_[i]) since_[i] = time_;
    grade_[i] = grade;
    const float browned = static_cast<float>(grade) * stepped(browning(time_ - since_[i]));
    changed = changed || browned != of_particle_[i];
    of_particle_[i] = browned;
  }
  return changed;
}

std::vector<float> ScarAge::browned() const {
  if (render_offsets_.empty()) return of_particle_;
  std::vector<float> of_vertex(render_offsets_.size() - 1, 0);
  for (std::size_t v = 0; v < of_vertex.size(); ++v)
    for (std::uint32_t k = render_offsets_[v]; k < render_offsets_[v + 1]; ++k)
      of_vertex[v] += render_weights_[k] * of_particle_[render_particles_[k]];
  return of_vertex;
}

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

}  // namespace vibe::graphics

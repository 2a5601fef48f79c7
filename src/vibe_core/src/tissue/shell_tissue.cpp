#include "tissue/shell_tissue.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include <Eigen/Geometry>

#include "arithmetic/elementary.hpp"
#include "geometry/regions.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe {

namespace {

Eigen::Vector3d tangentAt(const StomachAxis& axis, double length) {
  const auto& stations = axis.stations();
  const auto after = std::lower_bound(stations.begin(), stations.end(), length,
                                      [](const StomachAxis::Station& s, double at) { return s.length < at; });
  if (after == stations.begin()) return stations.front().tangent;
  if (after == stations.end()) return stations.back().tangent;
  const auto before = after - 1;
  const double part = (length - before->length) / (after->length - before->length);
  return ((1 - part) * before->tangent + part * after->tangent).normalized();
}

// Direction of the long axis next to every vertex.
std::vector<Eigen::Vector3d> axisDirections(const Organ& organ) {
  const std::size_t count = organ.surface.vertices.size();
  if (std::find(organ.end.begin(), organ.end.end(), End::Duodenum) == organ.end.end()) {
    const Eigen::Vector3d line = organ.landmarks.pylorus - organ.landmarks.fundus;
    if (!(line.norm() > 0))
      throw Error(
          "tissue.fibres needs the organ's long axis, but its fundus and pylorus are one point; set them apart.");
    return std::vector<Eigen::Vector3d>(count, line.normalized());
  }
  const StomachAxis axis = findAxis(organ);
  std::vector<Eigen::Vector3d> out;
  for (std::size_t v = 0; v < count; ++v) out.push_back(tangentAt(axis, axis.lengthAt(static_cast<int>(v))));
  return out;
}

}  // namespace

ShellFibres wallFibres(const FibreScene& scene, const Organ& organ, const std::vector<double>& factor) {
  const std::vector<Eigen::Vector3d> axis = axisDirections(organ);
  ShellFibres fibres;
  fibres.stiffening = scene.stiffening;
  for (std::size_t e = 0; e < factor.size(); ++e) {
    const auto& t = organ.surface.triangles[e];
    const Eigen::Vector3d& first = organ.surface.vertices[t[0]];
    const Eigen::Vector3d normal =
        (organ.surface.vertices[t[1]] - first).cross(organ.surface.vertices[t[2]] - first).normalized();
    const Eigen::Vector3d mean = axis[t[0]] + axis[t[1]] + axis[t[2]];
    const Eigen::Vector3d along = (mean - mean.dot(normal) * normal).normalized(), across = normal.cross(along);
    const Eigen::Vector3d with = math::cos(scene.angle) * along, beside = math::sin(scene.angle) * across;
    fibres.modulus.push_back(scene.modulus * factor[e]);
    fibres.direction.push_back({with + beside, with - beside});
  }
  return fibres;
}

namespace {

// Per triangle: the mean of tissue.stiffness over its nodes.
std::vector<double> stiffnessFactors(const TissueScene& tissue, const Organ& organ) {
  std::vector<double> out;
  for (const auto& t : organ.surface.triangles) {
    double sum = 0;
    for (const int node : t) sum += tissue.stiffness[static_cast<std::size_t>(organ.region[node])];
    out.push_back(sum / 3);
  }
  return out;
}

// Creates one material for each distinct factor.
void addMaterials(const Material& wall, const std::vector<double>& factors, ShellMesh& mesh) {
  std::map<double, int> known;
  for (const double factor : factors) {
    const auto [at, is_new] = known.insert({factor, static_cast<int>(mesh.materials.size())});
    if (is_new) {
      mesh.materials.push_back(wall);
      mesh.materials.back().young_modulus *= factor;
    }
    mesh.material.push_back(at->second);
  }
}

ShellMesh shellMesh(const TissueScene& tissue, const Organ& organ, const std::vector<char>& fixed,
                    const std::optional<WallMuscle>& muscle) {
  ShellMesh mesh;
  mesh.nodes.assign(organ.surface.vertices.begin(), organ.surface.vertices.end());
  for (const auto& t : organ.surface.triangles) {
    mesh.triangles.push_back({t[0], t[1], t[2]});
    mesh.thickness.push_back((organ.thickness[t[0]] + organ.thickness[t[1]] + organ.thickness[t[2]]) / 3);
  }
  Material material;
  material.law = lawByName(tissue.law);
  material.young_modulus = tissue.young_modulus;
  material.poisson_ratio = tissue.poisson_ratio;
  material.stiffening = tissue.stiffening;
  const std::vector<double> factors = stiffnessFactors(tissue, organ);
  addMaterials(material, factors, mesh);
  if (tissue.fibres) mesh.fibres = wallFibres(*tissue.fibres, organ, factors);
  if (muscle) mesh.muscle = muscle->directions();
  mesh.fixed = fixed;
  return mesh;
}

Eigen::Vector3d centreOf(const Organ& organ) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : organ.surface.vertices) sum += p;
  return sum / static_cast<double>(organ.surface.vertices.size());
}

}  // namespace

ShellTissue::ShellTissue(const TissueScene& tissue, const Organ& organ, const std::vector<char>& fixed,
                         const std::optional<MotionScene>& motion)
    : muscle_(motion && gradeOf(*motion) * motion->wave_amplitude > 0 ? std::make_optional<WallMuscle>(*motion, organ)
                                                                      : std::nullopt),
      relaxing_share_(tissue.relaxation ? relaxingShare(*tissue.relaxation) : 0),
      elements_(std::make_shared<const ShellElements>(shellMesh(tissue, organ, fixed, muscle_), centreOf(organ))) {}

std::vector<double> ShellTissue::displacement(const State& state) const {
  std::vector<double> u(3 * state.x.size());
  for (std::size_t i = 0; i < state.x.size(); ++i) {
    const Eigen::Vector3d& rest = elements_->mesh().nodes[i];
    u[3 * i] = state.x[i] - rest.x();
    u[3 * i + 1] = state.y[i] - rest.y();
    u[3 * i + 2] = state.z[i] - rest.z();
  }
  return u;
}

void ShellTissue::displacement4(const State& state, std::vector<float>& out) const {
  const std::vector<Eigen::Vector3d>& rest = elements_->mesh().nodes;
  for (std::size_t i = 0; i < rest.size(); ++i) {
    out[4 * i] = static_cast<float>(state.x[i] - rest[i].x());
    out[4 * i + 1] = static_cast<float>(state.y[i] - rest[i].y());
    out[4 * i + 2] = static_cast<float>(state.z[i] - rest[i].z());
    out[4 * i + 3] = 0;
  }
  if (muscle_) muscle_->contraction(state.time, out.data() + 3, 4);
}

// In single precision, like the solver: ten times as fast, with a relative error of 1e-6.
double ShellTissue::energy(const State& state) const {
  std::vector<float> displacement(4 * state.x.size()), gradient(4 * state.x.size(), 0.0F);
  displacement4(state, displacement);
  double energy = 0;
  for (int piece = 0; piece < elements_->pieceCount(); ++piece)
    energy += elements_->evaluate(piece, displacement.data(), gradient.data());
  // of what relaxes, that which has not been dissipated yet
  const RelaxationMemory& past = state.relaxation;
  return std::accumulate(past.held.begin(), past.held.end(), energy - relaxing_share_ * past.energy);
}

void ShellTissue::addForces(const State& state, double* fx, double* fy, double* fz) const {
  std::vector<double> gradient(3 * state.x.size());
  std::vector<float> contraction(state.x.size(), 0);
  if (muscle_) muscle_->contraction(state.time, contraction.data());
  elements_->evaluate(displacement(state).data(), contraction.data(), gradient.data());
  for (std::size_t i = 0; i < state.x.size(); ++i) {
    fx[i] -= gradient[3 * i];
    fy[i] -= gradient[3 * i + 1];
    fz[i] -= gradient[3 * i + 2];
  }
}

void ShellTissue::strain(const State& state, float* out) const {
  elements_->strain(displacement(state).data(), out);
}

}  // namespace vibe

#include "fem/case_model.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "fem/bench_mesh.hpp"
#include "tetrahedra/tetrahedra.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_core/tissue/shell.hpp"

namespace vibe::benchmarks {

namespace {

constexpr int kSpotParts = 8;  // per side of a triangle; the mean place of a spot is then exact to 1e-3 of its radius

/// Centroids of the parts of a triangle, as coordinates along its first two sides.
std::vector<Eigen::Vector2d> spotPoints() {
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i < kSpotParts; ++i)
    for (int j = 0; i + j < kSpotParts; ++j) {
      points.emplace_back((i + 1.0 / 3) / kSpotParts, (j + 1.0 / 3) / kSpotParts);
      if (i + j + 1 < kSpotParts) points.emplace_back((i + 2.0 / 3) / kSpotParts, (j + 2.0 / 3) / kSpotParts);
    }
  return points;
}

double wallThickness(const FemCase& bench_case, const BenchMesh& mesh, const std::array<int, 3>& t) {
  if (bench_case.thickness_along.isZero()) return bench_case.thickness;
  const Eigen::Vector3d u = mesh.nodes[t[1]] - mesh.nodes[t[0]], v = mesh.nodes[t[2]] - mesh.nodes[t[0]];
  return bench_case.thickness * std::abs(u.cross(v).normalized().dot(bench_case.thickness_along));
}

}  // namespace

CaseModel::CaseModel(const FemCase& bench_case, Hold hold) : case_(bench_case), hold_(hold), mesh_(bench_case.mesh) {
  build();
  for (const auto& spot : case_.spots) spots_[spot.first] = makeSpot(spot.second);
}

void CaseModel::build() {
  if (case_.element == ElementKind::Shell) {
    for (int r = 0; r < case_.refine; ++r) mesh_ = refineTriangles(mesh_, case_.project);
    buildShell(case_, mesh_, body_);
  } else {
    TetMesh<4> tets;
    tets.nodes = mesh_.nodes;
    tets.elements = mesh_.tets;
    tets.materials = {case_.material};
    if (case_.element == ElementKind::QuadraticTet) {
      QuadraticMesh quadratic = quadraticMesh(tets);
      growSets(quadratic.edges, static_cast<int>(mesh_.nodes.size()), mesh_);
      mesh_.nodes = quadratic.mesh.nodes;
      quadratic_ = quadratic.mesh.elements;
      body_.elements = std::make_shared<TetElements<10>>(std::move(quadratic.mesh));
    } else {
      body_.elements = std::make_shared<TetElements<4>>(std::move(tets));
    }
    body_.mass = body_.elements->lumpedMass(case_.density);
  }
  body_.rest = mesh_.nodes;
  body_.fixed.assign(mesh_.nodes.size(), 0);
  for (const std::string& name : case_.clamped)
    for (const int node : set(name)) body_.fixed[node] = 1;
  for (const std::string& name : case_.hinged)
    for (const int node : set(name)) body_.fixed[node] = 1;
  for (const SetMotion& motion : case_.motions)
    if (isFixedMotion(motion))
      for (const int node : set(motion.set)) body_.fixed[node] = 1;
  if (case_.foundation > 0) body_.foundation.assign(mesh_.nodes.size(), case_.foundation);
  body_.mass_damping = case_.mass_damping;
  body_.stiffness_damping = case_.stiffness_damping;
}

bool CaseModel::isFixedMotion(const SetMotion& motion) const {
  return hold_ == Hold::AsFixed && motion.held[0] && motion.held[1] && motion.held[2];
}

std::vector<double> CaseModel::spotWeights(const SpotRule& rule) const {
  const auto weight = [&rule](const Eigen::Vector3d& place) {
    Eigen::Vector3d from = place - rule.centre;
    from -= rule.along.dot(from) * rule.along;
    const double part = std::max(0.0, 1 - from.squaredNorm() / (rule.radius * rule.radius));
    return part * part;
  };
  std::vector<double> weights(mesh_.nodes.size(), 0.0);
  if (case_.element != ElementKind::Shell) {
    for (std::size_t n = 0; n < weights.size(); ++n) weights[n] = weight(mesh_.nodes[n]) * body_.mass[n];
    return weights;
  }
  for (std::size_t e = 0; e < mesh_.triangles.size(); ++e) {
    const auto& t = mesh_.triangles[e];
    const Eigen::Vector3d &a = mesh_.nodes[t[0]], u = mesh_.nodes[t[1]] - a, v = mesh_.nodes[t[2]] - a;
    const double volume = u.cross(v).norm() * wallThickness(case_, mesh_, t);
    for (const Eigen::Vector2d& part : spotPoints()) {
      const double here = weight(a + part[0] * u + part[1] * v) * volume;
      weights[t[0]] += (1 - part.sum()) * here, weights[t[1]] += part[0] * here, weights[t[2]] += part[1] * here;
    }
  }
  return weights;
}

NodeMean CaseModel::makeSpot(const SpotRule& rule) const {
  NodeMean mean;
  const std::vector<double> weights = spotWeights(rule);
  double sum = 0;
  for (int n = 0; n < nodeCount(); ++n) {
    if (weights[n] <= 0) continue;
    mean.node.push_back(n);
    mean.weight.push_back(weights[n]);
    sum += weights[n];
  }
  if (!(sum > 0)) throw Error(case_.file + ": spots: a spot holds no node; enlarge its radius or refine the mesh.");
  for (double& weight : mean.weight) weight /= sum;
  return mean;
}

ElasticBody CaseModel::body(double level) const {
  ElasticBody body = body_;
  body.gravity = level * case_.gravity;
  if (!case_.forces.empty()) body.load.assign(mesh_.nodes.size(), Eigen::Vector3d::Zero());
  for (const AttachmentForce& force : case_.forces) {
    const NodeMean& mean = spot(force.spot);
    for (std::size_t i = 0; i < mean.node.size(); ++i)
      body.load[mean.node[i]] += force.ramp.at(level) * mean.weight[i] * force.force;
  }
  return body;
}

Eigen::Vector3d CaseModel::moved(const SetMotion& motion, const Eigen::Vector3d& rest, double level) const {
  const double part = motion.ramp.at(level);
  Eigen::Vector3d to = rest;
  if (motion.angle != 0)
    to = motion.centre + Eigen::AngleAxisd(part * motion.angle, motion.axis) * (rest - motion.centre);
  return to + part * motion.translation;
}

std::vector<std::pair<int, Eigen::Vector3d>> CaseModel::prescribed(double level) const {
  std::vector<std::pair<int, Eigen::Vector3d>> nodes;
  for (const SetMotion& motion : case_.motions) {
    if (!isFixedMotion(motion)) continue;
    for (const int n : set(motion.set)) nodes.emplace_back(n, moved(motion, mesh_.nodes[n], level));
  }
  return nodes;
}

BodyLoads CaseModel::loads(double level) const {
  BodyLoads loads;
  if (case_.cinch) {
    LinearConstraint constraint;
    double rest = 0;
    for (const double sign : {1.0, -1.0}) {
      const NodeMean& mean = spot(sign > 0 ? case_.cinch->first : case_.cinch->second);
      for (std::size_t i = 0; i < mean.node.size(); ++i) {
        constraint.node.push_back(mean.node[i]);
        constraint.coefficient.push_back(sign * mean.weight[i] * case_.cinch->direction);
        rest += constraint.coefficient.back().dot(mesh_.nodes[mean.node[i]]);
      }
    }
    constraint.target = rest + case_.cinch->ramp.at(level) * (case_.cinch->distance - rest);
    loads.constraints.push_back(constraint);
  }
  addPullConstraints(level, loads);
  addMotionConstraints(level, loads);
  if (case_.gas) {
    loads.gas.control = case_.gas->by_volume ? GasLoad::Control::Volume : GasLoad::Control::Pressure;
    const double part = case_.gas->ramp.at(level);
    loads.gas.pressure = part * case_.gas->pressure;
    loads.gas.target_volume = restVolume() * (1 + part * (case_.gas->volume_ratio - 1));
    loads.gas.volume = restVolume();
  }
  return loads;
}

void CaseModel::addPullConstraints(double level, BodyLoads& loads) const {
  for (const AttachmentPull& pull : case_.pulls) {
    const NodeMean& mean = spot(pull.spot);
    for (int axis = 0; axis < 3; ++axis) {
      LinearConstraint constraint;
      constraint.node = mean.node;
      constraint.target = pull.ramp.at(level) * pull.displacement[axis];
      for (std::size_t i = 0; i < mean.node.size(); ++i) {
        constraint.coefficient.push_back(mean.weight[i] * Eigen::Vector3d::Unit(axis));
        constraint.target += mean.weight[i] * mesh_.nodes[mean.node[i]][axis];
      }
      loads.constraints.push_back(constraint);
    }
  }
}

void CaseModel::addMotionConstraints(double level, BodyLoads& loads) const {
  for (const SetMotion& motion : case_.motions) {
    if (isFixedMotion(motion)) continue;
    for (const int n : set(motion.set)) {
      const Eigen::Vector3d to = moved(motion, mesh_.nodes[n], level);
      for (int axis = 0; axis < 3; ++axis) {
        if (!motion.held[static_cast<std::size_t>(axis)]) continue;
        LinearConstraint constraint;
        constraint.node = {n};
        constraint.coefficient = {Eigen::Vector3d::Unit(axis)};
        constraint.target = to[axis];
        loads.constraints.push_back(constraint);
      }
    }
  }
}

double CaseModel::restVolume() const {
  double volume = 0;
  for (const auto& t : mesh_.triangles) volume += mesh_.nodes[t[0]].dot(mesh_.nodes[t[1]].cross(mesh_.nodes[t[2]])) / 6;
  return volume;
}

NodeMean CaseModel::at(const Eigen::Vector3d& point) const {
  return case_.element == ElementKind::Shell ? atTriangle(point) : atTet(point);
}

NodeMean CaseModel::atTriangle(const Eigen::Vector3d& point) const {
  NodeMean best;
  double best_distance = std::numeric_limits<double>::infinity();
  for (const auto& t : mesh_.triangles) {
    const Eigen::Vector3d a = mesh_.nodes[t[0]], u = mesh_.nodes[t[1]] - a, v = mesh_.nodes[t[2]] - a;
    Eigen::Matrix<double, 3, 2> sides;
    sides << u, v;
    Eigen::Vector2d part = (sides.transpose() * sides).inverse() * (sides.transpose() * (point - a));
    part = part.cwiseMax(0.0);
    if (part.sum() > 1) part /= part.sum();
    const double distance = (a + sides * part - point).norm();
    if (distance >= best_distance) continue;
    best_distance = distance;
    best.node = {t[0], t[1], t[2]};
    best.weight = {1 - part.sum(), part[0], part[1]};
  }
  return best;
}

NodeMean CaseModel::atTet(const Eigen::Vector3d& point) const {
  std::size_t best = 0;
  double best_inside = -std::numeric_limits<double>::infinity();
  Eigen::Vector4d coordinates = Eigen::Vector4d::Zero();
  for (std::size_t e = 0; e < mesh_.tets.size(); ++e) {
    const auto& t = mesh_.tets[e];
    Eigen::Matrix3d sides;
    for (int k = 0; k < 3; ++k) sides.col(k) = mesh_.nodes[t[k + 1]] - mesh_.nodes[t[0]];
    const Eigen::Vector3d part = sides.inverse() * (point - mesh_.nodes[t[0]]);
    const Eigen::Vector4d here(1 - part.sum(), part[0], part[1], part[2]);
    if (here.minCoeff() <= best_inside) continue;
    best_inside = here.minCoeff();
    best = e;
    coordinates = here;
  }
  coordinates = coordinates.cwiseMax(0.0);
  coordinates /= coordinates.sum();
  NodeMean mean;
  const auto& l = coordinates;
  if (quadratic_.empty()) {
    mean.node.assign(mesh_.tets[best].begin(), mesh_.tets[best].end());
    mean.weight.assign(l.data(), l.data() + 4);
    return mean;
  }
  mean.node.assign(quadratic_[best].begin(), quadratic_[best].end());
  for (int k = 0; k < 4; ++k) mean.weight.push_back(l[k] * (2 * l[k] - 1));
  for (const auto& edge : {std::array<int, 2>{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}})
    mean.weight.push_back(4 * l[edge[0]] * l[edge[1]]);
  return mean;
}

namespace {

/// The hinged sides between two nodes; the wall rotates freely about them.
std::vector<std::array<int, 2>> hingedSides(const FemCase& bench_case, const BenchMesh& mesh) {
  std::vector<char> hinged(mesh.nodes.size(), 0);
  for (const std::string& name : bench_case.hinged)
    for (const int node : mesh.sets.at(name)) hinged[node] = 1;
  std::map<std::array<int, 2>, int> sides;
  for (const auto& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) {
      const int a = t[static_cast<std::size_t>(k)], b = t[static_cast<std::size_t>((k + 1) % 3)];
      if (hinged[a] != 0 && hinged[b] != 0) sides[{std::min(a, b), std::max(a, b)}] = 1;
    }
  std::vector<std::array<int, 2>> list;
  for (const auto& side : sides) list.push_back(side.first);
  return list;
}

}  // namespace

void buildShell(const FemCase& bench_case, const BenchMesh& mesh, ElasticBody& body) {
  ShellMesh shell;
  shell.nodes = mesh.nodes;
  shell.triangles = mesh.triangles;
  for (const auto& t : mesh.triangles) shell.thickness.push_back(wallThickness(bench_case, mesh, t));
  shell.materials = {bench_case.material};
  shell.fixed.assign(mesh.nodes.size(), 0);
  for (const auto* names : {&bench_case.clamped, &bench_case.hinged})
    for (const std::string& name : *names)
      for (const int node : mesh.sets.at(name)) shell.fixed[node] = 1;
  for (const SetMotion& motion : bench_case.motions)
    if (motion.held[0] && motion.held[1] && motion.held[2] && motion.angle == 0)  // a clamp keeps its tangent plane
      for (const int node : mesh.sets.at(motion.set)) shell.fixed[node] = 1;
  shell.hinged = hingedSides(bench_case, mesh);
  auto elements = std::make_shared<ShellElements>(std::move(shell));
  body.shell = elements.get();
  body.mass = elements->lumpedMass(bench_case.density);
  body.elements = std::move(elements);
}

}  // namespace vibe::benchmarks

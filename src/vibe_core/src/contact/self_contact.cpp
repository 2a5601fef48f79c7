#include "contact/self_contact.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "contact/self_contact_distance.hpp"
#include "contact/self_contact_memory.hpp"
#include "vibe_core/common/error.hpp"

namespace vibe {

namespace {

constexpr double kOneWallThicknesses = 2.5, kOneWallEdges = 3;  // along the surface
constexpr double kFacingCosine = 0.3;   // of the normals of walls in contact: the next wall along a line faces this one
constexpr double kSoftness = 0.1;       // modulus of the contact, relative to that of the wall
constexpr double kOnset = 0.25;         // strain over which contact sets in
constexpr double kStraightBelow = 0.2;  // fraction of the thickness below which the energy is extended linearly
constexpr double kDrag = 2;             // relative to force over distance: more than the force turns as a vertex slides
constexpr double kAhead = 1;            // thicknesses searched beyond contact, so that most steps need no new search
constexpr double kMinAhead = 0.1;       // least value of the same
constexpr double kFlatSight = 0.8;      // smallest straight distance on a flat wall, relative to that along edges
constexpr double kFloor = 0.05;         // minimum distance of walls, in thicknesses
constexpr double kLeg = 6e-3;           // a step with longer moves is split into parts, so that few walls are near [m]

struct Squeeze {
  double value, slope, curvature;  // energy and its derivatives with respect to s [1]
};

/// Energy per A E' t / 2 of a wall squeezed to s of its thickness.
Squeeze squeeze(double s) {
  if (s >= 1 + kOnset) return {0, 0, 0};
  const double kept = std::max(s, kStraightBelow), strain = 1 - kept;
  const double ramp = strain + kOnset;
  const bool full = strain > kOnset;
  const double h = full ? strain : ramp * ramp / (4 * kOnset);
  const double h_slope = full ? 1 : ramp / (2 * kOnset), h_curvature = full ? 0 : 1 / (2 * kOnset);
  const double hencky = std::log1p(-h), stress = hencky / (1 - h);
  const double slope = stress * h_slope;
  const double curvature = (1 - hencky) / ((1 - h) * (1 - h)) * h_slope * h_slope - stress * h_curvature;
  return {0.5 * hencky * hencky + slope * (s - kept), slope, curvature};
}

void check(const SurfaceMesh& rest, const std::vector<double>& thickness, double young_modulus) {
  if (rest.vertices.empty() || thickness.size() != rest.vertices.size())
    throw Error("A wall that can meet itself has " + std::to_string(rest.vertices.size()) + " vertices but " +
                std::to_string(thickness.size()) + " thicknesses; give one thickness per vertex.");
  for (std::size_t t = 0; t < rest.triangles.size(); ++t)
    for (const int v : rest.triangles[t])
      if (v < 0 || v >= static_cast<int>(rest.vertices.size()))
        throw Error("Triangle " + std::to_string(t) + " of a wall that can meet itself names vertex " +
                    std::to_string(v) + ", which does not exist; correct the mesh.");
  for (std::size_t v = 0; v < thickness.size(); ++v)
    if (!(thickness[v] > 0 && std::isfinite(thickness[v])))
      throw Error("The wall that can meet itself has thickness " + std::to_string(thickness[v]) + " m at vertex " +
                  std::to_string(v) + "; it must be above 0.");
  if (!(young_modulus > 0 && std::isfinite(young_modulus)))
    throw Error("The wall that can meet itself has a Young's modulus of " + std::to_string(young_modulus) +
                " Pa; it must be above 0.");
}

/// Square of the largest distance between two sets of points; not finite if one of them is not [m^2].
double farthest(const std::array<std::vector<double>, 3>& from, const double* const* to, std::size_t count) {
  double max[4] = {0, 0, 0, 0}, sum[4] = {0, 0, 0, 0};  // four independent sums: the only cost for walls far apart
  const double *a = from[0].data(), *b = from[1].data(), *c = from[2].data();
  const auto add = [&](std::size_t i, std::size_t k) {
    const double x = to[0][i] - a[i], y = to[1][i] - b[i], z = to[2][i] - c[i];
    const double square = x * x + y * y + z * z;
    sum[k] += square;
    max[k] = square > max[k] ? square : max[k];
  };
  std::size_t i = 0;
  for (; i + 4 <= count; i += 4)
    for (std::size_t k = 0; k < 4; ++k) add(i + k, k);
  for (; i < count; ++i) add(i, 0);
  return std::max(std::max(max[0], max[1]), std::max(max[2], max[3])) + 0 * (sum[0] + sum[1] + sum[2] + sum[3]);
}

Eigen::Vector3d at(const double* positions4, int node) {
  const double* p = positions4 + 4 * static_cast<std::size_t>(node);
  return {p[0], p[1], p[2]};
}

double meanEdge(const SurfaceMesh& mesh) {
  double sum = 0;
  for (const auto& n : mesh.triangles)
    for (int k = 0; k < 3; ++k) sum += (mesh.vertices[n[k]] - mesh.vertices[n[(k + 1) % 3]]).norm();
  return mesh.triangles.empty() ? 0 : sum / (3 * static_cast<double>(mesh.triangles.size()));
}

}  // namespace

SelfContact::SelfContact(SurfaceMesh rest, std::vector<double> thickness, double young_modulus)
    : rest_(std::move(rest)), thickness_(std::move(thickness)), stiffness_(kSoftness * young_modulus) {
  check(rest_, thickness_, young_modulus);
  area_ = vertexAreas(rest_);
  min_thickness_ = *std::min_element(thickness_.begin(), thickness_.end());
  max_thickness_ = *std::max_element(thickness_.begin(), thickness_.end());
  const double edge = meanEdge(rest_), one_wall = std::max(kOneWallThicknesses * max_thickness_, kOneWallEdges * edge);
  // seen from a vertex, a flat wall that no longer counts as one wall with it stays beyond the search distance
  ahead_ = std::clamp(kFlatSight * one_wall - 0.5 * edge - max_thickness_ * (1 + kOnset), kMinAhead * max_thickness_,
                      kAhead * max_thickness_);
  memory_ = std::make_unique<SelfContactMemory>(rest_, std::vector<double>(thickness_.size(), one_wall),
                                                kFloor * min_thickness_);
}

SelfContact::~SelfContact() = default;

void SelfContact::detect(const double* x, const double* y, const double* z, double reach) {
  pairs_.clear();
  if (!start(x, y, z, moved_)) {
    cover_ = -1;
    memory_->near.clear();
    return;
  }
  if (cover_ < (1 + kOnset) * max_thickness_ + reach + 2 * moved_) search(reach);
  addPairs(reach);
}

// Stores the positions and computes their distance from those of the last search.
bool SelfContact::start(const double* x, const double* y, const double* z, double& moved) {
  const double* now[3] = {x, y, z};
  SelfContactMemory& m = *memory_;
  const std::size_t n = thickness_.size();
  for (int k = 0; k < 3; ++k) std::copy(now[k], now[k] + n, m.start[k].begin());
  const double largest = farthest(m.searched, now, n);
  moved = std::sqrt(largest);
  return std::isfinite(largest);
}

void SelfContact::search(double reach) {
  ++searches_;
  SelfContactMemory& m = *memory_;
  for (int k = 0; k < 3; ++k) m.searched[k] = m.start[k];
  moved_ = 0;
  for (std::size_t i = 0; i < m.position.size(); ++i) m.position[i] = m.at(static_cast<int>(i));
  cover_ = (1 + kOnset) * max_thickness_ + std::max(ahead_, reach + kMinAhead * max_thickness_);
  m.search.findNear(m.position, cover_, m.found);
  m.near.clear();
  for (const SelfContactSearch::Near& near : m.found) m.near.push_back({near, Eigen::Vector3d::Zero()});
}

double SelfContact::meanThickness(int vertex, int triangle) const {
  const auto& n = rest_.triangles[triangle];
  return 0.5 * (thickness_[vertex] + (thickness_[n[0]] + thickness_[n[1]] + thickness_[n[2]]) / 3);
}

// 1 where the angle between the normals of a vertex and of a triangle is more than a right angle, 0 where they do not
// face each other.
double SelfContact::facing(int vertex, int triangle) const {
  const SelfContactMemory& m = *memory_;
  auto areaVector = [&](int t) -> Eigen::Vector3d {
    const auto& n = rest_.triangles[t];
    const Eigen::Vector3d a = m.at(n[0]);
    return (m.at(n[1]) - a).cross(m.at(n[2]) - a);
  };
  Eigen::Vector3d own = Eigen::Vector3d::Zero();
  m.search.visitRing(vertex, [&](int t) { own += areaVector(t); });
  const Eigen::Vector3d other = areaVector(triangle);
  const double size = std::sqrt(own.squaredNorm() * other.squaredNorm());
  return size > 0 ? std::clamp(1 - own.dot(other) / (kFacingCosine * size), 0.0, 1.0) : 0;
}

// For a vertex, the nearest triangle that faces it, and the nearest on the opposite side.
void SelfContact::addPairs(double reach) {
  std::vector<SelfContactPaths::Approach>& near = memory_->near;
  for (std::size_t first = 0, next; first < near.size(); first = next) {
    const int vertex = near[first].near.vertex;
    const Eigen::Vector3d p = memory_->at(vertex);
    int best[2] = {-1, -1};
    double best_facing[2] = {0, 0};
    for (next = first; next < near.size() && near[next].near.vertex == vertex; ++next) {
      const auto& n = rest_.triangles[near[next].near.triangle];
      near[next].away = triangleFoot(p, memory_->at(n[0]), memory_->at(n[1]), memory_->at(n[2])).away;
    }
    for (int side = 0; side < 2 && (side == 0 || best[0] >= 0); ++side) {
      double min = std::numeric_limits<double>::infinity();
      for (std::size_t k = first; k < next; ++k) {
        const double distance = near[k].away.norm();
        if (distance >= min || (side == 1 && near[k].away.dot(near[best[0]].away) >= 0)) continue;
        if (distance >= (1 + kOnset) * meanThickness(vertex, near[k].near.triangle) + reach) continue;
        const double faces = facing(vertex, near[k].near.triangle);
        if (faces == 0) continue;
        min = distance;
        best[side] = static_cast<int>(k);
        best_facing[side] = faces;
      }
      if (best[side] >= 0) addPair(best[side], best_facing[side]);
    }
  }
}

void SelfContact::addPair(int near, double facing) {
  const auto [vertex, triangle] = memory_->near[near].near;
  const auto& n = rest_.triangles[triangle];
  const TriangleFoot foot = triangleFoot(memory_->at(vertex), memory_->at(n[0]), memory_->at(n[1]), memory_->at(n[2]));
  const auto& r = rest_.vertices;
  const double at_rest = triangleFoot(r[vertex], r[n[0]], r[n[1]], r[n[2]]).away.norm();
  Pair pair;
  pair.node = {vertex, n[0], n[1], n[2]};
  pair.weight = foot.weight;
  pair.normal = foot.away.normalized();
  pair.thickness = std::min(meanThickness(vertex, triangle), at_rest / (1 + kOnset));
  pair.stiffness = 0.5 * facing * area_[vertex] * stiffness_ * pair.thickness;
  if (!(pair.stiffness > 0)) return;
  // the normal is constant within the step, so active contacts have to slide slowly
  const double s = foot.away.norm() / pair.thickness;
  pair.away = foot.away;
  pair.drag =
      -kDrag * pair.stiffness / (pair.thickness * pair.thickness) * squeeze(s).slope / std::max(s, kStraightBelow);
  pairs_.push_back(pair);
}

double SelfContact::evaluate(const double* positions4, float* gradient4) const {
  double energy = 0;
  for (const Pair& pair : pairs_) {
    Eigen::Vector3d away = at(positions4, pair.node[0]);
    for (int k = 0; k < 3; ++k) away -= pair.weight[k] * at(positions4, pair.node[k + 1]);
    const Squeeze squeezed = squeeze(pair.normal.dot(away) / pair.thickness);
    if (squeezed.value == 0 && pair.drag == 0) continue;
    const Eigen::Vector3d change = away - pair.away;
    const Eigen::Vector3d slid = change - pair.normal.dot(change) * pair.normal;
    energy += pair.stiffness * squeezed.value + 0.5 * pair.drag * slid.squaredNorm();
    const Eigen::Vector3d force = pair.stiffness / pair.thickness * squeezed.slope * pair.normal + pair.drag * slid;
    for (int c = 0; c < 3; ++c) {
      gradient4[4 * static_cast<std::size_t>(pair.node[0]) + c] += static_cast<float>(force[c]);
      for (int k = 0; k < 3; ++k)
        gradient4[4 * static_cast<std::size_t>(pair.node[k + 1]) + c] -= static_cast<float>(pair.weight[k] * force[c]);
    }
  }
  return energy;
}

void SelfContact::addStiffness(const double* positions4, std::vector<StiffnessCoupling>& couplings) const {
  for (const Pair& pair : pairs_) {
    Eigen::Vector3d away = at(positions4, pair.node[0]);
    for (int k = 0; k < 3; ++k) away -= pair.weight[k] * at(positions4, pair.node[k + 1]);
    const Squeeze squeezed = squeeze(pair.normal.dot(away) / pair.thickness);
    const double normal = pair.stiffness / (pair.thickness * pair.thickness) * squeezed.curvature;
    if (normal == 0 && pair.drag == 0) continue;
    const Eigen::Vector3d& n = pair.normal;
    const Eigen::Matrix3d k = pair.drag * Eigen::Matrix3d::Identity() + (normal - pair.drag) * n * n.transpose();
    couplings.push_back({{pair.node[0], pair.node[1], pair.node[2], pair.node[3], -1, -1},
                         {1, -static_cast<float>(pair.weight[0]), -static_cast<float>(pair.weight[1]),
                          -static_cast<float>(pair.weight[2])},
                         {static_cast<float>(k(0, 0)), static_cast<float>(k(0, 1)), static_cast<float>(k(0, 2)),
                          static_cast<float>(k(1, 1)), static_cast<float>(k(1, 2)), static_cast<float>(k(2, 2))}});
  }
}

bool SelfContact::endsOf(const double* x, const double* y, const double* z, double& longest) {
  const double* end[3] = {x, y, z};
  const double largest = farthest(memory_->start, end, thickness_.size());
  longest = std::sqrt(largest);
  return std::isfinite(largest);
}

const std::vector<int>& SelfContact::resolvePenetrations(const MotionView& motion, double step) {
  stopped_.clear();
  double *x = motion.x[0], *y = motion.x[1], *z = motion.x[2];
  SelfContactMemory& m = *memory_;
  double longest = 0;
  if (cover_ < 0 || !endsOf(x, y, z, longest)) return stopped_;
  const double floor = kFloor * min_thickness_, sight = cover_ - 2 * moved_ - floor;
  if (m.near.empty() && 2 * longest < sight) return stopped_;
  const int legs = 2 * longest < sight ? 1 : static_cast<int>(std::min(64.0, std::ceil(longest / (0.5 * kLeg))));
  for (std::size_t i = 0; i < m.position.size(); ++i) m.position[i] = m.at(static_cast<int>(i));
  m.stopped.assign(m.position.size(), 0);
  for (int leg = 0; leg < legs; ++leg) {
    double farthest_move = 0;
    for (std::size_t i = 0; i < m.position.size(); ++i) {
      m.move[i] = (Eigen::Vector3d(x[i], y[i], z[i]) - m.position[i]) / (legs - leg);
      farthest_move = std::max(farthest_move, m.move[i].squaredNorm());
    }
    farthest_move = std::sqrt(farthest_move);
    findApproaches(legs > 1, 2 * farthest_move + floor);
    update();
  }
  for (std::size_t i = 0; i < m.position.size(); ++i) {
    if (m.stopped[i] == 0) continue;
    for (int k = 0; k < 3; ++k) {
      motion.x[k][i] = m.position[i][k];
      motion.v[k][i] = (m.position[i][k] - m.start[k][i]) / step;
      motion.a[k][i] = 0;
    }
    stopped_.push_back(static_cast<int>(i));
  }
  return stopped_;
}

void SelfContact::findApproaches(bool anew, double distance) {
  SelfContactMemory& m = *memory_;
  m.approaches.clear();
  if (!anew) {
    for (const auto& near : m.near) {
      const double sight = distance + 0.5 * m.search.longestEdge(near.near.vertex) + moved_;
      if (near.away.squaredNorm() < sight * sight) m.approaches.push_back(near);
    }
    return;
  }
  cover_ = -1;  // the positions of the search have changed
  m.search.findNear(m.position, distance, m.found);
  for (const auto& near : m.found) {
    const auto& n = rest_.triangles[near.triangle];
    m.approaches.push_back(
        {near, triangleFoot(m.position[near.vertex], m.position[n[0]], m.position[n[1]], m.position[n[2]]).away});
  }
}

void SelfContact::update() {
  SelfContactMemory& m = *memory_;
  m.whole = m.move;
  const bool shortened = m.paths.shorten(m.position, m.approaches, m.move);
  for (std::size_t i = 0; i < m.position.size(); ++i) {
    if (shortened && m.move[i] != m.whole[i]) m.stopped[i] = 1;
    m.position[i] += m.move[i];
  }
}

}  // namespace vibe

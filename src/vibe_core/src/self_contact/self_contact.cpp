#include "self_contact/self_contact.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>
#include <utility>

#include "geometry/triangle_distance.hpp"
#include "self_contact/self_contact_memory.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe {

namespace {

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

double longestEdge(const SurfaceMesh& mesh) {
  double longest2 = 0;
  for (const auto& n : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k)
      longest2 = std::max(longest2, (mesh.vertices[n[(k + 1) % 3]] - mesh.vertices[n[k]]).squaredNorm());
  return std::sqrt(longest2);
}

Eigen::Vector3d nodeOf(const double* positions4, int node) {
  const double* p = positions4 + 4 * static_cast<std::size_t>(node);
  return {p[0], p[1], p[2]};
}

}  // namespace

SelfContact::SelfContact(SurfaceMesh rest, std::vector<double> thickness, double young_modulus, bool carried)
    : policy_(stepPolicy()),
      rest_(std::move(rest)),
      thickness_(std::move(thickness)),
      stiffness_(policy_.wall_softness * young_modulus) {
  check(rest_, thickness_, young_modulus);
  area_ = vertexAreas(rest_);
  min_thickness_ = *std::min_element(thickness_.begin(), thickness_.end());
  max_thickness_ = *std::max_element(thickness_.begin(), thickness_.end());
  close_distance_ = 0.5 * longestEdge(rest_) + policy_.wall_core_search * max_thickness_;
  memory_ = std::make_unique<SelfContactMemory>(rest_, policy_.wall_reach * max_thickness_, facingCosine(),
                                                policy_.path_floor * min_thickness_,
                                                policy_.search_slack * max_thickness_, carried);
}

SelfContact::~SelfContact() = default;

int SelfContact::searchCount() const {
  return memory_->search.count();
}

void SelfContact::detect(const NodeVectors& x, const NodeVectors& v, double reach, double lead, ThreadPool* pool) {
  if (isStart(x, v) && reach == reach_ && lead == lead_) return;
  reach_ = reach;
  lead_ = lead;
  pairs_.clear();
  energy_ = 0;
  for (std::size_t k = 0; k < 3; ++k) std::copy(x[k], x[k] + thickness_.size(), memory_->start[k].begin());
  const SelfContactSearch::NodeVectors at = SelfContactMemory::view(memory_->start);
  found_ = memory_->search.adapt(at, at, searchDistance());
  speeds_matter_ = found_ && !memory_->search.near().empty();
  if (!speeds_matter_) return;
  for (std::size_t k = 0; k < 3; ++k) std::copy(v[k], v[k] + thickness_.size(), memory_->speed[k].begin());
  addPairs();
  addClosePairs(pool);
}

// Whether the state is that of the last detect(), because the end of a step is usually the start of the next.
bool SelfContact::isStart(const NodeVectors& x, const NodeVectors& v) const {
  if (reach_ < 0) return false;
  const std::size_t n = thickness_.size();
  for (std::size_t k = 0; k < 3; ++k)
    if (std::memcmp(x[k], memory_->start[k].data(), n * sizeof(double)) != 0 ||
        (speeds_matter_ && std::memcmp(v[k], memory_->speed[k].data(), n * sizeof(double)) != 0))
      return false;
  return true;
}

// Vertices and triangles are listed up to this distance. Where two edges cross, an end of one is within half its
// length.
double SelfContact::searchDistance() const {
  return std::max((1 + policy_.wall_onset) * max_thickness_ + reach_, close_distance_);
}

void SelfContact::addPairs() {
  const std::vector<SelfContactSearch::Near>& near = memory_->search.near();
  memory_->facing.clear();
  memory_->search.measure(SelfContactMemory::view(memory_->start));
  for (std::size_t first = 0, next; first < near.size(); first = next) {
    const int vertex = near[first].vertex;
    for (next = first + 1; next < near.size() && near[next].vertex == vertex;) ++next;
    collectApproaches(vertex, first, next);
    if (memory_->approaches.empty()) continue;
    addPairsOf(vertex);
    collectFacing(vertex);
  }
}

// @param share  of the bar of the vertex that stands on this triangle
void SelfContact::addPair(int vertex, int triangle, double share) {
  const auto& n = rest_.triangles[triangle];
  const TriangleFoot foot = triangleFoot(memory_->at(vertex), memory_->at(n[0]), memory_->at(n[1]), memory_->at(n[2]));
  // Walls that are nearer than their thickness at rest touch at the distance that they have there.
  const auto& r = rest_.vertices;
  const double at_rest = triangleFoot(r[vertex], r[n[0]], r[n[1]], r[n[2]]).away.norm();
  Pair pair;
  pair.node = {vertex, n[0], n[1], n[2]};
  pair.weight = {1, -foot.weight[0], -foot.weight[1], -foot.weight[2]};
  pair.away = foot.away;
  pair.thickness = std::min(meanThickness(vertex, triangle, foot.weight), at_rest / (1 + policy_.wall_onset));
  pair.straight_below = policy_.wall_straight_below;
  pair.stiffness = 0.5 * share * area_[vertex] * stiffness_ * pair.thickness;
  finish(pair);
}

void SelfContact::addClosePairs(ThreadPool* pool) {
  SelfContactMemory& m = *memory_;
  for (const ClosePoints& close : m.close.find(m.facing, m.start, policy_.wall_core_search * max_thickness_, pool))
    addClosePair(close);
}

// Adds the bar of squeezed mucosa at a spot. The nearest points of two walls need not be at the foot of a vertex in a
// triangle that faces it: edges cross, and there are further triangles.
void SelfContact::addClosePair(const ClosePoints& close) {
  // The weights sum to 1 and -1 on the two sides, so that half of their sizes make means over both walls.
  Eigen::Vector3d at_rest = Eigen::Vector3d::Zero();
  double thickness = 0, area = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    if (close.node[k] < 0) continue;
    const double part = 0.5 * std::abs(close.weight[k]);
    at_rest += close.weight[k] * rest_.vertices[close.node[k]];
    thickness += part * thickness_[close.node[k]];
    area += part * area_[close.node[k]];
  }
  Pair pair;
  pair.node = close.node;
  pair.weight = close.weight;
  pair.away = close.away;
  // A bar is no longer than the distance of its ends at rest allows, or it would act there.
  const double apart_at_rest = close.in_wall ? policy_.wall_fold_core : 1 / (1 + policy_.wall_onset);
  pair.thickness = std::min(policy_.wall_core * thickness, apart_at_rest * at_rest.norm());
  // The energy stays logarithmic as far as the distance at which paths end.
  pair.straight_below = policy_.path_floor / policy_.wall_core;
  // Squeezed flat, mucosa is as stiff as the wall: the softness is taken out of stiffness_.
  pair.stiffness = 0.5 * close.share * area / policy_.wall_softness * stiffness_ * pair.thickness;
  finish(pair);
}

// Completes a pair by what follows from the state, normal, energy and friction, and adds it.
void SelfContact::finish(Pair& pair) {
  const double distance = pair.away.norm();
  if (!(pair.stiffness > 0 && distance > 0)) return;
  pair.normal = pair.away / distance;
  const Squeeze squeezed = squeeze(distance / pair.thickness, pair.straight_below, policy_.wall_onset);
  pair.friction = -policy_.wall_friction * pair.stiffness / pair.thickness * squeezed.slope;
  Eigen::Vector3d speed = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < 4; ++k)
    if (pair.node[k] >= 0) speed += pair.weight[k] * memory_->speedOf(pair.node[k]);
  pair.speed = (speed - pair.normal.dot(speed) * pair.normal).norm();
  energy_ += pair.stiffness * squeezed.value;
  pairs_.push_back(pair);
}

double SelfContact::normalForce(const Pair& pair) const {
  const double distance = pair.away.norm() / pair.thickness;
  return -pair.stiffness / pair.thickness * squeeze(distance, pair.straight_below, policy_.wall_onset).slope;
}

double SelfContact::evaluate(const double* positions4, float* gradient4) const {
  double energy = 0;
  const double smooth = policy_.wall_sliding_speed * lead_, onset = policy_.wall_onset;
  for (const Pair& pair : pairs_) {
    const Eigen::Vector3d away = awayAt(pair, positions4);
    const Squeeze squeezed = squeeze(pair.normal.dot(away) / pair.thickness, pair.straight_below, onset);
    if (squeezed.value == 0 && pair.friction == 0) continue;
    // A pair that has come apart in the step still has the friction of its normal force at the start.
    const Eigen::Vector3d slid = slidSince(pair, away);
    const Sliding slide = sliding(slid.norm(), smooth);
    energy += pair.stiffness * squeezed.value + pair.friction * slide.way;
    const Eigen::Vector3d force =
        pair.stiffness / pair.thickness * squeezed.slope * pair.normal + pair.friction * slide.per_way * slid;
    for (std::size_t k = 0; k < 4; ++k)
      for (Eigen::Index c = 0; c < 3 && pair.node[k] >= 0; ++c)
        gradient4[4 * static_cast<std::size_t>(pair.node[k]) + c] += static_cast<float>(pair.weight[k] * force[c]);
  }
  return energy;
}

// The stiffness of friction is the slope of its force along the way that a pair is about to slide at its present speed.
void SelfContact::addStiffness(const double* positions4, std::vector<StiffnessCoupling>& couplings) const {
  const double smooth = policy_.wall_sliding_speed * lead_, onset = policy_.wall_onset;
  for (const Pair& pair : pairs_) {
    const double s = pair.normal.dot(awayAt(pair, positions4)) / pair.thickness;
    const double normal =
        pair.stiffness / (pair.thickness * pair.thickness) * squeeze(s, pair.straight_below, onset).curvature;
    if (normal == 0 && pair.friction == 0) continue;
    const double drag = pair.friction * sliding(pair.speed * lead_, smooth).per_way;
    // The normal has the stiffness of the bar, both tangents that of friction: drag (I - n n^T) + normal n n^T.
    const Eigen::Vector3d& n = pair.normal;
    const Eigen::Matrix3d k = drag * Eigen::Matrix3d::Identity() + (normal - drag) * n * n.transpose();
    couplings.push_back({{pair.node[0], pair.node[1], pair.node[2], pair.node[3], -1, -1},
                         {static_cast<float>(pair.weight[0]), static_cast<float>(pair.weight[1]),
                          static_cast<float>(pair.weight[2]), static_cast<float>(pair.weight[3])},
                         {static_cast<float>(k(0, 0)), static_cast<float>(k(0, 1)), static_cast<float>(k(0, 2)),
                          static_cast<float>(k(1, 1)), static_cast<float>(k(1, 2)), static_cast<float>(k(2, 2))}});
  }
}

// The difference of the two points of a pair, where they are now.
Eigen::Vector3d SelfContact::awayAt(const Pair& pair, const double* positions4) {
  Eigen::Vector3d away = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < 4; ++k)
    if (pair.node[k] >= 0) away += pair.weight[k] * nodeOf(positions4, pair.node[k]);
  return away;
}

Eigen::Vector3d SelfContact::slidSince(const Pair& pair, const Eigen::Vector3d& away) {
  const Eigen::Vector3d change = away - pair.away;
  return change - pair.normal.dot(change) * pair.normal;
}

}  // namespace vibe

// Which places of other walls act on a vertex, and with which share.
#include <algorithm>
#include <cmath>
#include <optional>

#include "geometry/triangle_distance.hpp"
#include "self_contact/self_contact.hpp"
#include "self_contact/self_contact_memory.hpp"

namespace vibe {

namespace {

// How much farther than another place in its direction a place still acts, in thicknesses. Design choice: far below the
// distance itself, far above what a step moves a wall that rests [1].
constexpr double kSharing = 0.1;
constexpr double kSame = 1 - 1e-9;  // ratio of two distances that are the same but for rounding

}  // namespace

// Of the two walls at the points that are nearest to each other.
double SelfContact::meanThickness(int vertex, int triangle, const Eigen::Vector3d& weight) const {
  const auto& n = rest_.triangles[triangle];
  return 0.5 * (thickness_[vertex] +
                (weight[0] * thickness_[n[0]] + weight[1] * thickness_[n[1]] + weight[2] * thickness_[n[2]]));
}

// Twice the area, along the normal [m^2].
Eigen::Vector3d SelfContact::areaVector(int triangle) const {
  const auto& n = rest_.triangles[triangle];
  const Eigen::Vector3d a = memory_->at(n[0]);
  return (memory_->at(n[1]) - a).cross(memory_->at(n[2]) - a);
}

// Their sum around a vertex [m^2].
Eigen::Vector3d SelfContact::ringVector(int vertex) const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  memory_->search.rings().visit(vertex, [&](int t) { sum += areaVector(t); });
  return sum;
}

// 1 where the angle between two area vectors is more than a right angle, 0 where they do not face each other.
double SelfContact::facing(const Eigen::Vector3d& one, const Eigen::Vector3d& other) {
  const double size = std::sqrt(one.squaredNorm() * other.squaredNorm());
  return size > 0 ? std::clamp(1 - one.dot(other) / (kFacingCosine * size), 0.0, 1.0) : 0;
}

// The triangles of a part of the list of what is near that may be as near as was asked for and face the vertex.
void SelfContact::collectApproaches(int vertex, std::size_t first, std::size_t next) {
  SelfContactMemory& m = *memory_;
  m.approaches.clear();
  const Eigen::Vector3d p = m.at(vertex);
  const double farthest = searchDistance();
  std::optional<Eigen::Vector3d> own;
  for (std::size_t k = first; k < next; ++k) {
    const SelfContactSearch::Near& near = m.search.near()[k];
    if (m.search.leastDistance(near) > farthest) continue;
    if (!own) own = ringVector(vertex);
    const double faces = facing(*own, areaVector(near.triangle));
    if (faces == 0) continue;
    const auto& n = rest_.triangles[near.triangle];
    const TriangleFoot foot = triangleFoot(p, m.at(n[0]), m.at(n[1]), m.at(n[2]));
    m.approaches.push_back({near.triangle, foot.away, foot.away.norm(), foot.weight, faces, 0});
  }
}

// Whether contact of a vertex may act there in the step.
bool SelfContact::isInReach(int vertex, const WallApproach& approach) const {
  return approach.distance < (1 + kContactOnset) * meanThickness(vertex, approach.triangle, approach.weight) + reach_;
}

// In a valley two triangles may be equally near. If the nearest one alone acted, it would push the vertex to where the
// other one is nearer, and the step after it back: places that are nearly as near share. The more their directions
// differ, the less they share; at a right angle each acts as if it were alone. Each place acts once, and as the vertex
// moves its share is continuous, so that walls that touch come to rest.
void SelfContact::addPairsOf(int vertex) {
  SelfContactMemory& m = *memory_;
  m.sharing.clear();
  listReached(vertex);
  for (WallApproach* one : m.reached) {
    const double behind = farBehind(*one) / (kSharing * thickness_[vertex]);
    if (!(behind < 1) || !isPlace(*one)) continue;
    one->share = (1 - behind) * (1 - behind);
    m.sharing.push_back(one);
  }
  for (WallApproach* one : m.sharing) one->share *= partBesides(*one);
  for (const WallApproach* one : m.sharing) {
    double sum = one->share;
    for (const WallApproach* other : m.sharing)
      if (other != one) sum += other->faces * other->share * alike(*one, *other);
    if (sum > 0) addPair(vertex, one->triangle, one->faces * one->share / sum);
  }
}

// The triangles that the vertex may touch in the step, the nearest first.
void SelfContact::listReached(int vertex) {
  std::vector<WallApproach*>& reached = memory_->reached;
  reached.clear();
  for (WallApproach& one : memory_->approaches) {
    if (!isInReach(vertex, one)) continue;
    auto at = reached.end();
    while (at != reached.begin() && (*(at - 1))->distance > one.distance) --at;
    reached.insert(at, &one);
  }
}

// How much farther it is than another place in its direction, as far as that one faces the vertex [m].
double SelfContact::farBehind(const WallApproach& one) const {
  double most = 0;
  for (const WallApproach* other : memory_->reached) {
    if (other == &one) break;
    most = std::max(most, other->faces * alike(one, *other) * (one.distance - other->distance));
  }
  return most;
}

// Cosine between the directions, 0 beyond a right angle.
double SelfContact::alike(const WallApproach& one, const WallApproach& other) {
  const double size = one.distance * other.distance;
  return size > 0 ? std::clamp(one.away.dot(other.away) / size, 0.0, 1.0) : 1;
}

// Whether no triangle beside it is nearer; of feet at one place the first counts.
bool SelfContact::isPlace(const WallApproach& approach) const {
  if ((approach.weight.array() > 0).all()) return true;
  for (const WallApproach& other : memory_->approaches) {
    if (&other == &approach) continue;
    bool has_foot = true;
    for (Eigen::Index k = 0; k < 3; ++k)
      if (approach.weight[k] > 0)
        has_foot = has_foot && hasVertex(rest_.triangles[other.triangle], rest_.triangles[approach.triangle][k]);
    if (has_foot && (other.distance < kSame * approach.distance ||
                     (kSame * other.distance < approach.distance && &other < &approach)))
      return false;
  }
  return true;
}

// In a valley the foot in one side reaches the edge while that in the other side, which is nearer there, is still away
// from it: how far the foot is from that edge, over the sum of both, so that it goes over into the other side.
double SelfContact::partBesides(const WallApproach& approach) const {
  const auto& n = rest_.triangles[approach.triangle];
  double least = 1;
  for (const WallApproach* other : memory_->reached)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto& t = rest_.triangles[other->triangle];
      if (other == &approach || !hasVertex(t, n[(k + 1) % 3]) || !hasVertex(t, n[(k + 2) % 3])) continue;
      double beside = 0;  // weight of the corner that is not on the edge
      for (std::size_t l = 0; l < 3; ++l)
        if (t[l] != n[(k + 1) % 3] && t[l] != n[(k + 2) % 3]) beside = other->weight[static_cast<Eigen::Index>(l)];
      const double own = approach.weight[static_cast<Eigen::Index>(k)];
      if (own > 0) least = std::min(least, own / (own + other->faces * beside));
    }
  return least;
}

// The triangles that a vertex faces: where walls are close, one of the vertices there is not far.
void SelfContact::collectFacing(int vertex) {
  SelfContactMemory& m = *memory_;
  for (const WallApproach& one : m.approaches) {
    if (one.distance < close_distance_) m.facing.push_back({vertex, one.triangle});
  }
}

}  // namespace vibe

// Which spots of other walls act on a vertex, and with which share.
#include <algorithm>
#include <cmath>
#include <optional>

#include "geometry/triangle_distance.hpp"
#include "self_contact/self_contact.hpp"
#include "self_contact/self_contact_memory.hpp"

namespace vibe {

namespace {

constexpr double kSame = 1 - 1e-9;  // ratio of two distances that are the same but for rounding

}  // namespace

// Mean thickness of the two walls at the points that are nearest to each other [m].
double SelfContact::meanThickness(int vertex, int triangle, const Eigen::Vector3d& weight) const {
  const auto& n = rest_.triangles[triangle];
  return 0.5 * (thickness_[vertex] +
                (weight[0] * thickness_[n[0]] + weight[1] * thickness_[n[1]] + weight[2] * thickness_[n[2]]));
}

// Twice the area of a triangle, along its normal [m^2].
Eigen::Vector3d SelfContact::areaVector(int triangle) const {
  const auto& n = rest_.triangles[triangle];
  const Eigen::Vector3d a = memory_->at(n[0]);
  return (memory_->at(n[1]) - a).cross(memory_->at(n[2]) - a);
}

// Sum of the area vectors around a vertex [m^2].
Eigen::Vector3d SelfContact::ringVector(int vertex) const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  memory_->search.rings().visit(vertex, [&](int t) { sum += areaVector(t); });
  return sum;
}

// 1 where the angle between two area vectors is more than a right angle, 0 where they do not face each other.
double SelfContact::facing(const Eigen::Vector3d& one, const Eigen::Vector3d& other) {
  const double size = std::sqrt(one.squaredNorm() * other.squaredNorm());
  return size > 0 ? std::clamp(1 - one.dot(other) / (facingCosine() * size), 0.0, 1.0) : 0;
}

// Collects the triangles of a part of the list of what is near that may be as near as was asked for and face the
// vertex.
void SelfContact::collectApproaches(int vertex, std::size_t first, std::size_t next) {
  SelfContactMemory& m = *memory_;
  m.approaches.clear();
  const Eigen::Vector3d p = m.at(vertex);
  const double farthest = searchDistance();
  std::optional<Eigen::Vector3d> own;  // of the vertex: most have no triangle that is near enough, and need none
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
  return approach.distance <
         (1 + policy_.wall_onset) * meanThickness(vertex, approach.triangle, approach.weight) + reach_;
}

// In a valley two triangles may be equally near. If the nearest one alone acted, it would push the vertex to where the
// other one is nearer, and the step after it back: spots that are nearly as near share. The more their directions
// differ, the less they share; at a right angle each acts as if it were alone. Each spot acts once, and as the vertex
// moves its share is continuous, so that walls that touch come to rest.
void SelfContact::addPairsOf(int vertex) {
  SelfContactMemory& m = *memory_;
  m.sharing.clear();
  listReached(vertex);
  // A spot that is farther than another one in its direction fades, smoothly in value and slope.
  for (WallApproach* one : m.reached) {
    const double behind = farBehind(*one) / (policy_.wall_sharing * thickness_[vertex]);
    if (!(behind < 1) || !isSpot(*one)) continue;
    one->share = (1 - behind) * (1 - behind);
    m.sharing.push_back(one);
  }
  for (WallApproach* one : m.sharing) one->share *= shareAcrossEdge(*one);
  // Spots in one direction divide the bar among them.
  for (const WallApproach* one : m.sharing) {
    double sum = one->share;
    for (const WallApproach* other : m.sharing)
      if (other != one) sum += other->faces * other->share * alike(*one, *other);
    if (sum > 0) addPair(vertex, one->triangle, one->faces * one->share / sum);
  }
}

// Lists the triangles that the vertex may touch in the step, the nearest first.
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

// How much farther a spot is than another one in its direction, as far as that one faces the vertex [m].
double SelfContact::farBehind(const WallApproach& one) const {
  double most = 0;
  for (const WallApproach* other : memory_->reached) {
    if (other == &one) break;
    most = std::max(most, other->faces * alike(one, *other) * (one.distance - other->distance));
  }
  return most;
}

// Cosine between the directions of two spots, 0 beyond a right angle.
double SelfContact::alike(const WallApproach& one, const WallApproach& other) {
  const double size = one.distance * other.distance;
  return size > 0 ? std::clamp(one.away.dot(other.away) / size, 0.0, 1.0) : 1;
}

// Whether the nearest point of a triangle is a local minimum of the distance: no triangle that shares the point is
// nearer. Of several feet at one point the first counts.
bool SelfContact::isSpot(const WallApproach& approach) const {
  // A foot inside the triangle belongs to no other one.
  if ((approach.weight.array() > 0).all()) return true;
  for (const WallApproach& other : memory_->approaches) {
    if (&other == &approach) continue;
    // The other triangle has the foot if it has all corners that the foot is a mean of.
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

// In a valley the foot in one side reaches the common edge while that in the other side, which is nearer there, is
// still away from it: the share would jump. So it is the distance of the foot from that edge, over the sum of both
// distances, and goes over into the other side as the foot reaches the edge. Distances are barycentric weights of the
// corner that is not on the edge.
double SelfContact::shareAcrossEdge(const WallApproach& approach) const {
  const auto& n = rest_.triangles[approach.triangle];
  double least = 1;
  for (const WallApproach* other : memory_->reached)
    for (std::size_t k = 0; k < 3; ++k) {
      // The edge opposite to corner k is common to both triangles where the other one has its two ends.
      const auto& t = rest_.triangles[other->triangle];
      if (other == &approach || !hasVertex(t, n[(k + 1) % 3]) || !hasVertex(t, n[(k + 2) % 3])) continue;
      double beyond = 0;  // weight of the other triangle's third corner
      for (std::size_t l = 0; l < 3; ++l)
        if (t[l] != n[(k + 1) % 3] && t[l] != n[(k + 2) % 3]) beyond = other->weight[static_cast<Eigen::Index>(l)];
      const double own = approach.weight[static_cast<Eigen::Index>(k)];
      // A foot on the edge itself is that of both, and isSpot() has decided which of them counts.
      if (own > 0) least = std::min(least, own / (own + other->faces * beyond));
    }
  return least;
}

// Collects the triangles that a vertex faces: where walls are close, one of the vertices there is not far.
void SelfContact::collectFacing(int vertex) {
  SelfContactMemory& m = *memory_;
  for (const WallApproach& one : m.approaches) {
    if (one.distance < close_distance_) m.facing.push_back({vertex, one.triangle});
  }
}

}  // namespace vibe

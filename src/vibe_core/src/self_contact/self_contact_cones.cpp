// The cones of SelfContactBounds.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "self_contact/self_contact_bounds.hpp"

namespace vibe {

namespace self_contact {

constexpr std::size_t kGroup = SelfContactBounds::kConeGroup;
using Group = Eigen::Array<float, kGroup, 1>;

struct Vectors {
  Group x, y, z;
  Vectors operator-(const Vectors& b) const { return {x - b.x, y - b.y, z - b.z}; }
  Vectors operator+(const Vectors& b) const { return {x + b.x, y + b.y, z + b.z}; }
  Group dot(const Vectors& b) const { return x * b.x + y * b.y + z * b.z; }
  Vectors cross(const Vectors& b) const { return {y * b.z - z * b.y, z * b.x - x * b.z, x * b.y - y * b.x}; }
};

}  // namespace self_contact

namespace {

using self_contact::Group;
using self_contact::kGroup;
using self_contact::Vectors;

// Rounding of a cosine in single precision: positions to 1e-8 m, edges of millimetres.
constexpr float kCosineRounding = 1e-5F;
// Geometry: a turn by an angle whose sine is at most kSteepest has a chord at most kChord times as long as that sine.
constexpr double kSteepest = 0.5, kChord = 1.04;

Group cosine(const Vectors& area, const Vectors& normal) {
  return area.dot(normal) / area.dot(area).sqrt();
}

/// Four values per vertex, as a group of triangles reads them.
void pack(const SelfContactBounds::NodeVectors& x, std::vector<float>& packed) {
  for (std::size_t i = 0; 4 * i < packed.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) packed[4 * i + k] = static_cast<float>(x[k][i]);
}

}  // namespace

/// Edges of a group of triangles from their first corners, and the products of the edges: twice the area vectors.
struct SelfContactBounds::Area {
  self_contact::Vectors ab, ac, product;
};

SelfContactBounds::Area SelfContactBounds::areaOf(std::size_t first, const std::vector<float>& at) const {
  std::array<Vectors, 3> corner;
  for (std::size_t i = 0; i < kGroup; ++i) {
    const auto& t = triangles_[std::min(first + i, triangles_.size() - 1)];
    for (std::size_t c = 0; c < 3; ++c) {
      const float* p = &at[4 * static_cast<std::size_t>(t[c])];
      corner[c].x[i] = p[0];
      corner[c].y[i] = p[1];
      corner[c].z[i] = p[2];
    }
  }
  Area area{corner[1] - corner[0], corner[2] - corner[0], {}};
  area.product = area.ab.cross(area.ac);
  return area;
}

// Afterwards no normal leaves its cone while no vertex moves by more than cone_safe_move_.
void SelfContactBounds::adaptCones(const NodeVectors& start, const NodeVectors& end) {
  const bool path = start != end;
  pack(end, end_);
  if (path) pack(start, start_);
  for (std::size_t k = 0; k < 3; ++k) std::copy(end[k], end[k] + radius_.size(), checked_[k].begin());
  any_wide_cone_ = false;
  Group safe = Group::Constant(std::numeric_limits<float>::infinity());
  float safe_of_turned = std::numeric_limits<float>::infinity();
  for (std::size_t first = 0; first < triangles_.size(); first += kGroup) {
    const auto load = [first](const std::vector<float>& values) { return Eigen::Map<const Group>(&values[first]); };
    const Vectors normal{load(normal_[0]), load(normal_[1]), load(normal_[2])};
    // The least cosine of the three control vectors with the axis says whether the cone holds on the whole way.
    const Area to = areaOf(first, end_);
    const Group last = cosine(to.product, normal);
    Group least = last;
    if (path) {
      const Area from = areaOf(first, start_);
      least = least.min(cosine(from.product, normal)).min(cosine(from.ab.cross(to.ac) + to.ab.cross(from.ac), normal));
    }
    // The height over the longest edge turns what the normal may still turn into a move of the vertices.
    const Vectors bc = to.ac - to.ab;
    const Group longest = to.ab.dot(to.ab).max(to.ac.dot(to.ac)).max(bc.dot(bc));
    const Group height = (to.product.dot(to.product) / longest).sqrt();
    const Group rest = load(turn_) - (2 - 2 * last + kCosineRounding).max(0).sqrt();
    const Group spare = height * rest.min(static_cast<float>(kSteepest)) / static_cast<float>(2 * kChord);
    const auto held = least >= load(cosine_);
    safe = held.select(safe.min(spare), safe);
    // Cones that fail are few; they are made one by one in double precision.
    if (held.all()) continue;
    const std::size_t count = std::min(kGroup, triangles_.size() - first);
    for (std::size_t i = 0; i < count; ++i)
      if (!(least[i] >= cosine_[first + i]))
        safe_of_turned = std::min(safe_of_turned, turnCone(static_cast<int>(first + i), start, end) * height[i]);
  }
  cone_safe_move_ = std::max(0.0F, std::min(safe.minCoeff(), safe_of_turned));
}

// @returns how far its vertices may move then, in heights
float SelfContactBounds::turnCone(int triangle, const NodeVectors& start, const NodeVectors& end) {
  const auto& t = triangles_[triangle];
  const Eigen::Vector3d a = vectorOf(start, t[0]), d = vectorOf(end, t[0]);
  const Eigen::Vector3d ab = vectorOf(start, t[1]) - a, ac = vectorOf(start, t[2]) - a, de = vectorOf(end, t[1]) - d,
                        df = vectorOf(end, t[2]) - d;
  const Eigen::Vector3d from = ab.cross(ac).normalized(), to = de.cross(df).normalized(),
                        middle = (ab.cross(df) + de.cross(ac)).normalized();
  // The axis halves the angle between start and end; the control vector between them may lie beside.
  const Eigen::Vector3d normal = (from + to).normalized();
  const double chord = std::sqrt(
      std::max({(from - normal).squaredNorm(), (to - normal).squaredNorm(), (middle - normal).squaredNorm()}));
  // Half a usual width is left around what is known, so that the cone lasts.
  const double usual = loose_cone_[triangle] != 0 ? policy_.cone_loose_turn : policy_.cone_turn;
  const bool any = !(chord + 0.5 * usual < 1) || !(normal.squaredNorm() > 0.5);
  const double turn = any ? 2 : std::max(usual, chord + 0.5 * usual);
  cone_[triangle] = {normal.cast<float>(), static_cast<float>(turn)};
  for (int k = 0; k < 3; ++k) normal_[k][triangle] = static_cast<float>(normal[k]);
  turn_[triangle] = static_cast<float>(turn);
  cosine_[triangle] = static_cast<float>(1 - 0.5 * turn * turn) + kCosineRounding;
  // A cone that had to be wide is made anew in the next step: a cosine of 2 never holds.
  if (turn > policy_.cone_too_wide * usual) {
    any_wide_cone_ = true;
    cosine_[triangle] = 2;
  }
  turned_.push_back(triangle);
  const double rest = std::min(kSteepest, turn - (to - normal).norm());
  return any ? std::numeric_limits<float>::max() : static_cast<float>(rest / (2 * kChord));
}

}  // namespace vibe

#include "geometry/suture_ends.hpp"

#include <cmath>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include "vibe_graphics/geometry/solid_bodies.hpp"
#include "vibe_graphics/geometry/tube.hpp"

namespace vibe::graphics {

namespace {

using Eigen::Vector3d;

constexpr double kSamePlace = 1e-9;  // [m]

Vector3d unitOr(const Vector3d& v, const Vector3d& otherwise) {
  const double length = v.norm();
  return length > kSamePlace ? Vector3d(v / length) : otherwise;
}

/// Of the thread where a piece begins or ends; zero if it has no length.
Vector3d beginning(const ThreadPiece& piece) {
  for (const Vector3d& point : piece.line)
    if ((point - piece.line.front()).norm() > kSamePlace) return (point - piece.line.front()).normalized();
  return Vector3d::Zero();
}

Vector3d ending(const ThreadPiece& piece) {
  for (auto point = piece.line.rbegin(); point != piece.line.rend(); ++point)
    if ((piece.line.back() - *point).norm() > kSamePlace) return (piece.line.back() - *point).normalized();
  return Vector3d::Zero();
}

/// The whole way from the first bite to the last; z where they coincide.
Vector3d wholeWay(const SutureSet& set) {
  return set.bites.empty() ? Vector3d::UnitZ()
                           : unitOr(set.bites.back().place - set.bites.front().place, Vector3d::UnitZ());
}

}  // namespace

Vector3d planeNormal(const SutureSet& set) {
  if (set.bites.empty()) return Vector3d::UnitX();
  Vector3d middle = Vector3d::Zero();
  for (const SutureBite& bite : set.bites) middle += bite.place;
  middle /= static_cast<double>(set.bites.size());
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const SutureBite& bite : set.bites) spread += (bite.place - middle) * (bite.place - middle).transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(spread);
  if (!(solver.eigenvalues()[1] > kSamePlace * kSamePlace)) return anyNormal(wholeWay(set));
  return solver.eigenvectors().col(0).normalized();
}

Vector3d biteAxis(const SutureSet& set, std::size_t bite) {
  if (bite < set.bites.size() && set.bites[bite].inward.norm() > 0.5) return set.bites[bite].inward.normalized();
  Vector3d sum = Vector3d::Zero();
  if (bite > 0 && bite <= set.pieces.size()) sum += ending(set.pieces[bite - 1]);
  if (bite < set.pieces.size()) sum += beginning(set.pieces[bite]);
  if (sum.norm() < 1e-3 && bite < set.pieces.size()) sum = beginning(set.pieces[bite]);
  return unitOr(sum, wholeWay(set));
}

Vector3d tagAxis(const SutureSet& set) {
  const Vector3d thread = set.pieces.empty() ? wholeWay(set) : unitOr(ending(set.pieces.back()), wholeWay(set));
  return unitOr(planeNormal(set).cross(thread), anyNormal(thread)).normalized();
}

Vector3d cinchAxis(const SutureSet& set) {
  return set.pieces.empty() ? wholeWay(set) : unitOr(beginning(set.pieces.front()), wholeWay(set));
}

namespace {

using Eigen::Vector3d;

// Sizes of the implants of a suturing device; design choices close to commercial devices.
constexpr double kTagLength = 6.5e-3, kTagRadius = 0.45e-3;
constexpr double kCinchLength = 6e-3, kCinchRadius = 1.3e-3;
constexpr int kImplantSides = 20;

constexpr PackedColour kSteel = packed(0.80, 0.82, 0.85, kMetal);
constexpr PackedColour kPolymer = packed(0.93, 0.89, 0.76), kBore = packed(0.10, 0.09, 0.08);

// Position along the axis and radius, as parts of length and radius. Two equal points make a sharp edge.
constexpr double kPin[][2] = {{0.50, 0.0},  {0.485, 0.30}, {0.30, 0.97},  {0.27, 1.0},   {0.08, 1.0},  {0.08, 1.0},
                              {0.07, 0.72}, {0.07, 0.72},  {-0.07, 0.72}, {-0.07, 0.72}, {-0.08, 1.0}, {-0.08, 1.0},
                              {-0.47, 1.0}, {-0.47, 1.0},  {-0.50, 0.66}, {-0.50, 0.66}, {-0.50, 0.0}};
constexpr double kSleeve[][2] = {
    {0.40, 0.26},  {0.47, 0.26},  {0.50, 0.34},  {0.50, 0.34},  {0.50, 0.62},  {0.50, 0.62},  {0.46, 0.74},
    {0.46, 0.74},  {0.26, 0.74},  {0.26, 0.74},  {0.26, 0.92},  {0.26, 0.92},  {0.24, 1.0},   {0.24, 1.0},
    {0.06, 1.0},   {0.06, 1.0},   {0.04, 0.92},  {0.04, 0.92},  {0.04, 0.74},  {0.04, 0.74},  {-0.46, 0.74},
    {-0.46, 0.74}, {-0.50, 0.62}, {-0.50, 0.62}, {-0.50, 0.34}, {-0.50, 0.34}, {-0.47, 0.26}, {-0.40, 0.26}};

template <std::size_t Count>
std::vector<ProfilePoint> scaled(const double (&outline)[Count][2], double length, double radius) {
  std::vector<ProfilePoint> profile;
  for (const auto& point : outline) profile.emplace_back(length * point[0], radius * point[1]);
  return profile;
}

/// Into the lumen at a bite, across an axis; any direction across it where the lumen is not known.
Vector3d offWall(const SutureSet& set, bool last, const Vector3d& axis) {
  Vector3d inward = Vector3d::Zero();
  if (!set.bites.empty()) inward = last ? set.bites.back().inward : set.bites.front().inward;
  const Vector3d off = inward - inward.dot(axis) * axis;
  return off.norm() > 0.1 ? Vector3d(off.normalized()) : anyNormal(axis);
}

}  // namespace

void appendTag(const SutureSet& set, double size, const HeldThread& thread, ColouredShape& shape) {
  const double length = kTagLength * std::sqrt(size), radius = kTagRadius * size;
  const Vector3d axis = tagAxis(set), off = offWall(set, true, axis), centre = set.t_tag + 0.6 * radius * off;
  appendRevolved(scaled(kPin, length, radius), centre, axis, kSteel, kImplantSides, shape);
  const double winding = std::max(thread.radius, 0.25 * radius);
  for (const double at : {-0.035, 0.035})
    appendRing(centre + at * length * axis, axis, 0.72 * radius + 0.4 * winding, winding, thread.colour, kImplantSides,
               shape);
  appendBall(centre + (0.9 * radius + winding) * off, 1.5 * winding, thread.colour, kThreadSides, shape);  // the knot
}

void appendCinch(const SutureSet& set, double size, const HeldThread& thread, ColouredShape& shape) {
  const double length = kCinchLength * std::sqrt(size), radius = kCinchRadius * size;
  const Vector3d axis = cinchAxis(set), off = offWall(set, false, axis), centre = set.cinch + 0.4 * radius * off;
  appendRevolved(scaled(kSleeve, length, radius), centre, axis, kPolymer, kImplantSides, shape);
  for (const double end : {0.44, -0.44}) {
    const Vector3d out = end > 0 ? axis : Vector3d(-axis);
    appendRevolved({{std::abs(end) * length, 0}, {std::abs(end) * length, 0.27 * radius}}, centre, out, kBore,
                   kImplantSides, shape);
  }
  const Vector3d tip = centre - 0.5 * length * axis;
  appendTube({centre - 0.4 * length * axis, tip, tip - 0.2 * length * axis + 0.05 * length * off,
              tip - 0.4 * length * axis + 0.18 * length * off},
             thread.radius, thread.colour, kThreadSides, shape);
}

}  // namespace vibe::graphics

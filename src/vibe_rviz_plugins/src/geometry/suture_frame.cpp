#include "geometry/suture_frame.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include "vibe_rviz_plugins/geometry/tube.hpp"

namespace vibe::rviz_plugins {
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

}  // namespace vibe::rviz_plugins

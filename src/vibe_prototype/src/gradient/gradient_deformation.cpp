#include "gradient/gradient_deformation.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <queue>
#include <string>
#include <utility>

#include "vibe_core/program/error.hpp"

namespace vibe::prototype {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr int kMaxTurns = 100;
constexpr int kExtractions = 6;     // Newton steps to a rotation; three are usual
constexpr double kFarTurn = 0.5;    // [rad], limit of one step
constexpr double kSameTurn = 1e-7;  // [rad]

/// The rotation r nearest to a matrix a, which maximises r : a, starting from a rotation near it. Newton's method on
/// small rotations w from the left: gradient sum_k r_k x a_k over the columns, minus Hessian tr(s) - s, s = sym(a r^T).
/// Unlike a polar decomposition it also works for flat neighbourhoods of a surface, where a has rank two.
Matrix3d rotationOf(const Matrix3d& a, Matrix3d r) {
  for (int i = 0; i < kExtractions; ++i) {
    const Vector3d gradient = r.col(0).cross(a.col(0)) + r.col(1).cross(a.col(1)) + r.col(2).cross(a.col(2));
    const Matrix3d product = a * r.transpose();
    const double trace = product.trace();
    const Matrix3d hessian = trace * Matrix3d::Identity() - 0.5 * (product + product.transpose());
    const double size = std::abs(trace) + 1e-300;
    // far from the rotation the Hessian is not usable; its trace is an upper bound
    const bool useful = hessian.determinant() > 1e-6 * size * size * size && trace > 0;
    Vector3d turn = useful ? Vector3d(hessian.inverse() * gradient) : Vector3d(gradient / (2 * size));
    const double angle = turn.norm();
    if (!(angle > kSameTurn)) break;
    if (angle > kFarTurn) turn *= kFarTurn / angle;
    r = Eigen::Quaterniond(1, turn.x() / 2, turn.y() / 2, turn.z() / 2).normalized().toRotationMatrix() * r;
  }
  return r;
}

/// Rotation of the best-fitting rigid motion: a is the sum of (after) (before)^T about the means (Kabsch 1976).
Matrix3d fittedRotation(const Matrix3d& a) {
  const Eigen::JacobiSVD<Matrix3d> svd(a, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Matrix3d sign = Matrix3d::Identity();
  sign(2, 2) = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1 : 1;
  return svd.matrixU() * sign * svd.matrixV().transpose();
}

}  // namespace

std::vector<int> patchAround(const SurfaceView& shape, const std::vector<int>& seeds, double radius) {
  // neighbours along edges, each twice: those of node n from first[n] to first[n + 1]
  std::vector<int> first(shape.x.size() + 2, 0), neighbours(6 * shape.triangles.size());
  for (const auto& t : shape.triangles)
    for (const int node : t) first[node + 2] += 2;
  std::partial_sum(first.begin(), first.end(), first.begin());
  for (const auto& t : shape.triangles)
    for (int k = 0; k < 3; ++k)
      for (const int other : {1, 2}) neighbours[first[t[k] + 1]++] = t[(k + other) % 3];
  std::vector<double> way(shape.x.size(), std::numeric_limits<double>::infinity());
  using Entry = std::pair<double, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  for (const int seed : seeds) {
    if (seed < 0 || seed >= static_cast<int>(way.size())) return {};
    way[seed] = 0;
    open.emplace(0, seed);
  }
  while (!open.empty()) {
    const auto [length, node] = open.top();
    open.pop();
    if (length > way[node]) continue;
    for (int k = first[node]; k < first[node + 1]; ++k) {
      const int next = neighbours[k];
      const double longer = length + (shape.position(next) - shape.position(node)).norm();
      if (!(longer <= radius && longer < way[next])) continue;
      way[next] = longer;
      open.emplace(longer, next);
    }
  }
  std::vector<int> patch;
  for (std::size_t n = 0; n < way.size(); ++n)
    if (way[n] <= radius) patch.push_back(static_cast<int>(n));
  return patch;
}

GradientDeformation::GradientDeformation(const SurfaceView& shape, std::vector<int> patch,
                                         const std::vector<int>& handles, int turns)
    : turns_(turns), patch_(std::move(patch)), place_(shape.x.size(), -1) {
  if (turns < 0 || turns > kMaxTurns)
    throw Error("gradient deformation: " + std::to_string(turns) + " turns are not from 0 to 100; give 2.");
  for (std::size_t i = 0; i < patch_.size(); ++i) {
    if (patch_[i] < 0 || patch_[i] >= static_cast<int>(shape.x.size()))
      throw Error("gradient deformation: node " + std::to_string(patch_[i]) + " of the patch is not in the surface.");
    place_[patch_[i]] = static_cast<int>(i);
    start_.push_back(shape.position(patch_[i]));
  }
  sides_.resize(patch_.size());
  outer_.assign(patch_.size(), 0);
  for (const auto& t : shape.triangles) addTriangle(t);
  for (std::size_t i = 0; i < patch_.size(); ++i) {
    for (Side& side : sides_[i]) side.arm = side.weight * (start_[i] - start_[side.to]);
    if (outer_[i] != 0) rim_.push_back(patch_[i]);
  }
  rotation_.resize(patch_.size());
  setHandles(handles);
}

void GradientDeformation::addTriangle(const std::array<int, 3>& t) {
  const int place[3] = {place_[t[0]], place_[t[1]], place_[t[2]]};
  if (place[0] < 0 || place[1] < 0 || place[2] < 0) {
    for (const int p : place)
      if (p >= 0) outer_[p] = 1;
    return;
  }
  for (int k = 0; k < 3; ++k) {
    const int a = place[(k + 1) % 3], b = place[(k + 2) % 3];
    const Vector3d u = start_[a] - start_[place[k]], v = start_[b] - start_[place[k]];
    const double weight = 0.5 * u.dot(v) / u.cross(v).norm();
    if (!std::isfinite(weight))
      throw Error("gradient deformation: the triangle at node " + std::to_string(t[k]) + " has no area.");
    for (const auto& [from, to] : {std::pair{a, b}, {b, a}}) {
      auto& list = sides_[from];
      const auto same = std::find_if(list.begin(), list.end(), [to = to](const Side& side) { return side.to == to; });
      if (same == list.end())
        list.push_back({to, weight, Vector3d::Zero()});
      else
        same->weight += weight;
    }
  }
}

void GradientDeformation::setHandles(const std::vector<int>& handles) {
  handles_.clear();
  unknown_.assign(patch_.size(), 0);
  for (std::size_t i = 0; i < patch_.size(); ++i)
    if (outer_[i] != 0) unknown_[i] = -1;
  for (const int node : handles) {
    const int place = node >= 0 && node < static_cast<int>(place_.size()) ? place_[node] : -1;
    if (place < 0)
      throw Error("gradient deformation: handle " + std::to_string(node) + " is not in the patch; enlarge the patch.");
    handles_.push_back(place);
    unknown_[place] = -1;
  }
  held_.clear();
  int rows = 0;
  for (std::size_t i = 0; i < patch_.size(); ++i) {
    if (unknown_[i] < 0)
      held_.push_back(static_cast<int>(i));
    else
      unknown_[i] = rows++;
  }
  if (held_.empty()) throw Error("gradient deformation: neither a rim nor a handle holds the patch; give a handle.");
  right_.resize(rows, 3);
  permuted_.resize(rows, 3);
  factor();
}

void GradientDeformation::factor() {
  const auto rows = right_.rows();
  if (rows == 0) return;
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t i = 0; i < patch_.size(); ++i) {
    if (unknown_[i] < 0) continue;
    for (const Side& side : sides_[i]) {
      entries.emplace_back(unknown_[i], unknown_[i], side.weight);
      if (unknown_[side.to] >= 0) entries.emplace_back(unknown_[i], unknown_[side.to], -side.weight);
    }
  }
  Eigen::SparseMatrix<double> matrix(rows, rows);
  matrix.setFromTriplets(entries.begin(), entries.end());
  factor_.compute(matrix);
  const Eigen::VectorXd diagonal = factor_.vectorD();
  inverse_diagonal_ = diagonal.cwiseInverse();
  if (factor_.info() != Eigen::Success || !(diagonal.array() > 1e-12).all())
    throw Error("gradient deformation: a part of the patch is connected to no rim and no handle; give it a handle.");
}

/// Moves held nodes to their targets, and the rest and all rotations as if the whole patch moved rigidly.
void GradientDeformation::placeHeld(const std::vector<Vector3d>& targets, std::vector<Vector3d>& positions) {
  positions = start_;
  for (std::size_t h = 0; h < handles_.size(); ++h) positions[handles_[h]] = targets[h];
  Vector3d before = Vector3d::Zero(), after = Vector3d::Zero();
  for (const int place : held_) before += start_[place], after += positions[place];
  before /= static_cast<double>(held_.size()), after /= static_cast<double>(held_.size());
  Matrix3d sum = Matrix3d::Zero();
  for (const int place : held_) sum += (positions[place] - after) * (start_[place] - before).transpose();
  std::fill(rotation_.begin(), rotation_.end(), fittedRotation(sum));
}

void GradientDeformation::improveRotations(const std::vector<Vector3d>& positions) {
  for (std::size_t i = 0; i < patch_.size(); ++i) {
    Matrix3d sum = Matrix3d::Zero();
    for (const Side& side : sides_[i]) sum.noalias() += (positions[i] - positions[side.to]) * side.arm.transpose();
    rotation_[i] = rotationOf(sum, rotation_[i]);
  }
}

void GradientDeformation::solve(std::vector<Vector3d>& positions) {
  if (right_.rows() == 0) return;
  for (std::size_t i = 0; i < patch_.size(); ++i) {
    if (unknown_[i] < 0) continue;
    Vector3d sum = Vector3d::Zero();
    for (const Side& side : sides_[i]) {
      sum += 0.5 * ((rotation_[i] + rotation_[side.to]) * side.arm);
      if (unknown_[side.to] < 0) sum += side.weight * positions[side.to];
    }
    right_.row(unknown_[i]) = sum;
  }
  // the same as factor_.solve(), but without allocation
  permuted_.noalias() = factor_.permutationP() * right_;
  factor_.matrixL().solveInPlace(permuted_);
  permuted_.array().colwise() *= inverse_diagonal_.array();
  factor_.matrixU().solveInPlace(permuted_);
  right_.noalias() = factor_.permutationPinv() * permuted_;
  for (std::size_t i = 0; i < patch_.size(); ++i)
    if (unknown_[i] >= 0) positions[i] = right_.row(unknown_[i]);
}

void GradientDeformation::deform(const std::vector<Vector3d>& targets, std::vector<Vector3d>& positions) {
  if (targets.size() != handles_.size())
    throw Error("gradient deformation: " + std::to_string(targets.size()) + " targets for " +
                std::to_string(handles_.size()) + " handles; give one for each.");
  placeHeld(targets, positions);
  solve(positions);
  for (int turn = 0; turn < turns_; ++turn) {
    improveRotations(positions);
    solve(positions);
  }
}

}  // namespace vibe::prototype

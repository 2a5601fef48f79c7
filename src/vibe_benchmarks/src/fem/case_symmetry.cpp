#include "fem/case_symmetry.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

#include "fem/static_path.hpp"

namespace vibe::benchmarks {
namespace {

constexpr double kSmallLoad = 0.01;   // of the first level
constexpr std::size_t kPairs = 300;   // nodes whose mirror images are compared, at most
constexpr double kSameShape = 0.005;  // distance of a mirror image from the body, by the body's size
// Odd part of the displacement: of a symmetric answer to a small load, with what an uneven mesh adds (cinched plate
// with diagonals in one direction: 0.02), and of one that has buckled (a mode has grown to a tenth of the
// displacement).
constexpr double kEven = 0.03, kBroken = 0.1;

Eigen::Vector3d displacementOf(const CaseModel& model, const NodeMean& mean, const MotionView& motion) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < mean.node.size(); ++i)
    for (int k = 0; k < 3; ++k)
      sum[k] += mean.weight[i] * (motion.x[k][mean.node[i]] - model.mesh().nodes[mean.node[i]][k]);
  return sum;
}

double norm(const std::vector<Eigen::Vector3d>& field) {
  double sum = 0;
  for (const Eigen::Vector3d& v : field) sum += v.squaredNorm();
  return std::sqrt(sum);
}

}  // namespace

CaseSymmetry::CaseSymmetry(const CaseModel& model) : model_(model) {
  const std::vector<char> fixed = model.body(0).fixed;
  floats_ = std::all_of(fixed.begin(), fixed.end(), [](char f) { return f == 0; });
  const StaticRun& run = *model.benchCase().statics;
  const auto first = std::find_if(run.levels.begin(), run.levels.end(), [](double level) { return level != 0; });
  if (first == run.levels.end()) return;
  for (int axis = 0; axis < 3; ++axis) pairs_[static_cast<std::size_t>(axis)] = pairsAcross(axis);
  StaticPath path(model, run.tolerance);
  path.advanceTo(kSmallLoad * *first, 1);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Parts parts = partsOf(axis, path.motion());
    has_[axis] = parts.odd < kEven * parts.all;
    least_ = std::max(least_, parts.all);
  }
}

std::vector<CaseSymmetry::Pair> CaseSymmetry::pairsAcross(int axis) const {
  const auto& nodes = model_.mesh().nodes;
  Eigen::Vector3d low = nodes[0], high = nodes[0];
  for (const Eigen::Vector3d& x : nodes) low = low.cwiseMin(x), high = high.cwiseMax(x);
  std::vector<Pair> pairs;
  const std::size_t stride = (nodes.size() + kPairs - 1) / kPairs;
  for (std::size_t n = 0; n < nodes.size(); n += stride) {
    Eigen::Vector3d image = nodes[n];
    image[axis] = low[axis] + high[axis] - image[axis];
    pairs.push_back({static_cast<int>(n), model_.at(image)});
    Eigen::Vector3d there = Eigen::Vector3d::Zero();
    const NodeMean& mean = pairs.back().image;
    for (std::size_t i = 0; i < mean.node.size(); ++i) there += mean.weight[i] * nodes[mean.node[i]];
    if ((there - image).norm() > kSameShape * (high - low).norm()) return {};
  }
  return pairs;
}

void CaseSymmetry::removeRigidMotion(const std::vector<Pair>& pairs, Field& field) const {
  if (!floats_ || pairs.empty()) return;
  const auto count = static_cast<double>(pairs.size());
  Eigen::Vector3d middle = Eigen::Vector3d::Zero(), shift = middle, moment = middle;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    middle += model_.mesh().nodes[pairs[i].node] / count;
    shift += field[i] / count;
  }
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const Eigen::Vector3d arm = model_.mesh().nodes[pairs[i].node] - middle;
    moment += arm.cross(field[i]);
    inertia += arm.squaredNorm() * Eigen::Matrix3d::Identity() - arm * arm.transpose();
  }
  const Eigen::Vector3d turn = inertia.completeOrthogonalDecomposition().solve(moment);
  for (std::size_t i = 0; i < pairs.size(); ++i)
    field[i] -= shift + turn.cross(Eigen::Vector3d(model_.mesh().nodes[pairs[i].node] - middle));
}

CaseSymmetry::Parts CaseSymmetry::partsOf(std::size_t axis, const MotionView& motion) const {
  const std::vector<Pair>& pairs = pairs_[axis];
  Field odd, all;
  for (const Pair& pair : pairs) {
    const Eigen::Vector3d here = displacementOf(model_, {{pair.node}, {1.0}}, motion);
    Eigen::Vector3d there = displacementOf(model_, pair.image, motion);
    there[static_cast<Eigen::Index>(axis)] *= -1;
    all.push_back(here);
    odd.push_back((here - there) / 2);
  }
  removeRigidMotion(pairs, all);
  removeRigidMotion(pairs, odd);
  return {norm(odd), norm(all)};
}

bool CaseSymmetry::known() const {
  return std::any_of(has_.begin(), has_.end(), [](bool has) { return has; });
}

std::optional<std::size_t> CaseSymmetry::lost(const MotionView& motion) const {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!has_[axis]) continue;
    const Parts parts = partsOf(axis, motion);
    if (parts.odd > kBroken * std::max(parts.all, least_)) return axis;
  }
  return std::nullopt;
}

}  // namespace vibe::benchmarks

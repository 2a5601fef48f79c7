#include "suture/chain_newton.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace vibe::detail {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr int kMaxIterations = 20;
/// Newton's method has converged when nodes move by less than this fraction of a link; a further step would be
/// rounding.
constexpr double kConverged = 1e-9;
/// Tolerance of the link lengths relative to those that follow from their tensions.
constexpr double kNearEnough = 1e-4;

class ChainNewton {
 public:
  ChainNewton(const HangingThreadModel& model, const ThreadEnds& ends, double h, HangingThread& state,
              HangingThreadScratch& scratch)
      : model_(model),
        state_(state),
        scratch_(scratch),
        first_(ends.first_held ? 1 : 0),
        last_(ends.last_held ? model.links - 1 : model.links),
        inertia_((1 + h * model.drag) / (h * h)),
        compliance_(model.linkLength() / model.axial_stiffness) {}

  /// One iteration. @return  the largest move of a node [m]
  double iterate() {
    evaluate();
    eliminate();
    return substituteBack();
  }

  double largestError() {
    evaluate();
    double largest = 0;
    for (const auto& link : scratch_.link) largest = std::max(largest, std::abs(link.error));
    return largest;
  }

 private:
  bool isFree(int node) const { return node >= first_ && node <= last_; }

  /// Evaluates directions, length errors, geometric stiffness and residual forces.
  void evaluate() {
    const double l = model_.linkLength();
    for (int j = 0; j <= model_.links; ++j)
      scratch_.force.col(j) = inertia_ * model_.nodeMass(j) * (scratch_.target.col(j) - state_.position.col(j));
    for (int k = 0; k < model_.links; ++k) {
      auto& link = scratch_.link[k];
      const Vector3d r = state_.position.col(k + 1) - state_.position.col(k);
      const double now = r.norm();
      if (now > 1e-6 * l)
        link.direction = r / now;
      else
        link.direction = Vector3d::Unit(k % 3);  // two nodes coincide: any direction is valid
      link.error = now - l - compliance_ * state_.tension[k];
      const double pull = std::max(0.0, state_.tension[k]) / std::max(now, 1e-3 * l);
      link.across = pull * (Matrix3d::Identity() - link.direction * link.direction.transpose());
      scratch_.force.col(k) += state_.tension[k] * link.direction;
      scratch_.force.col(k + 1) -= state_.tension[k] * link.direction;
    }
  }

  Matrix3d ownStiffness(int node) const {
    Matrix3d own = inertia_ * model_.nodeMass(node) * Matrix3d::Identity();
    if (node > 0) own += scratch_.link[node - 1].across;
    if (node < model_.links) own += scratch_.link[node].across;
    return own;
  }

  /// Block elimination node by node; each node passes its Schur complement to the next.
  void eliminate() {
    Matrix3d schur = ownStiffness(0);
    Vector3d right = scratch_.force.col(0);
    for (int k = 0; k < model_.links; ++k) {
      auto& link = scratch_.link[k];
      link.right = right;
      schur = schur.llt().solve(Matrix3d::Identity());
      if (!isFree(k)) schur.setZero();
      link.root = schur;
      const Vector3d along = schur * link.direction;
      link.pivot = -compliance_ - link.direction.dot(along);
      link.coupling = link.direction - link.across * along;
      link.rest = -link.error + along.dot(right);
      const Vector3d back = schur * right;
      schur = ownStiffness(k + 1) - link.across * schur * link.across -
              link.coupling * link.coupling.transpose() / link.pivot;
      right = scratch_.force.col(k + 1) + link.across * back - link.coupling * (link.rest / link.pivot);
    }
    const bool free = isFree(model_.links);
    scratch_.move.col(model_.links) = free ? Vector3d(schur.llt().solve(right)) : Vector3d::Zero();
  }

  double substituteBack() {
    double largest = scratch_.move.col(model_.links).cwiseAbs().maxCoeff();
    for (int k = model_.links - 1; k >= 0; --k) {
      const auto& link = scratch_.link[k];
      const Vector3d next = scratch_.move.col(k + 1);
      scratch_.tension_change[k] = (link.rest - link.coupling.dot(next)) / link.pivot;
      const Vector3d right = link.right + link.direction * scratch_.tension_change[k] + link.across * next;
      scratch_.move.col(k) = link.root * right;
      largest = std::max(largest, scratch_.move.col(k).cwiseAbs().maxCoeff());
    }
    state_.position += scratch_.move;
    state_.tension += scratch_.tension_change;
    return largest;
  }

  const HangingThreadModel& model_;
  HangingThread& state_;
  HangingThreadScratch& scratch_;
  const int first_, last_;   ///< free nodes
  const double inertia_;     ///< [1/s^2]
  const double compliance_;  ///< of a link [m/N]
};

}  // namespace

void fitScratch(int links, HangingThreadScratch& scratch) {
  scratch.link.resize(links);
  scratch.target.resize(3, links + 1);
  scratch.move.resize(3, links + 1);
  scratch.force.resize(3, links + 1);
  scratch.tension_change.resize(links);
}

bool settleChain(const HangingThreadModel& model, const ThreadEnds& ends, double h, HangingThread& state,
                 HangingThreadScratch& scratch) {
  ChainNewton newton(model, ends, h, state, scratch);
  for (int i = 0; i < kMaxIterations; ++i)
    if (newton.iterate() <= kConverged * model.linkLength()) return true;
  // Links in compression and folds converge slowly: accept an approximate solution; the next step continues from it.
  return newton.largestError() <= kNearEnough * model.linkLength();
}

}  // namespace vibe::detail

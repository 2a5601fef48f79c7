#include "fem/mode_solver.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>

#include "vibe_core/common/error.hpp"
#include "vibe_core/sparse/factor.hpp"

namespace vibe::benchmarks {
namespace {

constexpr int kMaxIterations = 200;

Eigen::VectorXd massVector(const ElasticBody& body) {
  Eigen::VectorXd mass(3 * body.nodeCount());
  for (int n = 0; n < body.nodeCount(); ++n) mass.segment<3>(3 * n).setConstant(body.fixed[n] != 0 ? 0 : body.mass[n]);
  return mass;
}

/// Deterministic start vectors without symmetry.
Eigen::MatrixXd startVectors(Eigen::Index rows, Eigen::Index columns) {
  Eigen::MatrixXd start(rows, columns);
  unsigned state = 12345;
  for (Eigen::Index i = 0; i < start.size(); ++i) {
    state = state * 1664525U + 1013904223U;
    start.data()[i] = (state >> 8) / 16777216.0 - 0.5;
  }
  return start;
}

double largestNode(const Eigen::VectorXd& shape) {
  double max = 0;
  for (Eigen::Index n = 0; n < shape.size(); n += 3) max = std::max(max, shape.segment<3>(n).norm());
  return max;
}

}  // namespace

Modes slowestModes(const ElasticBody& body, int count) {
  const Eigen::Index rows = 3 * body.nodeCount(), width = count + 8;
  const auto pattern =
      std::make_shared<const BlockPattern>(blockPattern(body.nodeCount(), body.elements->nodeGroups()));
  BlockMatrix stiffness(pattern);
  const std::vector<double> rest(static_cast<std::size_t>(rows), 0.0);
  body.elements->addStiffness(rest.data(), stiffness);
  for (int n = 0; n < body.nodeCount(); ++n)
    if (body.fixed[n] != 0) stiffness.fix(n);
  Factor factor(makeFactorPlan(*pattern), FactorStorage::Double);
  if (!factor.compute(stiffness)) throw Error("modes: the body can move without strain; clamp a set of nodes.");

  const Eigen::VectorXd mass = massVector(body);
  Eigen::MatrixXd shapes = startVectors(rows, width), loads(rows, width), next(rows, width), forces(rows, width);
  Eigen::VectorXd last = Eigen::VectorXd::Zero(width), squares = last;
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    loads = mass.asDiagonal() * shapes;
    for (Eigen::Index c = 0; c < width; ++c) factor.solve(loads.col(c).data(), next.col(c).data());
    // the projected problem: next^T K next = next^T loads
    const Eigen::MatrixXd k = next.transpose() * loads, m = next.transpose() * (mass.asDiagonal() * next);
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> small(0.5 * (k + k.transpose()), m);
    squares = small.eigenvalues();
    shapes = next * small.eigenvectors();
    const double change = ((squares - last).head(count).array() / squares.head(count).array()).abs().maxCoeff();
    last = squares;
    if (change < 1e-9) break;
  }
  Modes modes;
  modes.shape.resize(rows, count);
  for (int c = 0; c < count; ++c) {
    modes.frequency.push_back(std::sqrt(squares[c]) / (2 * std::acos(-1.0)));
    modes.shape.col(c) = shapes.col(c) / largestNode(shapes.col(c));
  }
  return modes;
}

}  // namespace vibe::benchmarks

#include "fem/vibration.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

#include "vibe_core/program/error.hpp"
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

Oscillation measureOscillation(const std::vector<double>& values, double step) {
  std::vector<double> crossings;  // upwards, in steps
  for (std::size_t i = 1; i < values.size(); ++i)
    if (values[i - 1] < 0 && values[i] >= 0)
      crossings.push_back(static_cast<double>(i - 1) + values[i - 1] / (values[i - 1] - values[i]));
  Oscillation found{std::nan(""), std::nan("")};
  if (crossings.size() < 2) return found;
  const auto periods = static_cast<double>(crossings.size() - 1);
  found.frequency = periods / ((crossings.back() - crossings.front()) * step);
  // half the range of each period, which is independent of an offset
  std::vector<double> amplitude;
  for (std::size_t p = 0; p + 1 < crossings.size(); ++p) {
    const auto first = values.begin() + static_cast<std::ptrdiff_t>(crossings[p]);
    const auto last = values.begin() + static_cast<std::ptrdiff_t>(crossings[p + 1]) + 1;
    amplitude.push_back(*std::max_element(first, last) - *std::min_element(first, last));
  }
  if (amplitude.size() > 1)
    found.kept = std::pow(amplitude.back() / amplitude.front(), 1 / static_cast<double>(amplitude.size() - 1));
  return found;
}

}  // namespace vibe::benchmarks

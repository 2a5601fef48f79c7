#include "fem/tangent_guess.hpp"

#include "vibe_core/common/error.hpp"

namespace vibe::benchmarks {

TangentGuess::TangentGuess(const ElasticBody& body)
    : pattern_(std::make_shared<const BlockPattern>(blockPattern(body.nodeCount(), body.elements->nodeGroups()))),
      stiffness_(pattern_),
      factor_(makeFactorPlan(*pattern_), FactorStorage::Double) {}

void TangentGuess::move(const ElasticBody& body, const std::vector<std::pair<int, Eigen::Vector3d>>& places,
                        MotionView motion) {
  if (places.empty()) return;
  const std::size_t rows = 3 * body.rest.size();
  std::vector<double> displacement(rows), step(rows, 0.0), load(rows), answer(rows);
  for (std::size_t n = 0; n < body.rest.size(); ++n)
    for (int k = 0; k < 3; ++k) displacement[3 * n + k] = motion.x[k][n] - body.rest[n][k];
  for (const auto& place : places)
    for (int k = 0; k < 3; ++k) step[3 * place.first + k] = place.second[k] - motion.x[k][place.first];
  stiffness_.setZero();
  body.elements->addStiffness(displacement.data(), stiffness_);
  for (int n = 0; !body.foundation.empty() && n < body.nodeCount(); ++n)
    stiffness_.add(n, n, body.foundation[n] * Eigen::Matrix3d::Identity());
  stiffness_.multiply(step.data(), load.data());
  for (int n = 0; n < body.nodeCount(); ++n) {
    const bool fixed = body.fixed[n] != 0;
    for (int k = 0; k < 3; ++k) load[3 * n + k] = fixed ? step[3 * n + k] : -load[3 * n + k];
    if (fixed) stiffness_.fix(n);
  }
  if (!factor_.compute(stiffness_)) throw Error("static: the body can move without strain; clamp or hold more nodes.");
  factor_.solve(load.data(), answer.data());
  for (std::size_t n = 0; n < body.rest.size(); ++n)
    for (int k = 0; k < 3; ++k) motion.x[k][n] += answer[3 * n + k];
  for (const auto& place : places)
    for (int k = 0; k < 3; ++k) motion.x[k][place.first] = place.second[k];
}

}  // namespace vibe::benchmarks

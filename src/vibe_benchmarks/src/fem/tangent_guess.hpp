#pragma once
#include <Eigen/Core>
#include <memory>
#include <utility>
#include <vector>

#include "vibe_core/solver/elastic_body.hpp"
#include "vibe_core/sparse/factor.hpp"

namespace vibe::benchmarks {

/// Moves prescribed fixed nodes to new positions and all other nodes according to the tangent stiffness, so that a
/// solve starts near the equilibrium and not with one layer of crushed elements.
class TangentGuess {
 public:
  explicit TangentGuess(const ElasticBody& body);

  /// @param places  target positions of fixed nodes [m]
  void move(const ElasticBody& body, const std::vector<std::pair<int, Eigen::Vector3d>>& places, MotionView motion);

 private:
  std::shared_ptr<const BlockPattern> pattern_;
  BlockMatrix stiffness_;
  Factor factor_;
};

}  // namespace vibe::benchmarks

#pragma once
#include <Eigen/Core>
#include <memory>
#include <utility>
#include <vector>

#include "solver/elastic_body.hpp"
#include "sparse/factor.hpp"

namespace vibe {

/// Moves prescribed fixed nodes to new places and everything else along by the tangent stiffness, so that a solve
/// begins near the equilibrium and not with one layer of crushed elements.
class TangentGuess {
 public:
  explicit TangentGuess(const ElasticBody& body);

  /// @param places  where fixed nodes go [m]
  void move(const ElasticBody& body, const std::vector<std::pair<int, Eigen::Vector3d>>& places, MotionView motion);

 private:
  std::shared_ptr<const BlockPattern> pattern_;
  BlockMatrix stiffness_;
  Factor factor_;
};

}  // namespace vibe

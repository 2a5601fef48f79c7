#pragma once
#include <Eigen/Geometry>
#include <vector>

#include "vibe_core/contact/tool_crossings.hpp"
#include "vibe_core/contact/wall_crossings.hpp"
#include "vibe_core/model/model.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe::benchmarks {

/// Looks for walls and tools that pass through each other, with none of the solver's own contact.
class ContactCheck {
 public:
  explicit ContactCheck(const Model& model);

  /// Pairs of triangles without common vertex that intersect.
  const std::vector<WallCrossings::Pair>& wall(const State& state);

  /// The tool in the wall, without the open ends and what the helix holds.
  ToolCrossing tool(const State& state);

 private:
  const Model& model_;
  WallCrossings wall_;
  std::vector<char> open_, passes_;
  std::vector<Eigen::Isometry3d> poses_;
};

}  // namespace vibe::benchmarks

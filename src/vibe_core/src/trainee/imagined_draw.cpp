#include "trainee/imagined_draw.hpp"

#include <algorithm>
#include <cmath>

#include "trainee/device_geometry.hpp"

namespace vibe {

namespace {

constexpr double kPatch = 5e-3;  // radius of what the helix holds, which moves as one [m]

// Displacement of a membrane around a point load, over that of the load.
double following(double distance, double none) {
  return std::clamp(std::log(none / std::max(distance, kPatch)) / std::log(none / kPatch), 0.0, 1.0);
}

}  // namespace

std::optional<NeedleView> imagineNeedle(const Model& model, const Observation& seen, const ImaginedDraw& draw) {
  const auto& triangles = model.organ.surface.triangles;
  const Eigen::Vector3d held = positionOf(draw.held, triangles, seen.wall);
  const Eigen::Vector3d outward = outwardAt(draw.held, triangles, seen.wall);
  Observation imagined = seen;
  imagined.tip_turn = draw.turn;
  imagined.tip = held + kHelixDepth * outward - draw.turn * helixInTip(draw.from);
  const Eigen::Vector3d pull = draw.turn * Eigen::Vector3d(draw.drawn - draw.from, 0, 0);
  for (Eigen::Vector3d& p : imagined.wall) p += following((p - held).norm(), draw.follows) * pull;
  return lookAtNeedle(model, imagined);
}

}  // namespace vibe

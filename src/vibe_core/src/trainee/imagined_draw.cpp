#include "trainee/imagined_draw.hpp"

#include <cmath>

#include "common/elementary.hpp"
#include "trainee/device_geometry.hpp"

namespace vibe {

namespace {

constexpr double kPatch = 5e-3;  // radius of what the helix holds, which moves as one [m]

// Displacement of a membrane around a point load, over that of the load; squares of lengths, in a loop over the wall.
double following(double distance2, double none2) {
  if (distance2 >= none2) return 0;
  if (distance2 <= kPatch * kPatch) return 1;
  return math::log(none2 / distance2) / math::log(none2 / (kPatch * kPatch));
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
  const double none2 = draw.follows * draw.follows;
  for (Eigen::Vector3d& p : imagined.wall) p += following((p - held).squaredNorm(), none2) * pull;
  return lookAtNeedle(model, imagined);
}

}  // namespace vibe

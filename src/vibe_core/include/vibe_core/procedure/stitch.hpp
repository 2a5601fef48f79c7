#pragma once

#include <Eigen/Core>

#include "vibe_core/geometry/surface_mesh.hpp"
#include "vibe_core/model/model.hpp"
#include "vibe_core/solver/body_loads.hpp"
#include "vibe_core/state/procedure_state.hpp"

namespace vibe {

/// A bite at a point of the wall: a disc of the wall at rest around it, each of whose particles has the share of the
/// disc that is its own (discWeights()). The thread thus pulls evenly on a piece of wall of given size and feels its
/// mean motion, whatever mesh the wall has. Degenerate discs at the rim of an open wall are smaller.
/// @param wall    present positions
/// @param point   on `triangle` [m]
/// @param radius  of the disc at rest [m]
Bite biteAround(const Model& model, const SurfaceView& wall, int triangle, const Eigen::Vector3d& point, double radius);

/// The particle of the bite with the largest weight; -1 without particles.
int nearestParticle(const Bite& bite);

/// Shortest length of a segment, which the solver keeps between bites that have met. Drawing more out of a segment
/// would have no effect [m].
constexpr double kMinSegment = kMinThread;

/// Draws thread out of a set: out of the segment at the cinch until it is as short as kMinSegment, then out of the
/// next.
/// @param amount  [m]
/// @return amount drawn; less than `amount` if every segment is as short as it can be [m]
double drawThread(double amount, Suture& suture);

/// Tension at the cinch: the maximum over the segments from the cinch to the first one whose bites have not met (which
/// is longer than kMinSegment). The tissue cannot stretch a segment between bites that touch, so the tension of such a
/// segment alone does not show how hard the thread is drawn [N].
double cinchTension(const Suture& suture);

}  // namespace vibe

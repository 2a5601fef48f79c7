#pragma once
#include <Eigen/Geometry>
#include <memory>
#include <vector>

#include "vibe_core/events/event.hpp"
#include "vibe_core/model/model.hpp"
#include "vibe_core/state/state.hpp"
#include "vibe_core/thermal/argon_beam.hpp"
#include "vibe_core/thermal/mark_zones.hpp"
#include "vibe_core/thermal/thermal_dose.hpp"

namespace vibe {

class MarkingTouch;

/// Memory for marking in the scenes that have it. Carries nothing from one step to the next.
class MarkingScratch {
 public:
  /// @param model  with scene.marking and a tool; must outlive this
  explicit MarkingScratch(const Model& model);
  ~MarkingScratch();
  MarkingScratch(const MarkingScratch&) = delete;
  MarkingScratch& operator=(const MarkingScratch&) = delete;

  ArgonBeam beam;
  MarkFinder finder;
  std::vector<Burn> burns;
  const std::vector<BeamShare> no_beam;      ///< what the wall gets while the pedal is up
  std::vector<std::vector<int>> neighbours;  ///< (particles)
  std::unique_ptr<MarkingTouch> touch;       ///< null unless the wall gives way in the gradient domain
};

/// What a step is to the argon beam.
struct BeamStep {
  bool pedal = false;       ///< down
  bool went_down = false;   ///< in this step
  double insufflation = 0;  ///< gas that came in, at ambient pressure [m^3/s]
};

/// After the tissue has moved: the beam heats what is in front of the probe while the pedal is down, and what is warm
/// cools whether it is or not, also where the tissue sleeps. A pedal that goes down with no tissue in reach is refused
/// once; the beam then acts as soon as it comes to tissue.
///
/// Events: one when a mark, a burn scar or a deep burn begins, which is where no neighbour of a particle has that grade
/// yet; as it grows, like a line that is drawn, it says no more. What is marked is told by the grades of all particles.
/// @param link_poses  of the tool's links in world at the end of the step
void updateMarking(const Model& model, const std::vector<Eigen::Isometry3d>& link_poses, const BeamStep& step,
                   State& state, MarkingScratch& scratch, std::vector<Event>& events);

/// Puts back what marking holds when the tissue starts again from rest: it is cold, and marks stay.
void coolDown(State& state);

}  // namespace vibe

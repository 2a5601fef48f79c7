#pragma once
#include <Eigen/Geometry>
#include <memory>
#include <vector>

#include "vibe_core/events/event.hpp"
#include "vibe_core/model/model.hpp"
#include "vibe_core/procedure/procedure_registry.hpp"
#include "vibe_core/state/state.hpp"
#include "vibe_core/thermal/argon_beam.hpp"
#include "vibe_core/thermal/mark_zones.hpp"
#include "vibe_core/thermal/thermal_dose.hpp"

namespace vibe {

/// Scratch memory for marking. Carries nothing from one step to the next.
class MarkingScratch {
 public:
  /// @param model  with scene.marking and a tool; must outlive this
  explicit MarkingScratch(const Model& model);
  MarkingScratch(const MarkingScratch&) = delete;
  MarkingScratch& operator=(const MarkingScratch&) = delete;

  ArgonBeam beam;
  MarkFinder finder;
  std::vector<Burn> burns;
  const std::vector<BeamShare> no_beam;             ///< the power on the wall while the pedal is up: none
  std::vector<std::vector<int>> neighbours;         ///< (particles)
  std::unique_ptr<MarkingDeformation> deformation;  ///< null: the solver alone moves the wall
};

/// What the argon beam needs to know about a step.
struct BeamStep {
  bool pedal = false;       ///< the pedal is down
  bool went_down = false;   ///< it went down in this step
  double insufflation = 0;  ///< gas that flowed in, at ambient pressure [m^3/s]
};

/// Call after the tissue has moved. While the pedal is down, the beam heats the tissue in front of the probe. Warm
/// tissue cools in every step, also while the tissue is at rest. If no tissue is in reach when the pedal goes down, the
/// command is rejected once; the beam acts as soon as it reaches tissue.
///
/// Events: one when a mark, a burn scar or a deep burn begins, that is, when a particle reaches that grade and none of
/// its neighbours has it yet. Growth of the same zone, such as a line that is drawn, causes no event. The grades of all
/// particles are in the state.
/// @param link_poses  of the tool's links in world at the end of the step
void updateMarking(const Model& model, const std::vector<Eigen::Isometry3d>& link_poses, const BeamStep& step,
                   State& state, MarkingScratch& scratch, EventLog log);

/// Resets the heat when the tissue starts again from rest. Marks stay.
void coolDown(State& state);

}  // namespace vibe

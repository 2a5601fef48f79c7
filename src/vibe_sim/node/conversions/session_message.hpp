#pragma once

#include <string>
#include <vector>

#include <sensor_msgs/PointCloud2.h>
#include <std_msgs/String.h>
#include <vibe_msgs/SessionInfo.h>
#include <vibe_msgs/StageTime.h>
#include <vibe_msgs/StateSnapshot.h>
#include <vibe_msgs/StepResult.h>
#include <vibe_msgs/StepTiming.h>

#include "simulation/timed_simulation.hpp"
#include "vibe_core/model/tissue_solver.hpp"
#include "vibe_core/trainee/observation.hpp"

namespace vibe::sim {

/// The scene as a scene file that builds the same model anywhere: absolute paths, the seed in use.
std_msgs::String makeSceneText(const Scene& scene, std::uint64_t seed);

/// Durations in ms.
vibe_msgs::StageTime makeStageTime(const std::string& name, const DurationHistogram& durations);

/// Stages and counts of a step, into the fields of the message that have them.
void setWork(const StepReport& report, vibe_msgs::StepTiming& message);

/// What a session was made with.
vibe_msgs::SessionInfo makeSessionInfo(const TimedSimulation& simulation);

vibe_msgs::StateSnapshot makeStateSnapshot(const TimedSimulation& simulation);

/// @param whole  the state is the first of a session or a new one, so that its particles are published in any case
vibe_msgs::StepResult makeStepResult(const TimedSimulation& simulation, bool whole);

/// What a trainee perceives, without the wall: the bits of observe().
Observation readStepResult(const vibe_msgs::StepResult& message);

/// Positions of all points of a cloud with fields x, y, z of single precision [m].
/// @throws Error if it is another kind of cloud
std::vector<Eigen::Vector3d> readWall(const sensor_msgs::PointCloud2& cloud);

}  // namespace vibe::sim

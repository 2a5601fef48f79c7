#pragma once

#include <vector>

#include <sensor_msgs/PointCloud2.h>
#include <vibe_msgs/SessionInfo.h>
#include <vibe_msgs/StateSnapshot.h>
#include <vibe_msgs/StepResult.h>

#include "simulation/timed_simulation.hpp"
#include "vibe_core/trainee/observation.hpp"

namespace vibe::sim {

/// What a session was made with.
vibe_msgs::SessionInfo makeSessionInfo(const Session& session);

vibe_msgs::StateSnapshot makeStateSnapshot(const Session& session);

/// @param whole  the state is the first of a session or a new one, so that its particles are published in any case
vibe_msgs::StepResult makeStepResult(const Session& session, bool whole);

/// What a trainee perceives, without the wall: the bits of observe().
Observation readStepResult(const vibe_msgs::StepResult& message);

/// Positions of all points of a cloud with fields x, y, z of single precision [m].
/// @throws Error if it is another kind of cloud
std::vector<Eigen::Vector3d> readWall(const sensor_msgs::PointCloud2& cloud);

}  // namespace vibe::sim

#pragma once

#include <cstdint>
#include <vector>

#include <sensor_msgs/PointCloud2.h>
#include <vibe_msgs/OrganMotion.h>
#include <vibe_msgs/TissueTopology.h>

#include "vibe_core/model/model.hpp"
#include "vibe_core/simulation/wall_coverage.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe::sim {

/// The moving tissue as a point cloud that every ROS tool can read. Per particle, packed in 28 bytes:
///   x, y, z   FLOAT32  position [m]
///   strain    FLOAT32  mean in-plane stretch around the particle against rest, minus 1
///   id        UINT32   particle number
///   revision  UINT32   of the tissue/topology it belongs to
///   region    UINT8    vibe_msgs/TissueTopology REGION_*
/// With marks grade UINT8 and thermal_dose FLOAT32, with `inspection` first_seen FLOAT32 follow.
/// What does not move is filled once per model; update() writes the rest.
class ParticleCloud {
 public:
  /// @param start  its marks, or their absence, decide whether there are fields for them
  ParticleCloud(const Model& model, const State& start, std::uint32_t revision);

  /// @param coverage  what was seen; null: nothing, or nobody looks
  const sensor_msgs::PointCloud2& update(const Model& model, const State& state, std::int64_t stamp,
                                         const WallCoverage* coverage = nullptr);

 private:
  sensor_msgs::PointCloud2 message_;
  std::vector<float> strain_;
  bool with_marks_, with_seen_;

  void updateMarks(const ProcedureState& procedure);
  void updateSeen(const std::vector<float>& first_seen);
};

/// What moves the organ by itself.
vibe_msgs::OrganMotion makeOrganMotion(const Model& model, const State& state, std::int64_t stamp);

/// Triangles, rest shape and anatomy of the organ, and the surface to draw.
vibe_msgs::TissueTopology makeTopology(const Model& model, std::uint32_t revision, std::int64_t stamp);

}  // namespace vibe::sim

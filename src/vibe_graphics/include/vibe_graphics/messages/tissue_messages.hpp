#pragma once
#include <sensor_msgs/PointCloud2.h>
#include <vibe_msgs/TissueTopology.h>

#include <string>

#include "vibe_graphics/geometry/tissue_mesh.hpp"

namespace vibe::graphics {

// Messages may come from any source. The functions return an empty string and fill the result, or one sentence that
// says what is wrong with the message; then nothing is drawn from it.

/// Checks and reads a topology: numbers in range, weights and positions finite, arrays of matching lengths.
std::string readTopology(const vibe_msgs::TissueTopology& message, TissueMesh& mesh);

/// Checks and reads a frame of particles: fields by name and type, count and revision as the mesh has them,
/// positions finite. Reuses the memory of `frame`.
std::string readParticles(const sensor_msgs::PointCloud2& message, const TissueMesh& mesh, TissueFrame& frame);

}  // namespace vibe::graphics

#pragma once
#include <sensor_msgs/PointCloud2.h>
#include <vibe_msgs/TissueTopology.h>

#include <string>

#include "geometry/tissue_mesh.hpp"

namespace vibe {

// Messages come from anywhere: a bag, another program, a test. What is wrong with one is told in a sentence, and then
// nothing is drawn from it. An empty answer: it is right and the result is filled.

/// Checks and takes over a topology: numbers in range, weights and positions finite, arrays of matching lengths.
std::string readTopology(const vibe_msgs::TissueTopology& message, TissueMesh& mesh);

/// Checks and takes over a frame of particles: fields by name and type, count and revision as the mesh has them,
/// positions finite. Reuses the memory of `frame`.
std::string readParticles(const sensor_msgs::PointCloud2& message, const TissueMesh& mesh, TissueFrame& frame);

}  // namespace vibe

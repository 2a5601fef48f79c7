#pragma once
#include <sensor_msgs/PointCloud2.h>

#include "vibe_graphics/geometry/tissue_mesh.hpp"

namespace vibe::rviz_plugins {

/// What moves from one frame to the next.
enum class Motion { Nothing, Patch, Everything };

/// An organ to measure with: a closed egg of 3,618 particles and 7,232 triangles, 20 cm long.
/// @param subdivided  drawn with four times as many triangles, whose vertices follow one or two particles each
graphics::TissueMesh benchOrgan(bool subdivided);

/// The organ at frame number `frame` as the simulator sends it, in 32 bytes per particle. Everything breathes; a patch
/// of 5 % of the particles around one place bulges; strain changes where particles move.
sensor_msgs::PointCloud2 benchCloud(const graphics::TissueMesh& mesh, Motion motion, int frame);

}  // namespace vibe::rviz_plugins

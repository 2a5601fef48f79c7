#pragma once
#include "vibe_core/geometry/anatomy.hpp"
#include "vibe_core/geometry/surface_mesh.hpp"

namespace vibe {

/// Estimates the landmarks of a stomach from its shape alone, for a surface with x anterior, y to the patient's left
/// and z cranial. The fundus is the highest point and the pylorus the point farthest from it along the surface. The
/// shortest path on the surface between them runs along the lesser curvature and meets the oesophagus a third of the
/// way from the fundus. The incisura is the point where the rest of the path is farthest from its chord. On a real
/// stomach (BodyParts3D FMA7148) the points are within 3 cm of manually placed ones; check the result.
/// @param surface  closed, evenly meshed (see remeshSurface()): distances are measured along edges
/// @throws Error if the surface is too round to have a lesser curvature (oesophagus and pylorus within 2 cm)
Landmarks estimateLandmarks(const SurfaceMesh& surface);

}  // namespace vibe

#pragma once
#include "vibe_core/geometry/anatomy.hpp"
#include "vibe_core/geometry/surface_mesh.hpp"

namespace vibe {

/// Guesses the landmarks of a stomach from its shape alone, for a surface in our axes (x anterior, y to the patient's
/// left, z cranial): the fundus is the highest point, the pylorus the farthest from it along the surface; the shortest
/// path on the surface between them runs along the lesser curvature and meets the oesophagus a third of the way from
/// the fundus; the incisura is where the rest of the path is farthest from its chord.
/// On a real stomach (BodyParts3D FMA7148) the points are within 3 cm of those read off by eye; look at the result.
/// @param surface  closed, evenly meshed (see remeshSurface()): distances are measured along edges
/// @throws Error if the surface is so round that there is no lesser curvature (oesophagus and pylorus within 2 cm)
Landmarks estimateLandmarks(const SurfaceMesh& surface);

}  // namespace vibe

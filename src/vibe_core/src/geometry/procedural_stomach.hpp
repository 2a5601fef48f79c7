#pragma once
#include <Eigen/Core>

#include "geometry/remesh.hpp"
#include "geometry/stomach_knots.hpp"
#include "vibe_core/geometry/organ.hpp"
#include "vibe_core/geometry/surface_mesh.hpp"

namespace vibe {

/// Dome that closes a tube at the transition to a neighbouring organ.
struct TubeEnd {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();    ///< of the rim [m]
  Eigen::Vector3d outward = Eigen::Vector3d::UnitZ();  ///< unit vector along the tube, out of the organ
  double radius = 0;                                   ///< of the tube [m]
};

/// A stomach as a smooth closed surface, before remeshing.
struct StomachShape {
  SurfaceMesh surface;  ///< closed, oriented outwards, uneven [m]
  Projection project;   ///< the exact surface
  Landmarks landmarks;
  TubeEnd oesophagus;
  TubeEnd duodenum;
};

/// Makes a stomach of approximately this enclosed volume (within a percent; scale the final mesh to be exact). The
/// frame is x anterior, y left, z cranial, with the origin inside the body. The tubes keep their size, so that the
/// scope fits; everything else scales with the cube root of the volume. Proportions of `sthenic`: at 0.75 L about 200
/// mm long with a largest diameter of about 90 mm, within the range of fed stomachs measured by magnetic resonance
/// imaging (0.36 to 1.10 L, length 184 to 226 mm, largest diameter 65 to 102 mm). The greater curvature is more than
/// three times as long as the lesser (Gray's Anatomy 1918: four to five times).
/// @param volume 0.15e-3 to 4e-3 [m^3]
/// @param knots  see stomachKnots(), variedKnots()
/// @throws Error outside that range.
StomachShape makeStomachShape(double volume, const StomachKnots& knots);

}  // namespace vibe

#pragma once

#include <array>
#include <string>
#include <vector>

#include "vibe_core/geometry/organ.hpp"
#include "vibe_core/geometry/stomach_axis.hpp"
#include "vibe_core/geometry/surface_mesh.hpp"

namespace vibe {

/// The side of the stomach at an angle around its axis (see StomachAxis::angleAt). Each side covers a quarter.
Wall wallAtAngle(double angle);

/// Fills region and wall of an organ whose surface, ends, entry and landmarks are known:
///   cardia   within 2 cm of the gastro-oesophageal junction, and the oesophagus above it
///   fundus   higher than the junction
///   pylorus  the last 3 cm (at most half of the way from the incisura) and the duodenum behind it
///   antrum   beyond the incisura
///   body     everything else.
/// @throws Error if a landmark is farther than 4 cm from the surface (wrong frame or unit).
void labelStomach(Organ& organ);

/// Where the pylorus begins, between two landmarks along the axis [m].
double beginOfCanal(double incisura, double pylorus);

/// Thickness per vertex from the thickness per region, with gradual transitions over about 2 cm [m].
std::vector<double> thicknessFromRegions(const SurfaceMesh& mesh, const std::vector<Region>& region,
                                         const std::array<double, kRegionCount>& thickness);

/// Landmarks guessed from the shape of a surface alone, and how far they can be trusted.
struct LandmarkEstimate {
  Landmarks landmarks;
  /// 0 to 1: the least of several marks. All but one say how much the surface is like a stomach in our axes: it narrows
  /// towards its far end and is narrow there, it bends, its far end lies to the right of and below its highest point,
  /// and its bend lies in the frontal plane. Each is 0 where a sphere, a straight tube, a mirrored or a cut stomach is
  /// and 1 where stomachs are. The last is the share of six views of the surface, tilted by 20 degrees about each axis,
  /// in which every landmark is found within 3 cm of where it is found without (for an organ of 0.9 L, in proportion
  /// for others). It does not notice every wrong orientation: a stomach turned by a quarter about the left-right axis
  /// can look like another one.
  double confidence = 0;
  std::string doubt;               ///< what lowers it most: "it does not bend as a stomach does"
  double length = 0;               ///< of the axis [m]
  std::array<double, 4> spread{};  ///< largest distance between views: oesophagus, fundus, incisura, pylorus [m]
};

/// Below this a guess is not to be relied on. Design choice: four of the six views agree.
constexpr double kSureLandmarks = 0.6;

/// Estimates the landmarks of a stomach from its shape alone, for a surface with x anterior, y to the patient's left
/// and z cranial. The fundus is the highest point and the pylorus the point farthest from it along the surface. The
/// lesser curvature is the side of the organ's axis that lies to the right of its way from one to the other. The
/// oesophagus meets it where the dome of the fundus ends, a radius of the body below its apex, and the incisura is the
/// point of it beyond that is farthest from the straight line to the pylorus.
/// @param surface  closed, evenly meshed (see remeshSurface()): distances are measured along edges
/// @throws Error if the surface is nothing like a stomach: a mark of confidence is 0
LandmarkEstimate estimateLandmarks(const SurfaceMesh& surface);

}  // namespace vibe

#pragma once
#include <array>
#include <vector>

#include "vibe_core/geometry/organ.hpp"
#include "vibe_core/geometry/stomach_axis.hpp"

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

/// Thickness per vertex from the thickness per region, with gradual transitions over about 2 cm [m].
std::vector<double> thicknessFromRegions(const SurfaceMesh& mesh, const std::vector<Region>& region,
                                         const std::array<double, kRegionCount>& thickness);

}  // namespace vibe

#pragma once
#include <iosfwd>
#include <string>
#include <vector>

#include "vibe_core/scene/scene.hpp"

namespace vibe::benchmarks {

/// Force of one pull on one mesh.
struct RefinementRow {
  std::string grip;     ///< "helix" or "patch", the patch of the pull spring
  int particles = 0;    ///< of the organ
  int site = 0;         ///< number of the place
  int held = 0;         ///< particles
  double distance = 0;  ///< by which what is held has moved along the pull [m]
  double force = 0;     ///< along the pull, at rest [N]
};

/// Pulls the insufflated stomach inwards by 20 mm at places beside each other on the greater curvature of the body,
/// the same on every mesh, and waits until it rests. What differs between meshes of many particles is the error of the
/// mesh; what differs between sites of one mesh is how grip and mesh happen to meet.
/// @param sites  places, 3 mm apart
std::vector<RefinementRow> refineGrip(const Scene& scene, const std::vector<int>& particles, int sites,
                                      std::ostream& log);

void writeRefinement(const std::vector<RefinementRow>& rows, std::ostream& out);  ///< CSV

}  // namespace vibe::benchmarks

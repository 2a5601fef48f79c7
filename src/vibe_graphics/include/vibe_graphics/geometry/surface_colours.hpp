#pragma once
#include <vector>

#include "vibe_graphics/geometry/colour_map.hpp"
#include "vibe_graphics/geometry/mesh_index.hpp"
#include "vibe_graphics/geometry/tissue_mesh.hpp"

namespace vibe::graphics {

/// What the colour of tissue shows.
enum class Colouring { Tissue, Region, Wall, Strain, Heat, Thickness, Seen };

/// Regions and walls, in the order of their numbers in vibe_msgs/TissueTopology: colours that are distinct with any
/// colour vision deficiency (Okabe & Ito 2008).
const std::vector<PackedColour>& regionColours();
const std::vector<PackedColour>& wallColours();  ///< one per WALL_*, likewise
const std::vector<PackedColour>& seenColours();  ///< of what the lens has not seen, and of what it has

/// Colours of the vertices of an organ. Red, green and blue depend on the Colouring and are white for natural tissue;
/// alpha encodes the effect of heat as media/tissue.frag draws it: 255 none, 170 mark, 85 burn scar, 0 deep burn. Only
/// vertices of particles whose colour has changed are updated.
class SurfaceColours {
 public:
  explicit SurfaceColours(const TissueMesh& mesh);  ///< natural tissue, as if never heated; all white

  /// Takes effect with the next update.
  /// @param map  for the colourings with a number: strain, heat [J], thickness [m]
  void choose(Colouring colouring, const ColourMap& map);
  Colouring colouring() const { return colouring_; }  ///< as chosen last

  /// @return  the vertices that have changed
  VertexSpan update(const TissueFrame& frame);
  const std::vector<PackedColour>& colours() const { return colours_; }  ///< one per vertex, as of the last update()

 private:
  PackedColour particleColour(std::size_t particle, const TissueFrame& frame) const;
  PackedColour valueColour(const std::vector<float>& values, std::size_t particle) const;
  PackedColour blended(std::size_t vertex) const;

  Colouring colouring_ = Colouring::Tissue;
  ColourMap map_;
  std::vector<std::uint8_t> region_, wall_;
  std::vector<float> thickness_;
  std::vector<std::uint32_t> render_offsets_, render_particles_;
  std::vector<float> render_weights_;
  Incidence vertices_of_particle_;  // empty without a render surface

  std::vector<PackedColour> of_particle_, colours_;  // of the last frame
  std::vector<std::uint32_t> touched_;
  std::vector<std::uint8_t> mark_;
};

}  // namespace vibe::graphics

#pragma once

#include <optional>

#include "protocol/message_kind.hpp"
#include "vibe_graphics/geometry/argon_traces.hpp"
#include "vibe_graphics/geometry/mucosa_map.hpp"
#include "vibe_graphics/geometry/surface_colours.hpp"
#include "vibe_graphics/geometry/tissue_mesh.hpp"

namespace vibe::web {

/// What changes on the wall besides its place: folds, and what heat has done. The same models as in rviz and in the
/// images of endoscope_camera.
class WallLook {
 public:
  WallLook(const graphics::TissueMesh& mesh, const graphics::MucosaMap& map);

  /// Follows smoke and the age of marks. Call it for every state.
  void see(const graphics::TissueFrame& frame);
  float smoke() const { return static_cast<float>(smoke_.extinction()); }  ///< [1/m]

  /// Message Kind::Folds, if it differs from the last one: u8 kind, u8 0[3], u32 revision, u8 height[vertices], in
  /// units of graphics::kTallestFold / 255.
  std::optional<Bytes> folds(const graphics::TissueFrame& frame);

  /// Message Kind::Heat, if it differs from the last one: u8 kind, u8 0[3], u32 revision, u32 count, u32 vertex[count],
  /// u8 effect[count] as the alpha of graphics::SurfaceColours (all others 255), u8 browned[count] in units of 3/255.
  std::optional<Bytes> heat(const graphics::TissueFrame& frame);

 private:
  std::uint32_t revision_;
  graphics::FoldHeight fold_height_;
  graphics::SurfaceColours colours_;
  graphics::ScarAge scars_;
  graphics::Smoke smoke_;
  Bytes last_folds_, last_heat_;
};

}  // namespace vibe::web

#pragma once

#include <memory>
#include <string>

#include <OgreColourValue.h>

#include "vibe_graphics/geometry/argon_traces.hpp"
#include "vibe_graphics/geometry/deformable_surface.hpp"
#include "vibe_graphics/geometry/mucosa_map.hpp"
#include "vibe_graphics/geometry/mucosa_pattern.hpp"
#include "vibe_graphics/geometry/surface_colours.hpp"
#include "vibe_graphics/geometry/tissue_mesh.hpp"
#include "vibe_graphics/graphics/dynamic_mesh.hpp"

namespace Ogre {
class Pass;
class SceneManager;
class SceneNode;
}  // namespace Ogre

namespace rviz {
class PointCloud;
}

namespace vibe::graphics {

/// The smoke of one organ in a scene; its shaders see the sum over all organs. It is a setting of the scene, its
/// density of fog, because the light through it changes on everything that an endoscope sees, meshes of other displays
/// too. Fixed-function materials stay without fog.
class SceneSmoke {
 public:
  /// @param scene  must outlive this object
  explicit SceneSmoke(Ogre::SceneManager& scene) : scene_(scene) {}
  ~SceneSmoke() { set(0, 0); }
  SceneSmoke(const SceneSmoke&) = delete;
  SceneSmoke& operator=(const SceneSmoke&) = delete;

  /// @param extinction  of light, rounded to 1/256 [1/m]
  /// @param time        at which its wisps are seen [s]
  void set(double extinction, double time);

 private:
  Ogre::SceneManager& scene_;
  float extinction_ = 0;  // as it is part of the sum
};

/// How tissue is drawn.
struct TissueLook {
  bool surface = true;                             ///< the drawn surface of the organ
  Colouring colouring = Colouring::Tissue;         ///< what its colour shows
  std::string map = "viridis";                     ///< see ColourMap
  double min = 0, max = 1;                         ///< values at the ends of the map, in the unit of the colouring
  Ogre::ColourValue inside{0.86F, 0.47F, 0.42F};   ///< natural colour of the mucosa
  Ogre::ColourValue outside{0.84F, 0.62F, 0.56F};  ///< natural colour of the serosa
  double outside_alpha = 0.15;  ///< opacity of the wall seen head-on from outside; with 1 all of it is opaque
  double wetness = 0.4;         ///< strength of highlights, 0 to 1
  double relief = 0.6e-3;       ///< height of the fine relief, which is shading only [m]
  bool scars = true;            ///< show marks and burn scars
  bool smoke = true;            ///< under the light of the endoscope, show the smoke of the argon beam
  bool particles = false;       ///< balls at the particles
  double particle_size = 3e-3;  ///< diameter of their balls [m]
  bool mesh = false;            ///< edges of the simulation mesh, whose particles determine the render surface
};

/// An organ in a scene of Ogre. Set its mesh once, then a frame whenever it has moved. A frame costs work and transfer
/// only for what has changed. Smoke and the colour of marks depend on the frames of before. To be used from the thread
/// that renders.
class TissueVisual {
 public:
  /// @param parent  frame of all positions; must outlive this object
  /// @param mucosa  of this stomach, as an endoscope sees it
  /// @throws std::runtime_error  the package's materials are not found
  explicit TissueVisual(Ogre::SceneNode& parent, const MucosaLook& mucosa = {});
  ~TissueVisual();
  TissueVisual(const TissueVisual&) = delete;
  TissueVisual& operator=(const TissueVisual&) = delete;

  /// Sets another organ. Nothing is drawn until the next frame.
  void setMesh(const TissueMesh& mesh);
  /// @param frame  of this mesh, checked by readParticles()
  void setFrame(const TissueFrame& frame);
  /// The same for a frame that has been followed, and may come later than those after it.
  void show(const TissueFrame& frame);
  /// A frame that is not to be drawn, but smokes and lets marks age.
  void follow(const TissueFrame& frame);
  void setLook(const TissueLook& look);  ///< at once, also for the frame that is drawn
  /// Draws nothing until the next mesh.
  void clear();

  bool hasFrame() const { return has_frame_; }  ///< since the last setMesh() or clear(); something is drawn
  /// Drawn vertices of the last frame, as DeformableSurface has them; null: none yet.
  const std::vector<MovingVertex>* vertices() const { return has_frame_ ? &surface_->vertices() : nullptr; }
  /// Of the drawn surface; 0: there is no mesh.
  std::size_t vertexCount() const { return surface_ ? surface_->vertices().size() : 0; }

 private:
  void applyLook();
  void applySide(Ogre::MaterialPtr& material, const Ogre::ColourValue& natural, bool outside);
  void applyMucosa(Ogre::Pass& pass) const;
  void choosePrograms();
  void draw();
  void sendForEndoscope();
  void sendSurface(const TissueFrame& frame);
  void sendParticles(const TissueFrame& frame);
  void sendMesh(const TissueFrame& frame);

  Ogre::SceneNode& node_;
  MucosaLook mucosa_;
  TissueLook look_;
  Ogre::MaterialPtr inside_, smoky_inside_, outside_, wire_;
  TissueMesh mesh_;
  TissueFrame frame_;
  bool has_frame_ = false;
  std::unique_ptr<DeformableSurface> surface_;
  std::unique_ptr<SurfaceColours> colours_;
  std::unique_ptr<FoldHeight> folds_;
  std::unique_ptr<Smoke> smoke_;
  std::unique_ptr<ScarAge> scars_;
  double followed_ = 0;                             // time of the last frame that smoke_ and scars_ have seen [s]
  bool varied_ = false;                             // mucosa or light are not the usual ones
  bool smoky_ = false;                              // smoky_inside_ is drawn
  bool folds_sent_ = false, browned_sent_ = false;  // of the frame that is drawn
  SceneSmoke seen_smoke_;
  DynamicMesh drawn_, mesh_lines_;
  std::vector<MovingVertex> mesh_vertices_;
  std::unique_ptr<rviz::PointCloud> points_;
};

}  // namespace vibe::graphics

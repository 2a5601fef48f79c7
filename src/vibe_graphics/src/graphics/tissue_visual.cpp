#include "vibe_graphics/graphics/tissue_visual.hpp"

#include <cmath>
#include <limits>

#include <OgreGpuProgramParams.h>
#include <OgrePass.h>
#include <OgreSceneManager.h>
#include <OgreSceneNode.h>
#include <OgreTechnique.h>
#include <rviz/ogre_helpers/point_cloud.h>

#include "vibe_graphics/geometry/mucosa_pattern.hpp"
#include "vibe_graphics/graphics/endoscope_lamp.hpp"
#include "vibe_graphics/graphics/resources.hpp"

namespace vibe::graphics {

namespace {

constexpr double kSteps = 256;  // per 1/m: sums of such numbers are exact, so smoke that is gone leaves nothing

}  // namespace

void SceneSmoke::set(double extinction, double time) {
  const auto now = static_cast<float>(std::round(kSteps * extinction) / kSteps);
  const float sum = scene_.getFogDensity() - extinction_ + now;
  extinction_ = now;
  // no fog mode, only the numbers: shaders read density and begin as smoke.x and smoke.y
  scene_.setFog(Ogre::FOG_NONE, Ogre::ColourValue::White, sum, static_cast<float>(time));
}

namespace {

// Frames may overtake each other on their way, in a filter that waits for transforms for instance. An overtaken one
// tells nothing new; time that is set back goes back further.
constexpr double kOvertaken = 1;    // [s]
constexpr double kEdgeAlpha = 0.9;  // opacity of a wall at grazing angles
constexpr double kGrain = 0.25;
constexpr float kFillLight = 0.16F, kFillLightOfData = 0.5F;  // ambient light
constexpr double kVessels = 0.10, kVesselsStretched = 0.22;   // strength of their net, and more on a stretched wall

Ogre::AxisAlignedBox boxAround(const Eigen::AlignedBox3f& bounds) {
  if (bounds.isEmpty()) return Ogre::AxisAlignedBox::BOX_NULL;
  const Eigen::Vector3f &min = bounds.min(), &max = bounds.max();
  return {min.x(), min.y(), min.z(), max.x(), max.y(), max.z()};
}

void setBlending(Ogre::Pass& pass, bool transparent) {
  pass.setSceneBlending(transparent ? Ogre::SBT_TRANSPARENT_ALPHA : Ogre::SBT_REPLACE);
  pass.setDepthWriteEnabled(!transparent);
}

void setEndoscopeProgram(Ogre::Material& material, const char* program) {
  for (Ogre::Technique* technique : material.getTechniques())
    if (technique->getSchemeName() == kEndoscopeScheme) technique->getPass(0)->setFragmentProgram(program);
  material.load();
}

}  // namespace

TissueVisual::TissueVisual(Ogre::SceneNode& parent, const MucosaLook& mucosa)
    : node_(parent),
      mucosa_(mucosa),
      inside_(copyMaterial("vibe/tissue_inside")),
      smoky_inside_(copyMaterial("vibe/tissue_inside")),
      outside_(copyMaterial("vibe/tissue_outside")),
      wire_(copyMaterial("vibe/wire")),
      seen_smoke_(*parent.getCreator()),
      drawn_(parent, {inside_, outside_}),
      mesh_lines_(parent, {wire_}),
      points_(std::make_unique<rviz::PointCloud>()) {
  points_->setRenderMode(rviz::PointCloud::RM_SPHERES);
  node_.attachObject(points_.get());
  drawn_.beforeEndoscope([this] { sendForEndoscope(); });
  choosePrograms();
}

TissueVisual::~TissueVisual() {
  node_.detachObject(points_.get());
  clear();
  dropMaterial(inside_), dropMaterial(smoky_inside_), dropMaterial(outside_), dropMaterial(wire_);
}

/// Other programs, because where there is no graphics card a branch that is not taken costs as much time as one that
/// is, and a number that may change costs more than a constant.
void TissueVisual::choosePrograms() {
  varied_ = !mucosa_.isUsual() || !isUsualLamp();
  setEndoscopeProgram(*inside_, varied_ ? "vibe/mucosa_varied_fragment" : "vibe/mucosa_fragment");
  setEndoscopeProgram(*smoky_inside_, varied_ ? "vibe/mucosa_varied_smoke_fragment" : "vibe/mucosa_smoke_fragment");
  applyLook();
}

void TissueVisual::clear() {
  has_frame_ = false;
  followed_ = -std::numeric_limits<double>::infinity();
  mesh_ = {};
  surface_.reset(), colours_.reset(), folds_.reset(), smoke_.reset(), scars_.reset();
  seen_smoke_.set(0, 0);
  drawn_.setTopology({}, 0), mesh_lines_.setTopology({}, 0);
  points_->clear();
}

void TissueVisual::setMesh(const TissueMesh& mesh) {
  clear();
  mesh_ = mesh;
  surface_ = std::make_unique<DeformableSurface>(mesh_);
  colours_ = std::make_unique<SurfaceColours>(mesh_);
  const MucosaMap map = mapMucosa(mesh_, mucosa_.shift);
  folds_ = std::make_unique<FoldHeight>(mesh_, map);
  smoke_ = std::make_unique<Smoke>(mesh_);
  scars_ = std::make_unique<ScarAge>(mesh_);
  folds_sent_ = browned_sent_ = false;
  drawn_.setTopology(mesh_.triangles, mesh_.vertex_count, mesh_.rest, map.of_vertex);
  applyLook();
}

void TissueVisual::setFrame(const TissueFrame& frame) {
  follow(frame);
  show(frame);
}

void TissueVisual::show(const TissueFrame& frame) {
  if (!surface_) return;
  frame_ = frame;
  has_frame_ = true;
  draw();
}

void TissueVisual::follow(const TissueFrame& frame) {
  if (!surface_) return;
  const double late = followed_ - frame.time;
  if (late > 0 && late < kOvertaken) return;
  followed_ = frame.time;
  smoke_->see(frame);
  if (scars_->see(frame)) browned_sent_ = false;
}

void TissueVisual::draw() {
  drawn_.setVisible(look_.surface);
  seen_smoke_.set(look_.smoke ? smoke_->extinction() : 0, frame_.time);
  if (look_.surface) sendSurface(frame_);
  if (look_.particles) sendParticles(frame_);
  if (look_.mesh) sendMesh(frame_);
}

// What only the shader of the mucosa reads. It may be long before an endoscope looks, so it waits until then.
void TissueVisual::sendForEndoscope() {
  if (!has_frame_) return;
  if (varied_ != (!mucosa_.isUsual() || !isUsualLamp())) choosePrograms();
  const bool smoky = node_.getCreator()->getFogDensity() > 0;  // of any organ of the scene
  if (smoky != smoky_) drawn_.setMaterials({smoky ? smoky_inside_ : inside_, outside_});
  smoky_ = smoky;
  if (!folds_sent_) drawn_.setHeights(folds_->update(frame_.positions));
  if (!browned_sent_) drawn_.setBrowned(scars_->browned());
  folds_sent_ = browned_sent_ = true;
}

void TissueVisual::sendSurface(const TissueFrame& frame) {
  const VertexSpan moved = surface_->update(frame.positions);
  if (!moved.empty()) {
    drawn_.setVertices(surface_->vertices().data() + moved.first, moved.first, moved.count());
    drawn_.setBounds(boxAround(surface_->bounds()));
    folds_sent_ = false;
  }
  const VertexSpan coloured = colours_->update(frame);
  drawn_.setColours(colours_->colours().data() + coloured.first, coloured.first, coloured.count());
}

void TissueVisual::sendParticles(const TissueFrame& frame) {
  std::vector<rviz::PointCloud::Point> points(frame.positions.size() / 3);
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i].position = {frame.positions[3 * i], frame.positions[3 * i + 1], frame.positions[3 * i + 2]};
    points[i].setColor(0.95F, 0.85F, 0.55F);
  }
  points_->clear();
  const auto size = static_cast<float>(look_.particle_size);
  points_->setDimensions(size, size, size);
  points_->addPoints(points.data(), static_cast<std::uint32_t>(points.size()));
}

void TissueVisual::sendMesh(const TissueFrame& frame) {
  if (mesh_lines_.triangleCount() == 0) mesh_lines_.setTopology(mesh_.particle_triangles, mesh_.particle_count);
  mesh_vertices_.resize(mesh_.particle_count);
  for (std::size_t i = 0; i < mesh_.particle_count; ++i)
    mesh_vertices_[i] = {{frame.positions[3 * i], frame.positions[3 * i + 1], frame.positions[3 * i + 2]}, {0, 0, 1}};
  mesh_lines_.setVertices(mesh_vertices_.data(), 0, mesh_vertices_.size());
  mesh_lines_.setBounds(Ogre::AxisAlignedBox::BOX_INFINITE);
}

void TissueVisual::setLook(const TissueLook& look) {
  look_ = look;
  applyLook();
  drawn_.setVisible(look_.surface);
  mesh_lines_.setVisible(look_.mesh);
  points_->setVisible(look_.particles);
  if (has_frame_) draw();
}

void TissueVisual::applyLook() {
  if (colours_) colours_->choose(look_.colouring, ColourMap(look_.map, look_.min, look_.max));
  applySide(inside_, look_.inside, false);
  applySide(smoky_inside_, look_.inside, false);
  applySide(outside_, look_.outside, true);
}

// Data colours must not be changed by the natural colour, the fine pattern or bright highlights.
void TissueVisual::applySide(Ogre::MaterialPtr& material, const Ogre::ColourValue& natural, bool outside) {
  const bool plain = look_.colouring == Colouring::Tissue;
  const auto opacity = static_cast<float>(outside ? look_.outside_alpha : 1.0);
  for (Ogre::Technique* technique : material->getTechniques()) {
    Ogre::Pass& pass = *technique->getPass(0);
    const bool endoscope = technique->getSchemeName() == kEndoscopeScheme;
    const bool transparent = outside && !endoscope && opacity < 1;
    setBlending(pass, transparent);
    auto parameters = pass.getFragmentProgramParameters();
    const bool mucosa = endoscope && !outside;
    const Ogre::ColourValue tint = plain ? natural : Ogre::ColourValue::White;
    parameters->setNamedConstant("tint", Ogre::Vector4(tint.r, tint.g, tint.b, transparent ? opacity : 1));
    const double edge_alpha = transparent ? std::max(kEdgeAlpha, look_.outside_alpha) : 1;
    if (!mucosa) parameters->setNamedConstant("edge_alpha", static_cast<float>(edge_alpha));
    parameters->setNamedConstant("wet", static_cast<float>(look_.wetness *
                                                           (endoscope     ? 1.3
                                                            : transparent ? 0.6
                                                                          : 1) *
                                                           (plain ? 1 : 0.4) * (mucosa ? mucosa_.wetness : 1)));
    parameters->setNamedConstant("relief", static_cast<float>(look_.relief));
    parameters->setNamedConstant("grain", static_cast<float>(!plain ? 0 : mucosa ? 1 : kGrain));
    parameters->setNamedConstant("fill", plain ? kFillLight : kFillLightOfData);
    parameters->setNamedConstant("scars", look_.scars && (!outside || transparent) ? 1.0F : 0.0F);
    if (mucosa) applyMucosa(pass);
  }
}

void TissueVisual::applyMucosa(Ogre::Pass& pass) const {
  const auto real = [](double value) { return static_cast<float>(value); };
  const Eigen::Vector3f& shift = mucosa_.shift;
  pass.getVertexProgramParameters()->setNamedConstant("pattern_shift", Ogre::Vector3(shift.x(), shift.y(), shift.z()));
  if (!varied_) return;
  Ogre::GpuProgramParameters& parameters = *pass.getFragmentProgramParameters();
  parameters.setNamedConstant("areae_count", real(1 / (kPatternCells * mucosa_.areae_size)));
  const double yellow = std::sqrt(mucosa_.yellowness);
  parameters.setNamedConstant("hue",
                              Ogre::Vector3(1, real(mucosa_.paleness * yellow), real(mucosa_.paleness / yellow)));
  parameters.setNamedConstant("vessels",
                              real(mucosa_.vessels) * Ogre::Vector2(real(kVessels), real(kVesselsStretched)));
  parameters.setNamedConstant("more_mucus", real(mucosa_.mucus));
}

}  // namespace vibe::graphics

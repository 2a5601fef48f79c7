#include "truth/truth_scene.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "vibe_graphics/geometry/coloured_shape.hpp"
#include "vibe_graphics/geometry/suture_shapes.hpp"

namespace vibe::endoscope {
namespace {

/// A shape that goes on after the first vertices and triangles of `shape`, which it shares with `beginning`.
graphics::ColouredShape without(const graphics::ColouredShape& beginning, const graphics::ColouredShape& shape) {
  graphics::ColouredShape rest;
  const std::size_t first = beginning.vertices.size();
  rest.vertices.assign(shape.vertices.begin() + static_cast<std::ptrdiff_t>(first), shape.vertices.end());
  rest.colours.assign(shape.colours.begin() + static_cast<std::ptrdiff_t>(first), shape.colours.end());
  for (std::size_t k = beginning.triangles.size(); k < shape.triangles.size(); ++k)
    rest.triangles.push_back(shape.triangles[k] - static_cast<std::uint32_t>(first));
  return rest;
}

struct SutureParts {
  graphics::ColouredShape threads, tags, cinches;
};

/// The drawn triangles, told apart: those of a set begin with its threads, and the ends follow. The ends are drawn with
/// their threads, because these give their direction.
SutureParts partsOf(const graphics::SutureDrawing& sutures) {
  const auto drawn = [](const graphics::SutureSet& set, bool ends) {
    graphics::SutureStyle style = graphics::naturalSutures();
    style.ends = ends;
    graphics::ColouredShape shape;
    graphics::appendSutures({{set}, {}}, style, shape);
    return shape;
  };
  SutureParts parts;
  for (const graphics::SutureSet& set : sutures.sets) {
    const graphics::ColouredShape thread = drawn(set, false);
    graphics::SutureSet tagged = set, cinched = set;
    tagged.has_cinch = false, cinched.has_t_tag = false;
    graphics::appendShape(thread, parts.threads);
    graphics::appendShape(without(thread, drawn(tagged, true)), parts.tags);
    graphics::appendShape(without(thread, drawn(cinched, true)), parts.cinches);
  }
  return parts;
}

Eigen::Vector3d placeOf(const graphics::MovingVertex& vertex) {
  return {double{vertex.position[0]}, double{vertex.position[1]}, double{vertex.position[2]}};
}

/// Across the triangle, of any length.
Eigen::Vector3d across(const graphics::MovingVertex& a, const graphics::MovingVertex& b,
                       const graphics::MovingVertex& c) {
  const Eigen::Vector3d begin = placeOf(a);
  return (placeOf(b) - begin).cross(placeOf(c) - begin);
}

}  // namespace

TruthScene::TruthScene() {
  wall_ = addBody(kLabelNothing, rays_.addMoving());
  thread_ = addBody(kLabelThread, rays_.addMoving());
  tag_ = addBody(kLabelTag, rays_.addMoving());
  cinch_ = addBody(kLabelCinch, rays_.addMoving());
  blood_ = addBody(kLabelBlood, rays_.addMoving());
}

std::uint32_t TruthScene::addBody(std::uint8_t label, std::uint32_t number) {
  if (number != bodies_.size()) throw std::runtime_error("Embree numbers its geometries in an order that is not ours.");
  Body& body = bodies_.emplace_back();
  body.label = label;
  body.vertices = &body.own.vertices, body.triangles = &body.own.triangles;
  return number;
}

void TruthScene::setMesh(const graphics::TissueMesh& mesh) {
  mesh_ = mesh;
  bleeding_.setMesh(&mesh_);
  rays_.set(wall_, {}, {});
  surface_ = std::make_unique<graphics::DeformableSurface>(mesh_);
  wall_labels_.setMesh(mesh_);
  Body& wall = bodies_[wall_];
  wall.vertices = &surface_->vertices(), wall.triangles = &mesh_.triangles;
  wall.shape_number = 0;  // until there is a frame
}

void TruthScene::setFrame(const graphics::TissueFrame& frame) {
  Body& wall = bodies_[wall_];
  const bool first = wall.shape_number == 0;
  const bool moved = !surface_->update(frame.positions).empty();
  wall_labels_.setFrame(mesh_, frame);
  if (first || !pressed_.empty()) {
    if (first) wall.shape_number = ++shapes_;
    wall.vertices = &surface_->vertices();
    pressed_.clear();
    rays_.set(wall_, *wall.vertices, *wall.triangles);
  } else if (moved) {
    rays_.moved(wall_);
  }
}

void TruthScene::pressOnLens(const Eigen::Isometry3d& camera) {
  const std::vector<graphics::MovingVertex>& wall = surface_->vertices();
  const Eigen::Isometry3d to_camera = camera.inverse(Eigen::Isometry);
  std::vector<graphics::MovingVertex> pressed;
  for (std::size_t v = 0; v < wall.size(); ++v) {
    const Eigen::Vector3d seen = to_camera * placeOf(wall[v]), shown = graphics::placeOnLens(seen);
    if (shown == seen) continue;
    if (pressed.empty()) pressed = wall;
    Eigen::Map<Eigen::Vector3f>(pressed[v].position) = (camera * shown).cast<float>();
  }
  if (pressed.empty() && pressed_.empty()) return;
  pressed_ = std::move(pressed);
  Body& body = bodies_[wall_];
  body.vertices = pressed_.empty() ? &wall : &pressed_;
  rays_.set(wall_, *body.vertices, *body.triangles);
}

void TruthScene::setSutures(const graphics::SutureDrawing& sutures, double time, const Eigen::Isometry3d& pose) {
  SutureParts parts = partsOf(sutures);
  setShape(thread_, std::move(parts.threads), pose, true);
  setShape(tag_, std::move(parts.tags), pose, true);
  setShape(cinch_, std::move(parts.cinches), pose, true);
  graphics::BloodStyle style;
  style.time = time;
  bleeding_.setWounds(sutures, style);
  suture_pose_ = pose;
}

void TruthScene::setShape(std::uint32_t number, graphics::ColouredShape shape, const Eigen::Isometry3d& pose,
                          bool material) {
  Body& body = bodies_[number];
  for (graphics::MovingVertex& vertex : shape.vertices) {
    Eigen::Map<Eigen::Vector3f> place(vertex.position), normal(vertex.normal);
    place = (pose * Eigen::Vector3d(place.cast<double>())).cast<float>();
    normal = (pose.linear() * Eigen::Vector3d(normal.cast<double>())).cast<float>();
  }
  const bool same = shape.triangles == body.own.triangles && shape.vertices.size() == body.own.vertices.size();
  if (!same || body.shape_number == 0) body.shape_number = material ? ++shapes_ : 0;
  body.own = std::move(shape);
  rays_.set(number, body.own.vertices, body.own.triangles, number == blood_ ? &body.own.colours : nullptr);
}

void TruthScene::commit() {
  const Body& wall = bodies_[wall_];
  if (bleeding_.update(wall.shape_number > 0 ? wall.vertices : nullptr, suture_pose_.inverse()))
    setShape(blood_, bleeding_.shape(), suture_pose_, false);
  rays_.commit();
}

std::uint32_t TruthScene::addPart(const std::string& name, graphics::ColouredShape shape) {
  const auto known = std::find(part_names_.begin(), part_names_.end(), name);
  const auto which = static_cast<std::size_t>(known - part_names_.begin());
  if (kLabelInstrument + which > kLabelLast)
    throw std::runtime_error("The robot description has more than " +
                             std::to_string(kLabelLast - kLabelInstrument + 1) +
                             " visible parts, but there are no more labels; give visuals of a link the same name.");
  if (known == part_names_.end()) part_names_.push_back(name);
  Body& body = bodies_.emplace_back();
  body.label = static_cast<std::uint8_t>(kLabelInstrument + which);
  body.own = std::move(shape);
  body.vertices = &body.own.vertices, body.triangles = &body.own.triangles;
  body.shape_number = ++shapes_;
  body.placed = false;
  if (rays_.addRigid(*body.vertices, *body.triangles) + 1 != bodies_.size())
    throw std::runtime_error("Embree numbers its geometries in an order that is not ours.");
  return static_cast<std::uint32_t>(bodies_.size() - 1);
}

void TruthScene::placePart(std::uint32_t part, const std::optional<Eigen::Isometry3d>& pose) {
  bodies_[part].placed = pose.has_value();
  if (pose) bodies_[part].pose = *pose;
  rays_.place(part, pose);
}

Eigen::Vector3d TruthScene::pointOf(const SurfaceHit& hit) const {
  const Body& body = bodies_[hit.body];
  const std::uint32_t* corner = &(*body.triangles)[3 * hit.triangle];
  const graphics::MovingVertex* vertices = body.vertices->data();
  const double u = double{hit.u}, v = double{hit.v};
  return (1 - u - v) * placeOf(vertices[corner[0]]) + u * placeOf(vertices[corner[1]]) +
         v * placeOf(vertices[corner[2]]);
}

Eigen::Vector3d TruthScene::normalOf(const SurfaceHit& hit, const Eigen::Vector3d& towards) const {
  const Body& body = bodies_[hit.body];
  const std::uint32_t* corner = &(*body.triangles)[3 * hit.triangle];
  const graphics::MovingVertex &a = (*body.vertices)[corner[0]], &b = (*body.vertices)[corner[1]],
                               &c = (*body.vertices)[corner[2]];
  const float w = 1 - hit.u - hit.v;
  Eigen::Vector3d shaded;
  for (int k = 0; k < 3; ++k) shaded[k] = double{w * a.normal[k] + hit.u * b.normal[k] + hit.v * c.normal[k]};
  Eigen::Vector3d flat = across(a, b, c);
  if (flat.dot(towards) < 0) flat = -flat;
  // vertex normals point to the outside, whichever way the triangle is wound
  if (shaded.dot(flat) < 0) shaded = -shaded;
  const double square = shaded.squaredNorm();
  return square > 1e-12 && shaded.dot(towards) > 0 ? Eigen::Vector3d(shaded / std::sqrt(square)) : flat.normalized();
}

std::uint8_t TruthScene::labelOf(const SurfaceHit& hit, const Eigen::Vector3d& towards) const {
  const Body& body = bodies_[hit.body];
  if (hit.body != wall_) return body.label;
  const std::uint32_t* corner = &(*body.triangles)[3 * hit.triangle];
  const graphics::MovingVertex* vertices = body.vertices->data();
  if (across(vertices[corner[0]], vertices[corner[1]], vertices[corner[2]]).dot(towards) > 0) return kLabelOuterWall;
  return wall_labels_.at(corner, {1 - hit.u - hit.v, hit.u, hit.v});
}

}  // namespace vibe::endoscope

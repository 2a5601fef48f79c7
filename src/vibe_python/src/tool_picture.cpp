#include "tool_picture.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <map>
#include <mutex>
#include <string>

#include "vibe_core/files/files.hpp"
#include "vibe_core/geometry/mesh_file.hpp"
#include "vibe_core/procedure/stitch.hpp"
#include "vibe_core/simulation/tool_queries.hpp"

namespace vibe::python {

namespace {

using Rgb = Eigen::Vector3d;

// As in scope.mtl of vibe_description: steel, a polymer for the cap, ceramic for the probe's end, blue thread.
const Rgb kSteel(0.6, 0.6, 0.61), kGold(0.66, 0.5, 0.2), kPolymer(0.2, 0.21, 0.22), kCeramic(0.8, 0.78, 0.72);
const Rgb kThread(0.1, 0.17, 0.32);
constexpr double kThreadRadius = 0.25e-3;  // of a 2-0 suture in its sheath, as rviz draws it [m]
// A tube has six sides; their corners on the unit circle.
constexpr std::array<double, 6> kCosine{1, 0.5, -0.5, -1, -0.5, 0.5};
constexpr std::array<double, 6> kSine{0, 0.8660254037844386,  0.8660254037844386,
                                      0, -0.8660254037844386, -0.8660254037844386};
constexpr int kSides = static_cast<int>(kSine.size());

Rgb colourOf(const std::string& link) {
  if (link == "suture_needle") return kGold;
  if (link == "device_cap") return kPolymer;
  return link == "argon_probe" ? kCeramic : kSteel;
}

const SurfaceMesh& meshOf(const std::string& file) {
  static std::mutex one_at_a_time;
  static std::map<std::string, SurfaceMesh> read;
  const std::lock_guard<std::mutex> lock(one_at_a_time);
  const auto found = read.find(file);
  return found != read.end() ? found->second : read.emplace(file, readMeshFile(resolveAddress(file))).first->second;
}

/// Whether the lens may see a link: those that scope_tip carries.
std::vector<bool> beforeTheLens(const Model& model) {
  std::vector<bool> carried(static_cast<std::size_t>(model.tool->linkCount()));
  for (const ToolJoint& joint : model.tool->joints())
    carried[joint.child_link] = carried[joint.parent_link] || joint.parent_link == model.tip_link;
  return carried;
}

void add(const Eigen::Vector3d& vertex, const Rgb& colour, Scenery& scenery) {
  scenery.x.push_back(vertex.x());
  scenery.y.push_back(vertex.y());
  scenery.z.push_back(vertex.z());
  scenery.albedo.push_back(colour);
}

void addMesh(const SurfaceMesh& mesh, const Eigen::Affine3d& pose, const Rgb& colour, Scenery& scenery) {
  const int first = static_cast<int>(scenery.x.size());
  for (const Eigen::Vector3d& vertex : mesh.vertices) add(pose * vertex, colour, scenery);
  for (const auto& t : mesh.triangles) {
    scenery.triangles.push_back({first + t[0], first + t[1], first + t[2]});
    scenery.label.push_back(kToolLabel);
  }
}

void addTube(const Eigen::Vector3d& from, const Eigen::Vector3d& to, Scenery& scenery) {
  const Eigen::Vector3d along = to - from;
  if (along.norm() < kThreadRadius) return;
  const Eigen::Vector3d side = kThreadRadius * along.unitOrthogonal(), other = along.normalized().cross(side);
  const int first = static_cast<int>(scenery.x.size());
  for (int k = 0; k < kSides; ++k) {
    const Eigen::Vector3d out = kCosine[k] * side + kSine[k] * other;
    add(from + out, kThread, scenery);
    add(to + out, kThread, scenery);
  }
  for (int k = 0; k < kSides; ++k) {
    const int a = first + 2 * k, b = first + 2 * ((k + 1) % kSides);
    scenery.triangles.push_back({a, b, a + 1});
    scenery.triangles.push_back({b, b + 1, a + 1});
    scenery.label.insert(scenery.label.end(), 2, kThreadLabel);
  }
}

/// Where the thread comes out of a bite, on the inside of the wall.
Eigen::Vector3d insideOf(const Bite& bite, const Model& model, const State& state,
                         const std::vector<Eigen::Vector3d>& normal) {
  const Eigen::Vector3d outward = normal[static_cast<std::size_t>(nearestParticle(bite))];
  return bitePosition(bite, state.x, state.y, state.z) - (model.particle_radius + kThreadRadius) * outward;
}

void addThreads(const Model& model, const State& state, Scenery& scenery) {
  if (state.procedure.sutures.empty()) return;
  SurfaceMesh wall{{}, model.organ.surface.triangles};
  for (std::size_t i = 0; i < state.x.size(); ++i) wall.vertices.emplace_back(state.x[i], state.y[i], state.z[i]);
  const std::vector<Eigen::Vector3d> normal = vertexNormals(wall);
  for (const Suture& suture : state.procedure.sutures)
    for (std::size_t k = 1; k < suture.bites.size(); ++k)
      addTube(insideOf(suture.bites[k - 1], model, state, normal), insideOf(suture.bites[k], model, state, normal),
              scenery);
}

}  // namespace

Scenery sceneryOf(const Model& model, const State& state, Instruments shown) {
  Scenery scenery{state.x, state.y, state.z, model.organ.surface.triangles, {}, {}};
  if (shown == Instruments::None) return scenery;
  const std::vector<bool> before_lens = beforeTheLens(model);
  const std::vector<Eigen::Isometry3d> poses = drawnLinkPoses(model, state);
  for (const LinkMesh& mesh : model.tool->meshes())
    if (shown == Instruments::All || before_lens[static_cast<std::size_t>(mesh.link)])
      addMesh(meshOf(mesh.file), poses[mesh.link] * mesh.origin * Eigen::Scaling(mesh.scale),
              colourOf(model.tool->linkName(mesh.link)), scenery);
  addThreads(model, state, scenery);
  return scenery;
}

}  // namespace vibe::python

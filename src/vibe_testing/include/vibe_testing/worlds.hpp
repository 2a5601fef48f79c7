#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "vibe_core/simulation/simulator.hpp"

/// Worlds for tests, in one line each.
namespace vibe::test {

/// Sphere from an icosahedron, every triangle cut in four `level` times: 10 * 4^level + 2 vertices.
inline SurfaceMesh icosphere(double radius, int level) {
  const double g = (1 + std::sqrt(5.0)) / 2;
  SurfaceMesh m;
  for (double a : {-1.0, 1.0})
    for (double b : {-g, g}) {
      m.vertices.emplace_back(a, b, 0);
      m.vertices.emplace_back(0, a, b);
      m.vertices.emplace_back(b, 0, a);
    }
  const int n = static_cast<int>(m.vertices.size());
  for (int i = 0; i < n; ++i)
    for (int j = i + 1; j < n; ++j)
      for (int k = j + 1; k < n; ++k) {
        const auto near = [&](int p, int q) { return std::abs((m.vertices[p] - m.vertices[q]).norm() - 2) < 1e-9; };
        if (!near(i, j) || !near(j, k) || !near(i, k)) continue;
        const double side = m.vertices[i].dot(m.vertices[j].cross(m.vertices[k]));
        m.triangles.push_back(side > 0 ? std::array<int, 3>{i, j, k} : std::array<int, 3>{i, k, j});
      }
  for (int l = 0; l < level; ++l) {
    SurfaceMesh fine;
    fine.vertices = m.vertices;
    std::map<std::pair<int, int>, int> middle;
    const auto mid = [&](int a, int b) {
      const auto key = std::minmax(a, b);
      const auto found = middle.find(key);
      if (found != middle.end()) return found->second;
      fine.vertices.emplace_back((m.vertices[a] + m.vertices[b]).normalized() * m.vertices[a].norm());
      return middle[key] = static_cast<int>(fine.vertices.size()) - 1;
    };
    for (const auto& t : m.triangles) {
      const int a = mid(t[0], t[1]), b = mid(t[1], t[2]), c = mid(t[2], t[0]);
      fine.triangles.push_back({t[0], a, c});
      fine.triangles.push_back({t[1], b, a});
      fine.triangles.push_back({t[2], c, b});
      fine.triangles.push_back({a, b, c});
    }
    m = std::move(fine);
  }
  for (auto& v : m.vertices) v = v.normalized() * radius;
  return m;
}

/// Organ on a given surface: all body, nothing held, one thickness.
inline Organ plainOrgan(SurfaceMesh surface, double thickness) {
  Organ organ;
  const std::size_t n = surface.vertices.size();
  organ.surface = std::move(surface);
  organ.region.assign(n, Region::Body);
  organ.wall.assign(n, Wall::Anterior);
  organ.end.assign(n, End::None);
  organ.thickness.assign(n, thickness);
  return organ;
}

/// Scene with nothing but tissue: no damping, no loads, few sub-steps.
inline Scene bareScene() {
  Scene scene;
  scene.tissue.model = "shape_matching";
  scene.tissue.mass_damping = 0;
  scene.tissue.stiffness_damping = 0;
  scene.tissue.substeps = 20;
  return scene;
}

/// A simulator in one line: World world(scene, organ); world.run(1.0);
struct World {
  std::shared_ptr<const Model> model;    ///< not null, constant
  State state;                           ///< after the last step; initialState() before
  std::unique_ptr<Workspace> workspace;  ///< of the model
  std::vector<Event> events;             ///< of all steps, in their order

  /// @param urdf  text, for a scene with a scope  @param threads  of the workspace
  World(const Scene& scene, Organ organ, const std::string& urdf = "", int threads = 1) {
    auto made = std::make_shared<Model>();
    made->scene = scene;
    made->organ = std::move(organ);
    finishModel(urdf, *made);
    model = made;
    state = initialState(*model, scene.seed);
    workspace = std::make_unique<Workspace>(*model, threads);
  }

  /// One step period of the scene.
  void step(const StepInput& input = {}) { vibe::step(*model, state, input, *workspace, events); }

  /// Steps with the same input until `seconds` have passed, rounded to whole steps.
  void run(double seconds, const StepInput& input = {}) {
    const long steps = std::lround(seconds / model->scene.step_period);
    for (long i = 0; i < steps; ++i) step(input);
  }

  /// Place of particle i [m].
  Eigen::Vector3d position(int i) const { return {state.x[i], state.y[i], state.z[i]}; }

  /// Greatest distance of a particle from its place at rest [m].
  double maxShift() const {
    double max = 0;
    for (int i = 0; i < model->particle_count; ++i)
      max = std::max(max, (position(i) - model->organ.surface.vertices[i]).norm());
    return max;
  }

  /// Events of a kind in all steps so far.
  int count(Event::Kind kind) const {
    int n = 0;
    for (const Event& event : events) n += event.kind == kind ? 1 : 0;
    return n;
  }
};

}  // namespace vibe::test

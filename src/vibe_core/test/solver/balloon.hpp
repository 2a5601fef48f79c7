#pragma once
#include <memory>

#include "solver/implicit_worlds.hpp"
#include "vibe_core/tissue/shell.hpp"
#include "vibe_testing/worlds.hpp"

/// A ball of gas in a thin wall, for the tests of implicit steps.
namespace vibe::test {

struct BallOptions {
  Material material = neoHookean();
  double wall = 1e-3;       ///< [m]
  double foundation = 0;    ///< [Pa/m]; 0: only so much that it knows where to be
  double mass_damping = 0;  ///< [1/s]
  double clamped = 2;       ///< fixed is what lies more than this part of the radius below the middle
};

/// The wall of the default scene.
inline BallOptions stomachWall() {
  BallOptions options;
  options.material = {Law::Yeoh, 1.1e5, 0.45, 2};
  options.wall = 2.3e-3;
  options.mass_damping = 30;
  return options;
}

struct Ball {
  static constexpr double kRadius = 0.05;
  std::shared_ptr<const ShellElements> shell;
  std::unique_ptr<Body> run;

  explicit Ball(const StepSettings& settings = {}, const BallOptions& options = {}) {
    const SurfaceMesh surface = icosphere(kRadius, 2);
    ShellMesh mesh;
    mesh.nodes.assign(surface.vertices.begin(), surface.vertices.end());
    for (const auto& t : surface.triangles) mesh.triangles.push_back({t[0], t[1], t[2]});
    mesh.thickness.assign(mesh.triangles.size(), options.wall);
    mesh.materials = {options.material};
    ElasticBody body;
    body.rest = mesh.nodes;
    for (const Eigen::Vector3d& p : body.rest) body.fixed.push_back(p.z() < -options.clamped * kRadius ? 1 : 0);
    mesh.fixed = body.fixed;
    shell = std::make_shared<const ShellElements>(mesh);
    body.elements = shell;
    body.shell = shell.get();
    body.mass = shell->lumpedMass(kDensity);
    for (const double area : vertexAreas(surface))
      body.foundation.push_back(options.foundation > 0 ? options.foundation * area : 1e-3);
    body.mass_damping = options.mass_damping;
    run = std::make_unique<Body>(body, settings);
  }
  double volume() const {
    Eigen::VectorXd u(3 * run->nodes()), gradient(3 * run->nodes());
    for (int i = 0; i < run->nodes(); ++i) u.segment<3>(3 * i) = run->position(i) - run->stepper.body().rest[i];
    return shell->volume(u.data(), gradient.data());
  }
  /// Gas of a gauge pressure at the present volume, which stays in.
  void fill(double pressure) {
    gas().control = GasLoad::Control::Amount;
    gas().volume = volume();
    gas().amount = (gas().ambient + pressure) * gas().volume;
  }
  GasLoad& gas() { return run->loads.gas; }
};

}  // namespace vibe::test

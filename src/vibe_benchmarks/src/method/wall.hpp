#pragma once
#include <vector>

#include "vibe_core/geometry/surface_mesh.hpp"
#include "vibe_core/solver/elastic_body.hpp"
#include "vibe_core/tissue/material_registry.hpp"

namespace vibe::benchmarks {

constexpr double kWallThickness = 0.0035;  ///< [m]
constexpr double kWallDensity = 1050;      ///< [kg/m^3]
constexpr Material kWallTissue{Law::NeoHookean, 50e3, 0.45, 0};

/// The scenario of the method table: a closed ellipsoid of 0.25 m x 0.09 m, wall 3.5 mm, neo-Hookean 50 kPa, nu 0.45,
/// 1050 kg/m^3, with held ends (60 nodes of 3,618), inflated to 500 Pa. A disc of 5 mm radius at the equator is pulled
/// inwards at constant speed and then held.
struct BenchWall {
  SurfaceMesh mesh;                ///< middle surface at rest, long axis z
  ElasticBody body;                ///< damped by 30 1/s
  std::vector<int> tool;           ///< nodes of the disc
  Eigen::Vector3d pull_direction;  ///< unit, inwards
  double pressure = 500;           ///< [Pa]
  double rest_volume = 0;          ///< [m^3]
};
BenchWall makeWall(int nodes);

/// Displacement of the disc over time.
struct Pull {
  double distance = 0.02;  ///< [m]
  double duration = 0.5;   ///< of the motion, at constant speed [s]
  double hold = 0.5;       ///< after it [s]
  double at(double time) const { return time >= duration ? distance : distance * time / duration; }
};

/// The pressure, and three conditions per node of the disc: its start position, displaced by a distance.
/// @param start  positions of the inflated wall
BodyLoads wallLoads(const BenchWall& wall, const BodyMotion& start, double distance);
/// The pressure alone.
BodyLoads pressureLoads(const BenchWall& wall, double pressure);
/// Force of the disc on the wall along the pull [N].
double toolForce(const BenchWall& wall, const BodyLoads& loads);

/// The inflated wall at equilibrium, computed from rest in five stages of pressure.
/// @throws Error if it does not converge to `tolerance` [m]
BodyMotion inflate(const BenchWall& wall, double tolerance);
/// Quasi-static pull: equilibria every 4 mm. `force` out [N].
BodyMotion pulledEquilibrium(const BenchWall& wall, const BodyMotion& start, double distance, double tolerance,
                             double& force);

/// sqrt(sum |a - b|^2) over all nodes [m].
double distanceBetween(const BodyMotion& a, const BodyMotion& b);

}  // namespace vibe::benchmarks

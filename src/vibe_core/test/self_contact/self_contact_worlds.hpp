#pragma once

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "self_contact/self_contact.hpp"
#include "sparse/closed_mesh.hpp"
#include "vibe_testing/wall_crossings.hpp"

namespace vibe::test {

constexpr double kWallThickness = 3e-3, kModulus = 5e4, kStep = 1.0 / 60;

/// A square grid of cells x cells squares about the z axis at height z, its normals up or down.
inline void addPlate(int cells, double spacing, double z, bool up, SurfaceMesh& mesh) {
  const int first = static_cast<int>(mesh.vertices.size()), row = cells + 1;
  for (int j = 0; j <= cells; ++j)
    for (int i = 0; i <= cells; ++i)
      mesh.vertices.push_back({spacing * (i - 0.5 * cells), spacing * (j - 0.5 * cells), z});
  for (int j = 0; j < cells; ++j)
    for (int i = 0; i < cells; ++i) {
      const int a = first + j * row + i, b = a + 1, c = a + row, d = c + 1;
      for (auto t : {std::array<int, 3>{a, b, d}, std::array<int, 3>{a, d, c}}) {
        if (!up) std::swap(t[1], t[2]);
        mesh.triangles.push_back(t);
      }
    }
}

/// Two plates that face each other, far apart.
inline SurfaceMesh plates(int lower, int upper, double spacing = 2.5e-3) {
  SurfaceMesh mesh;
  addPlate(lower, spacing, 0, true, mesh);
  addPlate(upper, spacing, 0.1, false, mesh);
  return mesh;
}

inline int plateSize(int cells) {
  return (cells + 1) * (cells + 1);
}

/// closedMesh() on a sphere of another radius.
inline SurfaceMesh sphere(double radius, int cuts) {
  const ClosedMesh unit = closedMesh(cuts);
  SurfaceMesh mesh;
  for (const Eigen::Vector3d& node : unit.nodes) mesh.vertices.push_back(radius * node);
  mesh.triangles = unit.triangles;
  return mesh;
}

struct ContactWorld {
  explicit ContactWorld(SurfaceMesh rest_mesh, double thickness = kWallThickness)
      : rest(std::move(rest_mesh)),
        contact(rest, std::vector<double>(rest.vertices.size(), thickness), kModulus),
        at(4 * rest.vertices.size()),
        gradient(4 * rest.vertices.size()) {
    for (std::size_t i = 0; i < rest.vertices.size(); ++i) set(i, rest.vertices[i]);
  }
  /// Pairs of triangles that cross now, or at a part of the way from an earlier place.
  std::size_t crossings(const std::vector<double>& from = {}, double part = 1) const {
    std::array<std::vector<double>, 3> p;
    for (std::size_t i = 0; i < count(); ++i)
      for (std::size_t k = 0; k < 3; ++k)
        p[k].push_back(from.empty() ? at[4 * i + k] : from[4 * i + k] + part * (at[4 * i + k] - from[4 * i + k]));
    return findWallCrossings({rest.triangles, p[0], p[1], p[2]}).size();
  }
  std::size_t count() const { return rest.vertices.size(); }
  Eigen::Vector3d get(std::size_t i) const { return {at[4 * i], at[4 * i + 1], at[4 * i + 2]}; }
  void set(std::size_t i, const Eigen::Vector3d& p) {
    for (int k = 0; k < 3; ++k) at[4 * i + k] = p[k];
  }
  void detect(double reach, double lead = kStep) {
    for (std::size_t k = 0; k < 3; ++k) {
      position[k].resize(count());
      for (std::size_t i = 0; i < count(); ++i) position[k][i] = at[4 * i + k];
      speed[k].resize(count(), 0);
    }
    contact.detect({position[0].data(), position[1].data(), position[2].data()},
                   {speed[0].data(), speed[1].data(), speed[2].data()}, reach, lead);
  }
  /// Ends a step that has moved by `move` since detect().
  std::size_t resolvePenetrations(const std::vector<double>& move) {
    std::array<std::vector<double>, 3> x, v, a;
    for (std::size_t i = 0; i < count(); ++i)
      for (std::size_t k = 0; k < 3; ++k) {
        x[k].push_back(at[4 * i + k] + move[4 * i + k]);
        v[k].push_back(7);
        a[k].push_back(7);
      }
    const MotionView view{{x[0].data(), x[1].data(), x[2].data()},
                          {v[0].data(), v[1].data(), v[2].data()},
                          {a[0].data(), a[1].data(), a[2].data()}};
    const std::vector<int>& stopped = contact.resolvePenetrations(view, kStep);
    for (const int i : stopped)
      for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_NEAR(v[k][i], (x[k][i] - at[4 * static_cast<std::size_t>(i) + k]) / kStep, 1e-9);
        EXPECT_EQ(a[k][i], 0);
      }
    for (std::size_t i = 0; i < count(); ++i)
      for (std::size_t k = 0; k < 3; ++k) at[4 * i + k] = x[k][i];
    return stopped.size();
  }
  double evaluate() {
    std::fill(gradient.begin(), gradient.end(), 0.0F);
    return contact.evaluate(at.data(), gradient.data());
  }
  Eigen::Vector3d force(std::size_t i) const { return {-gradient[4 * i], -gradient[4 * i + 1], -gradient[4 * i + 2]}; }
  Eigen::Vector3d totalForce(std::size_t first, std::size_t last) const {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t i = first; i < last; ++i) sum += force(i);
    return sum;
  }
  /// Places the upper of two plates over the lower one.
  void bring(int first_upper, double gap, const Eigen::Vector2d& aside = {0.4e-3, 0.7e-3}) {
    for (std::size_t i = first_upper; i < count(); ++i)
      set(i, {rest.vertices[i].x() + aside.x(), rest.vertices[i].y() + aside.y(), gap});
  }
  void shake(double size, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(-size, size);
    for (double& value : at) value += uniform(random);
  }

  SurfaceMesh rest;
  SelfContact contact;
  std::array<std::vector<double>, 3> position, speed;  // at detect()
  std::vector<double> at;
  std::vector<float> gradient;
};

struct PressedPlates : ContactWorld {
  PressedPlates() : ContactWorld(plates(8, 6)) {
    bring(plateSize(8), 0.6 * kWallThickness);
    shake(0.2e-3, 1);
    detect(1e-3);
  }
};

}  // namespace vibe::test

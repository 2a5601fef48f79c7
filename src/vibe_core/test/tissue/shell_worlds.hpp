#pragma once
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "tissue/shell_kernel.hpp"
#include "vibe_core/tissue/shell.hpp"
#include "vibe_testing/element_worlds.hpp"

/// Walls and displacements for the tests of shells.
namespace vibe::test {

inline constexpr double kThickness = 0.003;

inline void finish(ShellMesh& mesh, Law law) {
  mesh.materials = {material(law)};
  mesh.thickness.assign(mesh.triangles.size(), kThickness);
}

/// A flat sheet in the plane z = 0 of squares cut in two, nodes numbered along y first.
/// @param alternate  the cuts turn from square to square
inline ShellMesh sheet(int along, int across, Law law = Law::NeoHookean, bool alternate = true) {
  ShellMesh mesh;
  for (int i = 0; i <= along; ++i)
    for (int k = 0; k <= across; ++k) mesh.nodes.emplace_back(kSide * i, kSide * k, 0);
  for (int i = 0; i < along; ++i)
    for (int k = 0; k < across; ++k) {
      const int a = i * (across + 1) + k, b = a + across + 1;
      if (!alternate || (i + k) % 2 == 0) {
        mesh.triangles.push_back({a, b, b + 1});
        mesh.triangles.push_back({a, b + 1, a + 1});
      } else {
        mesh.triangles.push_back({a, b, a + 1});
        mesh.triangles.push_back({b, b + 1, a + 1});
      }
    }
  finish(mesh, law);
  return mesh;
}

/// A sphere: an icosahedron whose triangles are cut in four so many times; counter-clockwise seen from outside.
inline ShellMesh sphere(int cuts, double radius, Law law = Law::NeoHookean) {
  const double g = (1 + std::sqrt(5.0)) / 2;
  ShellMesh mesh;
  mesh.nodes = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  mesh.triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                    {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                    {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  for (int cut = 0; cut < cuts; ++cut) {
    std::map<std::pair<int, int>, int> middle;
    std::vector<std::array<int, 3>> out;
    const auto between = [&](int a, int b) {
      const auto [it, is_new] = middle.insert({std::minmax(a, b), static_cast<int>(mesh.nodes.size())});
      if (is_new) {
        const Eigen::Vector3d sum = mesh.nodes[static_cast<std::size_t>(a)] + mesh.nodes[static_cast<std::size_t>(b)];
        mesh.nodes.push_back(sum / 2);
      }
      return it->second;
    };
    for (const auto& [a, b, c] : mesh.triangles) {
      const int ab = between(a, b), bc = between(b, c), ca = between(c, a);
      out.insert(out.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    mesh.triangles = out;
  }
  for (auto& node : mesh.nodes) node *= radius / node.norm();
  finish(mesh, law);
  return mesh;
}

/// Nodes moved by up to `amount`, so that no two triangles are alike.
inline ShellMesh shaken(ShellMesh mesh, double amount, bool flat = false) {
  std::mt19937 generator(3);
  std::uniform_real_distribution<double> uniform(-amount, amount);
  for (auto& node : mesh.nodes)
    for (int c = 0; c < (flat ? 2 : 3); ++c) node[c] += uniform(generator);
  return mesh;
}

/// A bumpy sheet with free and clamped sides and two hinges within, of two materials and thicknesses.
inline ShellMesh patchwork(Law law) {
  ShellMesh mesh = shaken(sheet(4, 3, law), 0.12 * kSide);
  mesh.materials.push_back({law, 2 * kE, 0.3, 0.5});
  mesh.fixed.assign(mesh.nodes.size(), 0);
  for (std::size_t i = 0; i < 4; ++i) mesh.fixed[i] = 1;
  mesh.material.assign(mesh.triangles.size(), 0);
  for (std::size_t e = 0; e < mesh.triangles.size(); e += 3) mesh.material[e] = 1, mesh.thickness[e] = 0.002;
  mesh.hinged = {{8, 9}, {9, 10}};
  return mesh;
}

/// x -> place(x)
inline Eigen::VectorXd displaced(const ShellMesh& mesh,
                                 const std::function<Eigen::Vector3d(const Eigen::Vector3d&)>& place) {
  Eigen::VectorXd u(3 * static_cast<Eigen::Index>(mesh.nodes.size()));
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i)
    u.segment<3>(3 * static_cast<Eigen::Index>(i)) = place(mesh.nodes[i]) - mesh.nodes[i];
  return u;
}
inline Eigen::VectorXd affine(const ShellMesh& mesh, const Eigen::Matrix3d& deformation) {
  return displaced(mesh, [&](const Eigen::Vector3d& x) -> Eigen::Vector3d { return deformation * x; });
}

struct Evaluation {
  double energy, volume;
  Eigen::VectorXd gradient, volume_gradient;
};

inline Evaluation inDouble(const ShellElements& elements, const Eigen::VectorXd& u) {
  Evaluation out{0, 0, Eigen::VectorXd(u.size()), Eigen::VectorXd(u.size())};
  out.energy = elements.evaluate(u.data(), out.gradient.data());
  out.volume = elements.volume(u.data(), out.volume_gradient.data());
  return out;
}

inline Eigen::VectorXd threeDoubles(const std::vector<float>& v) {
  Eigen::VectorXd out(static_cast<Eigen::Index>(v.size() / 4 * 3));
  for (Eigen::Index i = 0; i < out.size(); ++i) out[i] = v[static_cast<std::size_t>(i / 3 * 4 + i % 3)];
  return out;
}

/// All pieces into one output.
inline Evaluation inSingle(const ShellElements& elements, const Eigen::VectorXd& u) {
  const std::vector<float> in = fourFloats(u);
  std::vector<float> gradient(in.size(), 0.0f), volume_gradient(in.size(), 0.0f);
  Evaluation out{};
  for (int piece = 0; piece < elements.pieceCount(); ++piece)
    out.energy += elements.evaluate(piece, in.data(), gradient.data(), volume_gradient.data(), out.volume);
  out.gradient = threeDoubles(gradient);
  out.volume_gradient = threeDoubles(volume_gradient);
  return out;
}

/// A sheet with all kinds of side, and a closed surface, of every law.
inline void forAllShells(const std::function<void(const ShellElements&)>& check, ShellKernel kernel = shellKernel()) {
  for (const Law law : kLaws) {
    SCOPED_TRACE("law " + std::to_string(static_cast<int>(law)));
    {
      SCOPED_TRACE("patchwork");
      check(ShellElements(patchwork(law), {0.02, 0.01, 0}, kernel));
    }
    {
      SCOPED_TRACE("sphere");
      check(ShellElements(shaken(sphere(1, 2 * kSide, law), 0.1 * kSide), {0, 0, 0}, kernel));
    }
  }
}

}  // namespace vibe::test

#pragma once
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <array>
#include <functional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "tetrahedra/tetrahedra.hpp"
#include "vibe_testing/element_worlds.hpp"
#include "vibe_testing/tet_box.hpp"

/// Solids and displacements for the tests of tetrahedra.
namespace vibe::benchmarks::test {

using namespace vibe::test;

inline TetMesh<4> tetBox(std::array<int, 3> cubes, double side, const Material& material) {
  TetBox box = kuhnBox(cubes, side);
  TetMesh<4> mesh;
  mesh.nodes = std::move(box.nodes);
  mesh.elements = std::move(box.elements);
  mesh.materials = {material};
  return mesh;
}

/// Vertices moved by up to `amount`, so that no two elements are alike.
template <int Nodes>
TetMesh<Nodes> shaken(TetMesh<Nodes> mesh, double amount, unsigned seed = 3) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> uniform(-amount, amount);
  for (auto& node : mesh.nodes)
    for (int c = 0; c < 3; ++c) node[c] += uniform(generator);
  return mesh;
}

/// x -> F x
template <int Nodes>
Eigen::VectorXd affine(const TetMesh<Nodes>& mesh, const Eigen::Matrix3d& deformation) {
  Eigen::VectorXd u(3 * static_cast<Eigen::Index>(mesh.nodes.size()));
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i)
    u.segment<3>(3 * static_cast<Eigen::Index>(i)) = deformation * mesh.nodes[i] - mesh.nodes[i];
  return u;
}

struct TetEvaluation {
  double energy;
  Eigen::VectorXd gradient;
};

inline TetEvaluation inDouble(const ElasticElements& elements, const Eigen::VectorXd& u) {
  TetEvaluation out{0, Eigen::VectorXd(u.size())};
  out.energy = elements.evaluate(u.data(), out.gradient.data());
  return out;
}

/// All pieces into one output.
inline TetEvaluation inSingle(const ElasticElements& elements, const Eigen::VectorXd& u) {
  const std::vector<float> in = fourFloats(u);
  std::vector<float> gradient(in.size(), 0.0f);
  TetEvaluation out{0, Eigen::VectorXd(u.size())};
  for (int piece = 0; piece < elements.pieceCount(); ++piece)
    out.energy += elements.evaluate(piece, in.data(), gradient.data());
  for (Eigen::Index i = 0; i < u.size(); ++i) out.gradient[i] = gradient[static_cast<std::size_t>(i / 3 * 4 + i % 3)];
  return out;
}

inline TetMesh<4> linearMesh(Law law, std::array<int, 3> cubes = {2, 1, 1}) {
  return shaken(tetBox(cubes, kSide, material(law)), 0.1 * kSide);
}
inline TetMesh<10> straightMesh(Law law, std::array<int, 3> cubes = {2, 1, 1}) {
  return quadraticMesh(linearMesh(law, cubes)).mesh;
}
inline TetMesh<10> curvedMesh(Law law, std::array<int, 3> cubes = {2, 1, 1}) {
  return shaken(straightMesh(law, cubes), 0.04 * kSide);
}

// All kinds of element, of every law.
inline void forAllElements(
    const std::function<void(const ElasticElements&, const std::vector<Eigen::Vector3d>&)>& check,
    std::array<int, 3> cubes = {2, 1, 1}) {
  for (const Law law : kLaws) {
    const TetElements<4> linear(linearMesh(law, cubes));
    const TetElements<10> straight(straightMesh(law, cubes)), curved(curvedMesh(law, cubes));
    const std::string name = "law " + std::to_string(static_cast<int>(law));
    {
      SCOPED_TRACE(name + ", linear");
      check(linear, linear.mesh().nodes);
    }
    {
      SCOPED_TRACE(name + ", straight quadratic");
      check(straight, straight.mesh().nodes);
    }
    {
      SCOPED_TRACE(name + ", curved quadratic");
      check(curved, curved.mesh().nodes);
    }
  }
}

}  // namespace vibe::benchmarks::test

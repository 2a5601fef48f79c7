#pragma once
#include <Eigen/Dense>
#include <memory>
#include <random>
#include <vector>

#include "vibe_core/scene/tissue_choices.hpp"
#include "vibe_core/tissue/elastic_elements.hpp"
#include "vibe_core/tissue/material_registry.hpp"

/// Materials and displacements for the tests of shells and of tetrahedra.
namespace vibe::test {

/// Young's modulus [Pa], Poisson's ratio and side of an element [m].
inline constexpr double kE = 3e4, kNu = 0.45, kSide = 0.01;
/// One entry of kLaws.
#define VIBE_LAW(name, word, formula) Law::name,
inline const std::vector<Law> kLaws = {VIBE_MATERIAL_LAWS(VIBE_LAW)};  ///< every law of the list
#undef VIBE_LAW

/// The material of these tests with this law.
inline Material material(Law law) {
  return {law, kE, kNu, 0.8};
}

/// Three numbers per node, uniform in [-amount, amount) [m]; the same for the same seed.
inline Eigen::VectorXd randomDisplacement(int nodes, double amount, unsigned seed = 5) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> uniform(-amount, amount);
  Eigen::VectorXd u(3 * nodes);
  for (double& value : u) value = uniform(generator);
  return u;
}

/// A large rotation about no axis of coordinates.
inline Eigen::Matrix3d someRotation() {
  return Eigen::AngleAxisd(2.1, Eigen::Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();
}

/// Node by node in groups of four floats, the fourth 0, as elements with single precision read them.
inline std::vector<float> fourFloats(const Eigen::VectorXd& u) {
  std::vector<float> out(static_cast<std::size_t>(u.size() / 3 * 4), 0.0f);
  for (Eigen::Index i = 0; i < u.size(); ++i)
    out[static_cast<std::size_t>(i / 3 * 4 + i % 3)] = static_cast<float>(u[i]);
  return out;
}

/// The stiffness matrix of all elements in the state `u`, column by column [N/m].
inline Eigen::MatrixXd denseStiffness(const ElasticElements& elements, const Eigen::VectorXd& u) {
  const auto pattern = std::make_shared<BlockPattern>(blockPattern(elements.nodeCount(), elements.nodeGroups()));
  BlockMatrix stiffness(pattern);
  stiffness.setZero();
  elements.addStiffness(u.data(), stiffness);
  Eigen::MatrixXd out(u.size(), u.size());
  Eigen::VectorXd unit = Eigen::VectorXd::Zero(u.size());
  for (Eigen::Index i = 0; i < u.size(); ++i) {
    unit[i] = 1;
    stiffness.multiply(unit.data(), out.col(i).data());
    unit[i] = 0;
  }
  return out;
}

}  // namespace vibe::test

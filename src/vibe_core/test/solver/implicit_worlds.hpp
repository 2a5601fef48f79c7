#pragma once
#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "solver/linear_tetrahedra.hpp"
#include "vibe_core/solver/implicit_stepper.hpp"
#include "vibe_testing/element_worlds.hpp"

/// Solid bodies for the tests of implicit steps.
namespace vibe::test {

inline constexpr double kDensity = 1000;

/// A block of linear tetrahedra, nothing held.
inline ElasticBody block(std::array<int, 3> cubes, const Material& of, double side = kSide) {
  const auto elements = std::make_shared<const LinearTetrahedra>(tetBox(cubes, side, of));
  ElasticBody body;
  body.elements = elements;
  body.rest = elements->mesh().nodes;
  body.mass = elements->lumpedMass(kDensity);
  body.fixed.assign(body.rest.size(), 0);
  return body;
}

inline Material neoHookean(double nu = kNu) {
  return {Law::NeoHookean, kE, nu, 0};
}

/// Held at x = 0.
inline ElasticBody cantilever(std::array<int, 3> cubes = {6, 2, 2}) {
  ElasticBody body = block(cubes, neoHookean());
  for (std::size_t i = 0; i < body.rest.size(); ++i) body.fixed[i] = body.rest[i].x() < 1e-9 ? 1 : 0;
  return body;
}

/// A stepper with one motion, and what both need.
struct Body {
  explicit Body(ElasticBody body, StepSettings settings = {}, FactorStorage storage = FactorStorage::Half)
      : stepper(std::move(body), settings, storage), motion(stepper.body()), scratch(stepper.makeWorkspace()) {}

  StepOutcome step() { return stepper.step(motion.view(), loads, memory, *scratch); }
  StepOutcome settle(double tolerance = 1e-8) { return stepper.settle(motion.view(), loads, *scratch, tolerance); }

  Eigen::Vector3d position(int i) const { return {motion.x[0][i], motion.x[1][i], motion.x[2][i]}; }
  Eigen::Vector3d velocity(int i) const { return {motion.v[0][i], motion.v[1][i], motion.v[2][i]}; }
  int nodes() const { return stepper.body().nodeCount(); }

  struct Elastic {
    double energy;             // [J]
    Eigen::VectorXd gradient;  // [N]
  };
  Elastic elastic() const {
    Eigen::VectorXd u(3 * nodes());
    for (int i = 0; i < nodes(); ++i) u.segment<3>(3 * i) = position(i) - stepper.body().rest[i];
    Elastic out{0, Eigen::VectorXd(u.size())};
    out.energy = stepper.body().elements->evaluate(u.data(), out.gradient.data());
    return out;
  }
  double kinetic() const {
    double sum = 0;
    for (int i = 0; i < nodes(); ++i) sum += 0.5 * stepper.body().mass[i] * velocity(i).squaredNorm();
    return sum;
  }
  Eigen::Vector3d momentum() const {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (int i = 0; i < nodes(); ++i) sum += stepper.body().mass[i] * velocity(i);
    return sum;
  }
  Eigen::Vector3d angularMomentum() const {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (int i = 0; i < nodes(); ++i) sum += stepper.body().mass[i] * position(i).cross(velocity(i));
    return sum;
  }
  double mass() const {
    double sum = 0;
    for (double m : stepper.body().mass) sum += m;
    return sum;
  }

  ImplicitStepper stepper;
  BodyMotion motion;
  BodyLoads loads;
  StepperMemory memory;
  std::shared_ptr<StepperWorkspace> scratch;
};

inline bool sameBits(const BodyMotion& a, const BodyMotion& b) {
  return a.x == b.x && a.v == b.v && a.a == b.a;
}

}  // namespace vibe::test

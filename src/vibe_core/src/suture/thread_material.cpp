#include "vibe_core/suture/thread_material.hpp"
#include "common/constants.hpp"

namespace vibe {

namespace {
constexpr double kNewtonsPerKilogramForce = 9.80665;
}  // namespace

double ThreadMaterial::crossSection() const {
  return 0.25 * kPi * diameter * diameter;
}

double ThreadMaterial::massPerLength() const {
  return density * crossSection();
}

double ThreadMaterial::weightPerLength(double gravity) const {
  return massPerLength() * gravity;
}

double ThreadMaterial::axialStiffness() const {
  return elastic_modulus * crossSection();
}

ThreadMaterial polypropylene20() {
  ThreadMaterial thread;
  thread.diameter = 0.5 * (0.300e-3 + 0.339e-3);
  thread.density = 905;
  thread.elastic_modulus = 4.026e9;
  thread.breaking_force = 1.44 * kNewtonsPerKilogramForce;
  thread.tissue_friction = 0.15;
  return thread;
}

}  // namespace vibe

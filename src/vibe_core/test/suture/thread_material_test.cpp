#include "vibe_core/suture/suture_thread.hpp"

#include <gtest/gtest.h>

namespace vibe::thread_material_test {
namespace {

TEST(ThreadMaterial, IsWithinThePharmacopoeia) {
  const ThreadMaterial thread = polypropylene20();
  EXPECT_GE(thread.diameter, 0.300e-3);
  EXPECT_LE(thread.diameter, 0.339e-3);
  EXPECT_NEAR(thread.breaking_force, 14.1, 0.05);
}

TEST(ThreadMaterial, WeighsAndStretchesAsItsSection) {
  // A rod of 2 mm diameter: pi square millimetres.
  const ThreadMaterial rod{2e-3, 1000, 1e9, 1, 0};
  EXPECT_NEAR(rod.crossSection(), 3.14159265e-6, 1e-13);
  EXPECT_NEAR(rod.massPerLength(), 3.14159265e-3, 1e-10);
  EXPECT_NEAR(rod.weightPerLength(10), 3.14159265e-2, 1e-9);
  EXPECT_NEAR(rod.axialStiffness(), 3141.59265, 1e-4);
}

TEST(ThreadMaterial, BreaksBelowItsStraightStrength) {
  // The same five sutures broke straight at 876 MPa: a knot weakens, it cannot strengthen.
  const ThreadMaterial thread = polypropylene20();
  EXPECT_LT(thread.breaking_force, 875.8e6 * thread.crossSection());
}

}  // namespace
}  // namespace vibe::thread_material_test

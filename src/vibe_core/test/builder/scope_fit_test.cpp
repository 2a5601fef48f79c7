#include "vibe_core/builder/scope_fit.hpp"

#include <gtest/gtest.h>

#include <cstdio>

#include "vibe_core/builder/model_builder.hpp"
#include "vibe_testing/scope_fixture.hpp"

namespace vibe::scope_fit_test {
namespace {

/// The text of the scope's URDF, whose device has another radius [m].
std::string scopeOfRadius(double radius) {
  std::string text = scopeText();
  const std::string old = "radius=\"0.0079\"";
  char wide[40];
  std::snprintf(wide, sizeof wide, "radius=\"%.4f\"", radius);
  for (std::size_t at = 0; (at = text.find(old, at)) != std::string::npos; ++at) text.replace(at, old.size(), wide);
  return text;
}

Scene stomach() {
  Scene scene;
  scene.geometry.particles = 1000;
  scene.tissue.model = "shell";
  scene.attach_oesophagus = true;
  scene.scope = ScopeScene{};
  return scene;
}

std::string warningFor(const Scene& scene, double radius) {
  return fitWarning(*buildModel(scene, scopeOfRadius(radius)));
}

TEST(ScopeFit, SaysWhatIsTooWideForTheOpenEnd) {
  EXPECT_EQ(warningFor(stomach(), 14e-3), "");
  const std::string text = warningFor(stomach(), 16e-3);
  EXPECT_NE(text.find("link 'device_cap' of package://vibe_description/urdf/scope.urdf is 32.0 mm wide"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("make the collision shapes of the URDF narrower"), std::string::npos) << text;
}

TEST(ScopeFit, TheScopeThatShipsFits) {
  EXPECT_EQ(warningFor(stomach(), 7.9e-3), "");
}

TEST(ScopeFit, SaysNothingWhereNothingHoldsTheEnd) {
  Scene free = stomach();
  free.attach_oesophagus = false;
  EXPECT_EQ(warningFor(free, 16e-3), "");
  Scene elsewhere = stomach();
  elsewhere.scope->base_from_anatomy = false;
  EXPECT_EQ(warningFor(elsewhere, 16e-3), "");
  Scene without = stomach();
  without.scope.reset();
  EXPECT_EQ(fitWarning(*buildModel(without, "")), "");
}

}  // namespace
}  // namespace vibe::scope_fit_test

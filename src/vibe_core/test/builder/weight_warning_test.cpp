// A gravity that is stated acts on the wall, or the scene is told that it does not.
#include <gtest/gtest.h>

#include "vibe_core/builder/model_builder.hpp"
#include "vibe_core/scene/scene_parser.hpp"
#include "vibe_core/simulation/simulation.hpp"

namespace vibe::weight_warning_test {
namespace {

std::shared_ptr<const Model> modelOf(const std::string& sections) {
  return buildModel(
      parseScene("geometry: {kind: sphere, particles: 200}\ntissue: {model: shell}\n" + sections, "s.yaml"), "");
}

/// Hash after a tenth of a second.
std::uint64_t fallen(const std::shared_ptr<const Model>& model) {
  Simulation simulation(model);
  for (int k = 0; k < 6; ++k) simulation.step();
  return simulation.hash();
}

TEST(WeightWarning, AStatedGravityActsOrItIsSaidThatItDoesNot) {
  int acts = 0, told = 0;
  for (const std::string foundation : {"", "foundation: {}\n", "foundation: {carries_weight: false}\n"}) {
    const std::uint64_t without = fallen(modelOf(foundation));
    for (const std::string acceleration : {"0, 9.81, 0", "0, 0, -100", "-9.81, 0, 1"}) {
      const auto model = modelOf(foundation + "gravity: {acceleration: [" + acceleration + "]}\n");
      const bool silent = weightWarning(*model).empty();
      EXPECT_EQ(fallen(model) != without, silent) << foundation << acceleration;
      EXPECT_EQ(warningsAbout(*model).size(), silent ? 0u : 1u);
      acts += silent, told += !silent;
    }
  }
  EXPECT_EQ(acts, 6);
  EXPECT_EQ(told, 3);
}

TEST(WeightWarning, NamesTheRemedyAndIsSilentUnderTheDefaultGravity) {
  EXPECT_EQ(weightWarning(*modelOf("foundation: {}\ngravity: {}\n")), "");
  const std::string text = weightWarning(*modelOf("foundation: {}\ngravity: {acceleration: [0, 9.81, 0]}\n"));
  EXPECT_NE(text.find("set foundation.carries_weight: false"), std::string::npos) << text;
}

}  // namespace
}  // namespace vibe::weight_warning_test

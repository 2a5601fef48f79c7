// Whole steps give the same bits with every instruction set; scripts/test.d/plain_cmake.sh compares compilers too.
#include <gtest/gtest.h>

#include <vector>

#include "solver/pulled_sheet.hpp"
#include "vibe_core/arithmetic/machine.hpp"
#include "vibe_testing/scope_worlds.hpp"

namespace vibe::same_bits_test {
namespace {

using test::World;

/// A scope that gives way presses on a ball with gas and gravity, turns its tip, and withdraws.
std::uint64_t afterAPress() {
  Scene scene;
  scene.tissue.model = "shell";
  scene.gravity = GravityScene{};
  scene.foundation = FoundationScene{};
  scene.gas = GasScene{};
  scene.scope = test::scopeFromAbove(0.06);
  scene.scope->compliance = ScopeComplianceScene{};
  scene.helix = test::firmHelix();
  World world = test::scopeWorld(scene, test::openBall(0.06, 3, 2e-3));
  int touched = 0;
  for (int i = 0; i < 200; ++i) {
    StepInput input = test::scopeAt(0.06 + 0.07 * std::min(i, 300 - 2 * i) / 100.0, 1, i > 110);
    input.joints[TipUpDown] = 0.004 * i;
    world.step(input);
    touched += world.state.contact_count > 0 ? 1 : 0;
  }
  EXPECT_GT(touched, 20);
  return hash(world.state);
}

/// A thread draws three bites of a sheet together.
std::uint64_t afterAPull(const std::string& model) {
  test::PulledSheet sheet(test::sheetScene(model, "thread"), 4);
  sheet.draw(8e-3);
  sheet.run(1);
  EXPECT_GT(sheet.maxShift(), 1e-3);
  return hash(sheet.state);
}

std::vector<std::uint64_t> allHashes() {
  return {afterAPress(), afterAPull("shell"), afterAPull("shape_matching")};
}

/// Runs with an arithmetic and an instruction set, and restores what was chosen.
std::vector<std::uint64_t> hashesWith(Arithmetic wanted, InstructionSet set) {
  const Arithmetic before = arithmetic();
  setArithmetic(wanted);
  setInstructionSet(set);
  const std::vector<std::uint64_t> hashes = allHashes();
  setArithmetic(before);
  setInstructionSet(widestInstructionSet());
  return hashes;
}

const std::vector<std::uint64_t>& emulatedHashes() {
  static const std::vector<std::uint64_t> hashes = hashesWith(Arithmetic::Fused, InstructionSet::Sse2);
  return hashes;
}

TEST(SameBits, InAllInstructionSets) {
  for (const InstructionSet set : {InstructionSet::Avx2, InstructionSet::Avx512}) {
    if (set > widestInstructionSet()) continue;
    EXPECT_EQ(hashesWith(Arithmetic::Fused, set), emulatedHashes()) << wordFor(set);
  }
}

TEST(SameBits, PlainArithmeticHasItsOwn) {
  const std::vector<std::uint64_t> plain = hashesWith(Arithmetic::Plain, widestInstructionSet());
  EXPECT_NE(emulatedHashes()[0], plain[0]) << "the press: a shell";
  EXPECT_NE(emulatedHashes()[1], plain[1]) << "the thread in a shell";
  EXPECT_EQ(emulatedHashes()[2], plain[2]) << "shape matching has no fused operations";
}

}  // namespace
}  // namespace vibe::same_bits_test

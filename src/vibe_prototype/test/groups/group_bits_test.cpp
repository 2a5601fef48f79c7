// What groups pull has the same bits with every instruction set.
#include <gtest/gtest.h>

#include <map>

#include "solver/pulled_sheet.hpp"
#include "vibe_core/arithmetic/machine.hpp"

namespace vibe::prototype::group_bits_test {
namespace {

std::uint64_t hashWith(const std::string& model, Arithmetic wanted, InstructionSet set) {
  const Arithmetic before = arithmetic();
  setArithmetic(wanted);
  setInstructionSet(set);
  test::PulledSheet sheet(test::sheetScene(model, "groups"), 4);
  sheet.draw(8e-3);
  sheet.run(1);
  EXPECT_GT(sheet.maxShift(), 1e-3);
  setArithmetic(before);
  setInstructionSet(widestInstructionSet());
  return hash(sheet.state);
}

TEST(GroupBits, AreTheSameInAllInstructionSets) {
  for (const std::string model : {"shell", "shape_matching"}) {
    const std::uint64_t emulated = hashWith(model, Arithmetic::Fused, InstructionSet::Sse2);
    EXPECT_EQ(hashWith(model, Arithmetic::Fused, widestInstructionSet()), emulated) << model;
    const std::uint64_t plain = hashWith(model, Arithmetic::Plain, widestInstructionSet());
    EXPECT_EQ(plain == emulated, model == "shape_matching") << "which has no fused operations";
  }
}

}  // namespace
}  // namespace vibe::prototype::group_bits_test

#include "vibe_core/arithmetic/machine.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

#include "arithmetic/kernel_path.hpp"
#include "arithmetic/multiply_add.hpp"
#include "environment_variable.hpp"
#include "vibe_core/arithmetic/random.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe::arithmetic_test {
namespace {

std::string inUse() {
  return std::string(wordFor(arithmetic())) + " " + wordFor(instructionSet());
}

/// In a child process, because the environment is read once per process.
#define EXPECT_ANSWER(arithmetic_word, instructions_word, expected)                 \
  {                                                                                 \
    const test::EnvironmentVariable first("VIBE_ARITHMETIC", arithmetic_word);      \
    const test::EnvironmentVariable second("VIBE_INSTRUCTIONS", instructions_word); \
    EXPECT_EXIT(                                                                    \
        {                                                                           \
          try {                                                                     \
            std::fputs(inUse().c_str(), stderr);                                    \
          } catch (const Error& error) {                                            \
            std::fputs(error.what(), stderr);                                       \
          }                                                                         \
          std::exit(0);                                                             \
        },                                                                          \
        ::testing::ExitedWithCode(0), expected);                                    \
  }

TEST(ArithmeticDeathTest, EnvironmentChooses) {
  EXPECT_ANSWER("plain", "", "^plain sse2$");
  EXPECT_ANSWER("fused", "sse2", "^fused sse2$");
  EXPECT_ANSWER("", "", widestInstructionSet() == InstructionSet::Sse2 ? "^plain sse2$" : "^fused avx");
  EXPECT_ANSWER("exact", "", "VIBE_ARITHMETIC is 'exact'; it must be fused or plain, or absent\\.$");
  EXPECT_ANSWER("", "mmx", "VIBE_INSTRUCTIONS is 'mmx'; it must be sse2, avx2 or avx512, or absent\\.$");
  const bool wide = widestInstructionSet() != InstructionSet::Sse2;
  EXPECT_ANSWER("fused", "avx2", wide ? "^fused avx2$" : "but the processor has no avx2; choose sse2\\.$");
}

TEST(Arithmetic, ProgramsChoose) {
  const Arithmetic before = arithmetic();
  setArithmetic(Arithmetic::Plain);
  EXPECT_EQ(kernelPath(), KernelPath::Plain);
  EXPECT_EQ(instructionSet(), InstructionSet::Sse2);
  setArithmetic(Arithmetic::Fused);
  setInstructionSet(InstructionSet::Sse2);
  EXPECT_EQ(kernelPath(), KernelPath::FusedSse2);
  setInstructionSet(widestInstructionSet());
  if (widestInstructionSet() != InstructionSet::Sse2) {
    EXPECT_NE(kernelPath(), KernelPath::FusedSse2);
  }
  if (widestInstructionSet() != InstructionSet::Avx512) {
    EXPECT_THROW(setInstructionSet(InstructionSet::Avx512), Error);
  }
  setArithmetic(before);
}

TEST(Arithmetic, MachineInfoSaysWhatIsInUse) {
  const MachineInfo info = machineInfo();
  EXPECT_EQ(info.arithmetic, wordFor(arithmetic()));
  EXPECT_EQ(info.instruction_set, wordFor(instructionSet()));
  EXPECT_NE(info.compiler.find("++ "), std::string::npos) << info.compiler;
  EXPECT_NE(info.compiler.find(" with Eigen "), std::string::npos) << info.compiler;
  EXPECT_EQ(info.c_library.rfind("glibc ", 0), 0U) << info.c_library;
  EXPECT_FALSE(info.version.empty() || info.os.empty() || info.processor.empty());
  EXPECT_GT(info.cores, 0);
}

/// Finite floats of all sizes, often of neighbouring exponents, so that sums cancel.
float anyFloat(std::uint64_t& state) {
  const auto bits = static_cast<std::uint32_t>(nextInteger(state));
  const std::uint32_t narrow = (bits & 0x80ffffff) | 0x3f000000, exponent = bits >> 23 & 0xff;
  const std::uint32_t chosen = nextInteger(state) % 4 == 0 && exponent != 0xff ? bits : narrow;
  float x;
  std::memcpy(&x, &chosen, sizeof x);
  return x;
}

TEST(MultiplyAdd, EmulationIsExact) {
  std::uint64_t state = 1;
  int twice_rounded = 0;
  for (int i = 0; i < 1000000; ++i) {
    float a[4], b[4], c[4], out[4];
    for (int k = 0; k < 4; ++k) {
      a[k] = anyFloat(state), b[k] = anyFloat(state), c[k] = anyFloat(state);
      if (k % 2 == 0) c[k] = -std::nextafter(a[k] * b[k], c[k]);  // what is left has few bits
    }
    const auto load = [](const float* from) { return FusedFloats::load_unaligned(from); };
    mulAdd(load(a), load(b), load(c)).store_unaligned(out);
    for (int k = 0; k < 4; ++k) {
      const float exact = std::fma(a[k], b[k], c[k]);
      ASSERT_EQ(std::memcmp(&out[k], &exact, sizeof exact), 0) << a[k] << ' ' << b[k] << ' ' << c[k];
      twice_rounded += exact != a[k] * b[k] + c[k] ? 1 : 0;
    }
    minusMul(load(a), load(b), load(c)).store_unaligned(out);
    for (int k = 0; k < 4; ++k) ASSERT_EQ(out[k], std::fma(-a[k], b[k], c[k]));
  }
  EXPECT_GT(twice_rounded, 100000) << "rounding twice is noticed";
}

// 2^-24 + 2^-60 more than 1 is above the middle of two floats; in double precision it is the middle.
TEST(MultiplyAdd, EmulationRoundsOnce) {
  const float a = 0x1001p-30f, b = 0xfff001p-30f;
  float out[4];
  mulAdd(FusedFloats(a), FusedFloats(b), FusedFloats(1.0f)).store_unaligned(out);
  EXPECT_EQ(out[0], 1 + 0x1p-23f);
  EXPECT_EQ(static_cast<float>(static_cast<double>(a) * static_cast<double>(b) + 1.0), 1.0f) << "rounded twice";
}

}  // namespace
}  // namespace vibe::arithmetic_test

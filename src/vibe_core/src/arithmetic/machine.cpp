#include "vibe_core/arithmetic/machine.hpp"

#include <array>
#include <atomic>
#include <cstdlib>
#include <fstream>
#include <string>
#include <thread>

#include <gnu/libc-version.h>

#include <Eigen/Core>

#include "arithmetic/kernel_path.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe {

namespace {

// every processor with AVX2 also has the conversions of F16C
bool haveFma() {
  return __builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("fma") != 0;
}

bool haveAvx512() {
  return haveFma() && __builtin_cpu_supports("avx512f") != 0 && __builtin_cpu_supports("avx512vl") != 0 &&
         __builtin_cpu_supports("avx512bw") != 0 && __builtin_cpu_supports("avx512dq") != 0 &&
         __builtin_cpu_supports("avx512cd") != 0;
}

void checkSupport(InstructionSet wanted, const std::string& place) {
  if (wanted > widestInstructionSet())
    throw Error(place + "the processor has no " + wordFor(wanted) + "; choose " + wordFor(widestInstructionSet()) +
                (widestInstructionSet() == InstructionSet::Sse2 ? "." : " or less."));
}

Arithmetic initialArithmetic() {
  const char* variable = std::getenv("VIBE_ARITHMETIC");
  if (variable == nullptr || *variable == '\0') return haveFma() ? Arithmetic::Fused : Arithmetic::Plain;
  for (const Arithmetic one : {Arithmetic::Fused, Arithmetic::Plain})
    if (std::string(variable) == wordFor(one)) return one;
  throw Error("The environment variable VIBE_ARITHMETIC is '" + std::string(variable) +
              "'; it must be fused or plain, or absent.");
}

InstructionSet initialInstructionSet() {
  const char* variable = std::getenv("VIBE_INSTRUCTIONS");
  if (variable == nullptr || *variable == '\0') return widestInstructionSet();
  for (const InstructionSet one : {InstructionSet::Sse2, InstructionSet::Avx2, InstructionSet::Avx512})
    if (std::string(variable) == wordFor(one)) {
      checkSupport(one, "The environment variable VIBE_INSTRUCTIONS is " + std::string(variable) + ", but ");
      return one;
    }
  throw Error("The environment variable VIBE_INSTRUCTIONS is '" + std::string(variable) +
              "'; it must be sse2, avx2 or avx512, or absent.");
}

/// Read by every part that has kernels when it is made, in any thread.
std::atomic<Arithmetic>& chosenArithmetic() {
  static std::atomic<Arithmetic> chosen{initialArithmetic()};
  return chosen;
}

std::atomic<InstructionSet>& chosenInstructionSet() {
  static std::atomic<InstructionSet> chosen{initialInstructionSet()};
  return chosen;
}

}  // namespace

const char* wordFor(Arithmetic arithmetic) {
  return arithmetic == Arithmetic::Fused ? "fused" : "plain";
}

const char* wordFor(InstructionSet instruction_set) {
  return instruction_set == InstructionSet::Avx512 ? "avx512"
         : instruction_set == InstructionSet::Avx2 ? "avx2"
                                                   : "sse2";
}

Arithmetic arithmetic() {
  return chosenArithmetic();
}

void setArithmetic(Arithmetic arithmetic) {
  chosenArithmetic() = arithmetic;
}

InstructionSet widestInstructionSet() {
  return haveAvx512() ? InstructionSet::Avx512 : haveFma() ? InstructionSet::Avx2 : InstructionSet::Sse2;
}

InstructionSet instructionSet() {
  const InstructionSet chosen = chosenInstructionSet();  // also with plain arithmetic: a wrong word is an error
  return arithmetic() == Arithmetic::Fused ? chosen : InstructionSet::Sse2;
}

void setInstructionSet(InstructionSet instruction_set) {
  checkSupport(instruction_set, "This instruction set cannot be used: ");
  chosenInstructionSet() = instruction_set;
}

KernelPath kernelPath() {
  switch (instructionSet()) {
    case InstructionSet::Avx512:
      return KernelPath::Avx512;
    case InstructionSet::Avx2:
      return KernelPath::Avx2;
    default:
      return arithmetic() == Arithmetic::Fused ? KernelPath::FusedSse2 : KernelPath::Plain;
  }
}

namespace {

/// What follows `key` and the separator in the first line of a file that begins with it; without quotes.
std::string valueIn(const char* file, const std::string& key, char separator) {
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    const std::size_t at = line.find(separator);
    if (line.compare(0, key.size(), key) != 0 || at == std::string::npos) continue;
    const std::size_t first = line.find_first_not_of(" \t\"", at + 1), last = line.find_last_not_of(" \t\"");
    return first == std::string::npos ? "" : line.substr(first, last - first + 1);
  }
  return "";
}

std::string eigenVersion() {
#ifdef EIGEN_PATCH_VERSION  // since version 5, which leaves the first number at 3
  const std::array version{EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION, EIGEN_PATCH_VERSION};
#else
  const std::array version{EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION};
#endif
  return "Eigen " + std::to_string(version[0]) + "." + std::to_string(version[1]) + "." + std::to_string(version[2]);
}

std::string compilerName() {
#ifdef __clang__
  return "clang++ " + std::to_string(__clang_major__) + "." + std::to_string(__clang_minor__) + "." +
         std::to_string(__clang_patchlevel__);
#else
  return "g++ " + std::to_string(__GNUC__) + "." + std::to_string(__GNUC_MINOR__) + "." +
         std::to_string(__GNUC_PATCHLEVEL__);
#endif
}

}  // namespace

MachineInfo machineInfo() {
  MachineInfo info;
  info.version = VIBE_CORE_VERSION;
  info.compiler = compilerName() + " with " + eigenVersion();
  info.c_library = std::string("glibc ") + gnu_get_libc_version();
  info.os = valueIn("/etc/os-release", "PRETTY_NAME", '=');
  info.processor = valueIn("/proc/cpuinfo", "model name", ':');
  info.cores = static_cast<int>(std::thread::hardware_concurrency());
  info.instruction_set = wordFor(instructionSet());
  info.arithmetic = wordFor(arithmetic());
  return info;
}

}  // namespace vibe

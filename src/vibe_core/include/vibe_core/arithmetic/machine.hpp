#pragma once

#include <string>

namespace vibe {

/// How the kernels (tissue, sparse factor) compute a b + c. Every kernel gives the same bits with every instruction
/// set; the bits depend on this only.
enum class Arithmetic {
  Fused,  ///< rounded once; fast where the processor has fused multiply-add (FMA), emulated elsewhere
  Plain   ///< rounded twice; fast where the processor has no FMA
};

/// What the kernels are made of. Avx2 needs AVX2 and FMA, Avx512 the parts F, VL, BW, DQ and CD of AVX-512 too.
enum class InstructionSet { Sse2, Avx2, Avx512 };

const char* wordFor(Arithmetic arithmetic);           ///< "fused" or "plain"
const char* wordFor(InstructionSet instruction_set);  ///< "sse2", "avx2" or "avx512"

/// The choice of this process. Without another choice: fused where the processor has FMA, else plain; the environment
/// variable VIBE_ARITHMETIC (fused or plain) comes before that, setArithmetic() before both. Models, simulations and
/// their parts keep what was chosen when they were made.
/// @throws Error if the variable has another value
Arithmetic arithmetic();

/// Call it before models are made, for example with what a recording says.
void setArithmetic(Arithmetic arithmetic);

/// The instruction set in use: the widest that this machine supports, or that of the environment variable
/// VIBE_INSTRUCTIONS (sse2, avx2 or avx512) or of setInstructionSet(); with plain arithmetic always SSE2, for which
/// alone its kernels exist. It makes a difference for speed only.
/// @throws Error if the variable has another value, or one that this machine does not support
InstructionSet instructionSet();

/// @throws Error if this machine does not support it
void setInstructionSet(InstructionSet instruction_set);

/// The widest that this machine supports.
InstructionSet widestInstructionSet();

/// What a session ran on and with, for its records. A text is empty where the system does not tell.
struct MachineInfo {
  std::string version;          ///< of this library
  std::string compiler;         ///< of this library and its Eigen, for example "g++ 12.2.0 with Eigen 3.4.0"
  std::string c_library;        ///< in use, for example "glibc 2.36"
  std::string os;               ///< name and version of the distribution
  std::string processor;        ///< its model name
  int cores = 0;                ///< logical processors; 0: unknown
  std::string instruction_set;  ///< of the kernels: "sse2", "avx2" or "avx512"
  std::string arithmetic;       ///< of the kernels: "fused" or "plain"
};

/// @throws Error as arithmetic() and instructionSet()
MachineInfo machineInfo();

}  // namespace vibe

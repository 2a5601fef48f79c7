#pragma once

#include <string>

namespace vibe {

/// What a session ran on and with, for its records. A text is empty where the system does not tell.
struct MachineInfo {
  std::string version;          ///< of this library
  std::string compiler;         ///< of this library, for example "g++ 12.2.0"
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

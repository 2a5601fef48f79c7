#include "vibe_core/common/machine_info.hpp"

#include <gnu/libc-version.h>

#include <fstream>
#include <thread>

#include "vibe_core/common/arithmetic.hpp"

namespace vibe {
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
  info.compiler = compilerName();
  info.c_library = std::string("glibc ") + gnu_get_libc_version();
  info.os = valueIn("/etc/os-release", "PRETTY_NAME", '=');
  info.processor = valueIn("/proc/cpuinfo", "model name", ':');
  info.cores = static_cast<int>(std::thread::hardware_concurrency());
  info.instruction_set = wordFor(instructionSet());
  info.arithmetic = wordFor(arithmetic());
  return info;
}

}  // namespace vibe

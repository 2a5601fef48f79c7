#include <cinttypes>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "qemu_plugin.hpp"

// Plugin of QEMU that counts the instructions between two addresses, both included, each time the first one is reached:
//
//   -plugin count_instructions.so,first=0x1234,last=0x5678
//
// When the emulation ends it prints "count_instructions: calls N, shortest N, longest N, mean N" to standard error.
// Instructions of interrupts in between count too.

namespace {

std::uint64_t first_address = 0;
std::uint64_t last_address = 0;

struct Statistics {
  bool counting = false;
  std::uint64_t instructions = 0;  // of the present call
  std::uint64_t calls = 0;
  std::uint64_t shortest = UINT64_MAX;
  std::uint64_t longest = 0;
  std::uint64_t total = 0;

  void execute(std::uint64_t address) {
    if (address == first_address) {
      counting = true;
      instructions = 0;
    }
    if (!counting) return;
    ++instructions;
    if (address == last_address) finish();
  }

  void finish() {
    counting = false;
    ++calls;
    total += instructions;
    if (instructions < shortest) shortest = instructions;
    if (instructions > longest) longest = instructions;
  }
};
Statistics statistics;

void executed(unsigned, void* address) {
  statistics.execute(reinterpret_cast<std::uintptr_t>(address));
}

void translated(qemu_plugin_id_t, qemu_plugin_tb* block) {
  const std::size_t count = qemu_plugin_tb_n_insns(block);
  for (std::size_t i = 0; i < count; ++i) {
    qemu_plugin_insn* instruction = qemu_plugin_tb_get_insn(block, i);
    auto* address = reinterpret_cast<void*>(static_cast<std::uintptr_t>(qemu_plugin_insn_vaddr(instruction)));
    qemu_plugin_register_vcpu_insn_exec_cb(instruction, executed, kQemuPluginNoRegisters, address);
  }
}

void ended(qemu_plugin_id_t, void*) {
  const Statistics& s = statistics;
  const double mean = s.calls > 0 ? static_cast<double>(s.total) / static_cast<double>(s.calls) : 0;
  std::fprintf(stderr, "count_instructions: calls %" PRIu64 ", shortest %" PRIu64 ", longest %" PRIu64 ", mean %.1f\n",
               s.calls, s.calls > 0 ? s.shortest : 0, s.longest, mean);
}

// Reads NAME=0xADDRESS. The lowest bit of a Thumb function's address is not part of it.
bool readAddress(const char* argument, const char* name, std::uint64_t& address) {
  const std::size_t length = std::strlen(name);
  if (std::strncmp(argument, name, length) != 0 || argument[length] != '=') return false;
  address = std::strtoull(argument + length + 1, nullptr, 16) & ~std::uint64_t{1};
  return true;
}

}  // namespace

extern "C" {

__attribute__((visibility("default"))) int qemu_plugin_version = kQemuPluginVersion;

__attribute__((visibility("default"))) int qemu_plugin_install(qemu_plugin_id_t id, const qemu_info_t*, int count,
                                                               char** arguments) {
  for (int i = 0; i < count; ++i)
    if (!readAddress(arguments[i], "first", first_address) && !readAddress(arguments[i], "last", last_address)) {
      std::fprintf(stderr, "count_instructions: unknown argument '%s'; give first=ADDRESS and last=ADDRESS\n",
                   arguments[i]);
      return -1;
    }
  qemu_plugin_register_vcpu_tb_trans_cb(id, translated);
  qemu_plugin_register_atexit_cb(id, ended, nullptr);
  return 0;
}
}

#pragma once
#include <cstddef>
#include <cstdint>

// The part of QEMU's plugin interface, version 1, that is used here. Debian does not package qemu-plugin.h; names and
// types are those of QEMU 7.2, docs/devel/tcg-plugins.rst.

extern "C" {

using qemu_plugin_id_t = std::uint64_t;
struct qemu_plugin_tb;    // a block of translated instructions
struct qemu_plugin_insn;  // one of them
struct qemu_info_t;

constexpr int kQemuPluginVersion = 1;
constexpr int kQemuPluginNoRegisters = 0;

void qemu_plugin_register_vcpu_tb_trans_cb(qemu_plugin_id_t id, void (*callback)(qemu_plugin_id_t, qemu_plugin_tb*));
std::size_t qemu_plugin_tb_n_insns(const qemu_plugin_tb* block);
qemu_plugin_insn* qemu_plugin_tb_get_insn(const qemu_plugin_tb* block, std::size_t index);
std::uint64_t qemu_plugin_insn_vaddr(const qemu_plugin_insn* instruction);
void qemu_plugin_register_vcpu_insn_exec_cb(qemu_plugin_insn* instruction, void (*callback)(unsigned, void*), int flags,
                                            void* data);
void qemu_plugin_register_atexit_cb(qemu_plugin_id_t id, void (*callback)(qemu_plugin_id_t, void*), void* data);
}

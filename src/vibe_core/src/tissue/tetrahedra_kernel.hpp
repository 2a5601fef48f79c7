#pragma once

#include <cstdint>

#include "common/kernel_path.hpp"
#include "vibe_core/tissue/material.hpp"

namespace vibe {

struct LawConstants;

constexpr int kTetLanes = 8;  ///< elements in a batch

/// One number of each element of a batch.
struct alignas(32) TetReals {
  float lane[kTetLanes];
};
/// For each element of a batch, the start of a node's four numbers: 4 * node.
struct alignas(32) TetOffsets {
  std::uint32_t lane[kTetLanes];
};

/// Arguments for evaluating some batches of elements of one material. Uses plain pointers, so that the translation
/// units of the kernel share no inline code that one of them could compile for the wrong machine.
struct TetSweep {
  const TetOffsets* node;  ///< (batches * nodes per element)
  const TetReals* rest;    ///< (batches * batch_stride), see TetElements
  int batch_stride;        ///< rows of `rest` per batch
  int point_stride;        ///< rows of `rest` from one integration point to the next; 0: shared by all
  int first, last;         ///< batches
  Law law;
  const LawConstants* constants;
  const float* displacement4;  ///< [m]
  float* gradient4;            ///< added to [N]
};

/// Returns the energy [J] and adds its gradient.
using TetSweepFunction = double (*)(const TetSweep& sweep);

/// The kernels of one instruction path.
struct TetKernel {
  const char* name;
  TetSweepFunction linear, quadratic;
};
TetKernel tetKernelSse2();       ///< plain arithmetic
TetKernel tetKernelFusedSse2();  ///< the bits of AVX2; slow
TetKernel tetKernelAvx2();       ///< call its functions only on a machine that has AVX2 and FMA

TetKernel tetKernel(KernelPath path = kernelPath());

}  // namespace vibe

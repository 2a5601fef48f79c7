#pragma once

#include "arithmetic/kernel_path.hpp"
#include "tissue/element_batch.hpp"
#include "vibe_core/tissue/material_registry.hpp"

namespace vibe {

struct LawConstants;

// Rows of precomputed rest data per triangle of a shell, see ShellElements. A side is opposite the node of the same
// number; its apex is the node beyond it.
constexpr int kShellPatch = 0;        ///< positions of nodes 2, 3 and the three apexes relative to node 1 [m]
constexpr int kShellSide = 15;        ///< per side: entries 11, 12, 22 of T [1/m], then twice the volume [m^3]
constexpr int kShellNormal = 27;      ///< normal of the patch at the centroid, shortened by kShellSoftness
constexpr int kShellLength = 30;      ///< 36 times the area element at the centroid, lengthened by kShellSoftness [m^2]
constexpr int kShellBend = 31;        ///< area times half the bending stiffness at rest, by (36 area elements)^4 / 36^2
constexpr int kShellOrigin = 32;      ///< position of node 1 less the origin of the volume [m]
constexpr int kShellRows = 35;        ///< of a triangle with three neighbours
constexpr int kShellGhost = 35;       ///< per side: 1 if a triangle is beyond it, else 0; then sqrt(2) n if clamped
constexpr int kShellGhostRows = 47;   ///< of the others
constexpr int kShellMuscle = 47;      ///< per side: the direction in which the muscle shortens, in the basis of its T
constexpr int kShellMuscleRows = 53;  ///< of a triangle with three neighbours and muscle

// Rows of a triangle with fibres, in addition to those above.
constexpr int kFibreSide = 0;      ///< per side and family: the direction in the basis of the side's T, 0 0 for none
constexpr int kFibreModulus = 12;  ///< [Pa]
constexpr int kFibreRows = 13;

/// Numbers that ShellElements::stress() gives per triangle: stresses, three per side, then three moments.
constexpr int kStressRows = 12;

/// Arguments for evaluating some batches of triangles of one material. Uses plain pointers, so that the translation
/// units of the kernel share no inline code that one of them could compile for the wrong machine.
struct ShellSweep {
  const BatchOffsets* node;  ///< (batches * 6)
  const BatchReals* rest;    ///< (batches * rows), from batch `first`
  int rows;                  ///< kShellRows, kShellGhostRows or kShellMuscleRows
  int first, last;           ///< batches, for `node`
  Law law;
  double poisson_ratio;
  const LawConstants* constants;
  const BatchReals* fibre;     ///< (batches * kFibreRows), from batch `first`; for fibres only
  double fibre_stiffening;     ///< for fibres only
  const float* displacement4;  ///< [m], and the contraction of the muscle
  float* gradient4;            ///< added to [N]
  float* volume_gradient4;     ///< added to [m^2]; null: not computed
  const float* next;           ///< per node, what the contraction becomes; for the work of the muscle only (ratio)
  const float* stress;         ///< that stays as it is (all batches * kStressRows * kBatchLanes) [N/m]; null: none
  float* stress_out;           ///< the same; for the stress only [N/m]
  float* strain_out;           ///< the same, see ShellElements::stress(); null: not wanted
  double volume;               ///< out, added to, if requested [m^3]
  double stress_work;          ///< out, added to: of `stress` from rest to here [J]
};

/// Returns the energy [J] and adds its gradient.
using ShellSweepFunction = double (*)(ShellSweep& sweep);

/// The kernel of one instruction path.
struct ShellKernel {
  const char* name;
  ShellSweepFunction sweep;   ///< of the law, whose gradient is that of `stress` as well
  ShellSweepFunction fibres;  ///< contribution of fibres to the above, without the volume
  ShellSweepFunction muscle;  ///< by how much the energy grows while nothing moves and the contraction becomes the next
  ShellSweepFunction stress;  ///< writes stress, moments and strain, without fibres, and returns the energy
  ShellSweepFunction fibre_stress;  ///< contribution of fibres to the above
  ShellSweepFunction stress_work;   ///< returns the work of a constant stress from rest to here and adds its gradient
};
ShellKernel shellKernelSse2();       ///< plain arithmetic
ShellKernel shellKernelFusedSse2();  ///< the bits of AVX2 and AVX-512; slow
ShellKernel shellKernelAvx2();       ///< call the functions of these two only on a machine that has the instructions
ShellKernel shellKernelAvx512();

ShellKernel shellKernel(KernelPath path = kernelPath());

}  // namespace vibe

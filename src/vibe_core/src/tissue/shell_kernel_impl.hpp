#pragma once

#include "tissue/element_batch_impl.hpp"
#include "tissue/shell_fibres.hpp"

namespace vibe {
namespace {

template <class Arch>
struct ShellKernelOf {
  using Lanes = BatchLanes<Arch>;
  using Pack = typename Lanes::Pack;
  static constexpr int kWidth = static_cast<int>(Pack::size), kParts = kBatchLanes / kWidth;

  /// The displacements of a patch relative to node 1, without ghosts.
  [[gnu::always_inline]] static void gather(const ShellSweep& s, const BatchOffsets* offset, int lane, Pack (&u1)[3],
                                            Pack (&u)[5][3]) {
    Lanes::load(s.displacement4, offset[0].lane + lane, u1);
    for (int a = 0; a < 5; ++a) {
      Lanes::load(s.displacement4, offset[a + 1].lane + lane, u[a]);
      for (int r = 0; r < 3; ++r) u[a][r] = u[a][r] - u1[r];
    }
  }
  /// The mean over the nodes of triangles. @param value  of the offset of a node
  template <class Value>
  [[gnu::always_inline]] static Pack meanOf(const Value& value, const BatchOffsets* offset, int lane) {
    alignas(64) float sum[kWidth];
    for (int k = 0; k < kWidth; ++k) {
      const auto at = [&](int node) { return value(offset[node].lane[lane + k]); };
      sum[k] = (at(0) + at(1)) + at(2);
    }
    return Pack::load_aligned(sum) * Pack(1.0f / 3);
  }
  /// Of the muscle: the mean of the nodes' fourth numbers.
  [[gnu::always_inline]] static Pack contraction(const ShellSweep& s, const BatchOffsets* offset, int lane) {
    return meanOf([&s](std::uint32_t at) { return s.displacement4[at + 3]; }, offset, lane);
  }
  [[gnu::always_inline]] static void scatter(const ShellSweep& s, const BatchOffsets* offset,
                                             const Pack (&f)[kParts][5][3]) {
    for (int part = 0; part < kParts; ++part) {
      Pack f1[3];
      for (int r = 0; r < 3; ++r)
        f1[r] = -(((f[part][0][r] + f[part][1][r]) + (f[part][2][r] + f[part][3][r])) + f[part][4][r]);
      Lanes::add(s.gradient4, offset[0].lane + part * kWidth, f1);
    }
    for (int a = 0; a < 5; ++a)
      for (int part = 0; part < kParts; ++part) Lanes::add(s.gradient4, offset[a + 1].lane + part * kWidth, f[part][a]);
  }

  struct Sums {
    typename Lanes::Sum energy, enclosed, stress_work;
    double addTo(ShellSweep& s) const {
      if (s.volume_gradient4 != nullptr) s.volume += enclosed.total();
      if (s.stress != nullptr) s.stress_work += stress_work.total();
      return energy.total();
    }
  };

  /// The constant stress of a part of a batch.
  struct Stress {
    const float* numbers;  // null: there is none
    static Stress of(const ShellSweep& s, int batch, int lane) {
      return {s.stress == nullptr ? nullptr : s.stress + batch * kStressRows * kBatchLanes + lane};
    }
    bool given() const { return numbers != nullptr; }
    Pack operator()(int row) const { return Pack::load_unaligned(numbers + row * kBatchLanes); }
  };

  /// @param terms  made from the sweep
  template <Law law, int kRows>
  [[gnu::always_inline]] static void sweepBatch(ShellSweep& s, const WallTerms<Pack>& terms, int batch,
                                                const BatchReals* rows, Sums& sums) {
    const BatchOffsets* offset = s.node + batch * 6;
    const bool volume = s.volume_gradient4 != nullptr;  // no parameter of the template: a kernel compiles twice as fast
    Pack f[kParts][5][3], share[kParts][3];
    for (int part = 0; part < kParts; ++part) {
      const int lane = part * kWidth;
      const auto rest = [=](int row) { return Pack::load_aligned(rows[row].lane + lane); };
      Pack u1[3], u[5][3];
      gather(s, offset, lane, u1, u);
      Pack shorter(0.0f);
      if constexpr (kRows == kShellMuscleRows) shorter = contraction(s, offset, lane);
      if constexpr (kRows == kShellGhostRows) placeGhosts(rest, u);
      const Stress beside = Stress::of(s, batch, lane);
      Pack work;
      sums.energy.add(
          shellEnergy<law, LawFormula<law>::kThicknessSteps, kRows>(terms, rest, shorter, beside, u, f[part], work),
          part);
      if (beside.given()) sums.stress_work.add(work, part);
      if constexpr (kRows == kShellGhostRows) returnGhosts(rest, f[part]);
      if (volume) sums.enclosed.add(coneVolume(rest, u, u1, share[part]), part);
    }
    scatter(s, offset, f);
    if (volume)
      for (int a = 0; a < 3; ++a)
        for (int part = 0; part < kParts; ++part)
          Lanes::add(s.volume_gradient4, offset[a].lane + part * kWidth, share[part]);
  }

  template <Law law, int kRows>
  static double sweepAll(ShellSweep& s) {
    const WallTerms<Pack> terms(*s.constants, s.poisson_ratio);
    Sums sums;
    const BatchReals* rows = s.rest;
    for (int batch = s.first; batch < s.last; ++batch, rows += kRows)
      sweepBatch<law, kRows>(s, terms, batch, rows, sums);
    return sums.addTo(s);
  }

  // The membrane's alone: bending does not contract. Batches through which no wave passes are left out.
  template <Law law>
  static double sweepMuscle(ShellSweep& s) {
    const WallTerms<Pack> terms(*s.constants, s.poisson_ratio);
    typename Lanes::Sum twice;
    const BatchReals* rows = s.rest;
    for (int batch = s.first; batch < s.last; ++batch, rows += kShellMuscleRows)
      for (int part = 0; part < kParts; ++part) {
        const BatchOffsets* offset = s.node + batch * 6;
        const int lane = part * kWidth;
        const Pack from = contraction(s, offset, lane);
        const Pack to = meanOf([&s](std::uint32_t at) { return s.next[at / 4]; }, offset, lane);
        if (xsimd::all(from == to)) continue;
        const auto rest = [=](int row) { return Pack::load_aligned(rows[row].lane + lane); };
        Pack u1[3], u[5][3], x[5][3], unused[5][3], no_work(0.0f);
        gather(s, offset, lane, u1, u);
        for (int a = 0; a < 5; ++a)
          for (int r = 0; r < 3; ++r) x[a][r] = rest(kShellPatch + 3 * a + r), unused[a][r] = Pack(0.0f);
        const auto energy = [&](const Pack& shorter) __attribute__((always_inline)) {
          return membraneEnergy<law, LawFormula<law>::kThicknessSteps, kShellMuscleRows>(
              terms, rest, shorter, NoStress<Pack>(), x, u, unused, no_work);
        };
        twice.add(energy(to) - energy(from), part);
      }
    return 0.5 * twice.total();
  }

  template <bool ghosts>
  static double sweepFibresOf(ShellSweep& s) {
    typename Lanes::Sum energy;
    const BatchReals *rows = s.rest, *fibres = s.fibre;
    for (int batch = s.first; batch < s.last; ++batch, rows += s.rows, fibres += kFibreRows) {
      const BatchOffsets* offset = s.node + batch * 6;
      Pack f[kParts][5][3];
      for (int part = 0; part < kParts; ++part) {
        const int lane = part * kWidth;
        const auto rest = [=](int row) { return Pack::load_aligned(rows[row].lane + lane); };
        const auto fibre = [=](int row) { return Pack::load_aligned(fibres[row].lane + lane); };
        Pack u1[3], u[5][3];
        gather(s, offset, lane, u1, u);
        for (auto& node : f[part])
          for (Pack& value : node) value = Pack(0.0f);
        if constexpr (ghosts) placeGhosts(rest, u);
        energy.add(fibreEnergy(s.fibre_stiffening, rest, fibre, u, f[part]), part);
        if constexpr (ghosts) returnGhosts(rest, f[part]);
      }
      scatter(s, offset, f);
    }
    return energy.total();
  }

  static double sweepFibres(ShellSweep& s) {
    return s.rows == kShellGhostRows ? sweepFibresOf<true>(s) : sweepFibresOf<false>(s);
  }

  template <Law law, int kRows>
  static double sweepStressOf(ShellSweep& s) {
    const WallTerms<Pack> terms(*s.constants, s.poisson_ratio);
    typename Lanes::Sum energy;
    const BatchReals* rows = s.rest;
    for (int batch = s.first; batch < s.last; ++batch, rows += kRows)
      for (int part = 0; part < kParts; ++part) {
        const int lane = part * kWidth;
        const BatchOffsets* offset = s.node + batch * 6;
        const int first = batch * kStressRows * kBatchLanes + lane;
        const auto rest = [=](int row) { return Pack::load_aligned(rows[row].lane + lane); };
        Pack u1[3], u[5][3], stress[kStressRows], strain[kStressRows], shorter(0.0f);
        gather(s, offset, lane, u1, u);
        if constexpr (kRows == kShellMuscleRows) shorter = contraction(s, offset, lane);
        if constexpr (kRows == kShellGhostRows) placeGhosts(rest, u);
        energy.add(shellStress<law, LawFormula<law>::kThicknessSteps, kRows>(terms, rest, shorter, u, stress, strain),
                   part);
        for (int row = 0; row < kStressRows; ++row) {
          stress[row].store_unaligned(s.stress_out + first + row * kBatchLanes);
          if (s.strain_out != nullptr) strain[row].store_unaligned(s.strain_out + first + row * kBatchLanes);
        }
      }
    return energy.total();
  }

  // Adds that of the fibres.
  static double sweepFibreStress(ShellSweep& s) {
    const Pack stiffening(static_cast<float>(s.fibre_stiffening));
    const Pack reach(static_cast<float>(fibreReach(s.fibre_stiffening)));
    typename Lanes::Sum twice;
    const BatchReals *rows = s.rest, *fibres = s.fibre;
    for (int batch = s.first; batch < s.last; ++batch, rows += s.rows, fibres += kFibreRows)
      for (int part = 0; part < kParts; ++part) {
        const int lane = part * kWidth;
        float* const numbers = s.stress_out + batch * kStressRows * kBatchLanes + lane;
        const auto rest = [=](int row) { return Pack::load_aligned(rows[row].lane + lane); };
        const auto fibre = [=](int row) { return Pack::load_aligned(fibres[row].lane + lane); };
        const auto side = [&](int k, const Pack(&e)[3], const Pack(&d)[3], const Pack(&ue)[3], const Pack(&ud)[3],
                              Pack(&fe)[3], Pack(&fd)[3]) __attribute__((always_inline)) {
          Pack a[3];
          const Pack volume = rest(kShellSide + 4 * k + 3);
          const Pack value = fibreStress(stiffening, reach, rest, fibre, k, e, d, ue, ud, a);
          for (int c = 0; c < 3; ++c) {
            float* const at = numbers + (3 * k + c) * kBatchLanes;
            (Pack::load_unaligned(at) + volume * a[c]).store_unaligned(at);
          }
          for (int r = 0; r < 3; ++r) fe[r] = fd[r] = Pack(0.0f);
          return Pack(volume * value);
        };
        Pack u1[3], u[5][3], x[5][3], unused[5][3];
        gather(s, s.node + batch * 6, lane, u1, u);
        if (s.rows == kShellGhostRows) placeGhosts(rest, u);
        for (int a = 0; a < 5; ++a)
          for (int r = 0; r < 3; ++r) x[a][r] = rest(kShellPatch + 3 * a + r), unused[a][r] = Pack(0.0f);
        twice.add(overSides(side, x, u, unused), part);
      }
    return 0.5 * twice.total();
  }

  template <Law law>
  static double sweepStress(ShellSweep& s) {
    if (s.rows == kShellMuscleRows) return sweepStressOf<law, kShellMuscleRows>(s);
    if (s.rows == kShellGhostRows) return sweepStressOf<law, kShellGhostRows>(s);
    return sweepStressOf<law, kShellRows>(s);
  }

  template <bool ghosts>
  static double sweepStressWorkOf(ShellSweep& s) {
    typename Lanes::Sum work;
    const BatchReals* rows = s.rest;
    for (int batch = s.first; batch < s.last; ++batch, rows += s.rows) {
      const BatchOffsets* offset = s.node + batch * 6;
      Pack f[kParts][5][3];
      for (int part = 0; part < kParts; ++part) {
        const int lane = part * kWidth;
        const auto rest = [=](int row) { return Pack::load_aligned(rows[row].lane + lane); };
        Pack u1[3], u[5][3];
        gather(s, offset, lane, u1, u);
        if constexpr (ghosts) placeGhosts(rest, u);
        work.add(shellStressWork<ghosts>(rest, Stress::of(s, batch, lane), u, f[part]), part);
        if constexpr (ghosts) returnGhosts(rest, f[part]);
      }
      scatter(s, offset, f);
    }
    return work.total();
  }

  static double sweepStressWork(ShellSweep& s) {
    return s.rows == kShellGhostRows ? sweepStressWorkOf<true>(s) : sweepStressWorkOf<false>(s);
  }
};

/// Kernel::sweepAll() of the law and the rows of a sweep.
template <class Kernel>
double sweepShell(ShellSweep& s) {
  return withLaw(s.law, [&](auto tag) {
    constexpr Law law = decltype(tag)::value;
    if (s.rows == kShellMuscleRows) return Kernel::template sweepAll<law, kShellMuscleRows>(s);
    if (s.rows == kShellGhostRows) return Kernel::template sweepAll<law, kShellGhostRows>(s);
    return Kernel::template sweepAll<law, kShellRows>(s);
  });
}

/// Kernel::sweepMuscle() of the law of a sweep.
template <class Kernel>
double sweepMuscle(ShellSweep& s) {
  return withLaw(s.law, [&](auto tag) { return Kernel::template sweepMuscle<decltype(tag)::value>(s); });
}

/// Kernel::sweepStress() of the law of a sweep.
template <class Kernel>
double sweepStress(ShellSweep& s) {
  return withLaw(s.law, [&](auto tag) { return Kernel::template sweepStress<decltype(tag)::value>(s); });
}

#ifdef VIBE_KERNEL_SET  // not in the kernel for AVX-512, which has a source of its own
template <class Set>
constexpr const char* kSetName = "sse2";
template <>
constexpr const char* kSetName<FusedSse2> = "sse2, fused";
template <>
constexpr const char* kSetName<KernelSets::Avx2> = "avx2";
#endif

}  // namespace

#ifdef VIBE_KERNEL_SET
ShellKernel VIBE_KERNEL(shellKernel)() {
  using Set = KernelSets::VIBE_KERNEL_SET;
  using Kernel = ShellKernelOf<Set>;
  return {kSetName<Set>,       sweepShell<Kernel>,       Kernel::sweepFibres,    sweepMuscle<Kernel>,
          sweepStress<Kernel>, Kernel::sweepFibreStress, Kernel::sweepStressWork};
}
#endif

}  // namespace vibe

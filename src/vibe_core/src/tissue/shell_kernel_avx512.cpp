#include "tissue/shell_kernel_impl.hpp"

namespace vibe {
namespace {

/// Two batches of triangles at once. Every lane goes through the operations of the AVX2 path, and sums are formed in
/// its order, so that both paths give the same bits. Half as many steps of a chain of dependent operations make it
/// faster.
struct ShellKernelOfPairs {
  using Single = ShellKernelOf<xsimd::fma3<xsimd::avx2>>;
  using Half = Single::Pack;
  using Pack = WidePack;

  static Pack both(const Half& a, const Half& b) { return Pack(_mm512_insertf32x8(_mm512_castps256_ps512(a), b, 1)); }
  static Half first(const Pack& both) { return Half(_mm512_castps512_ps256(both)); }
  static Half second(const Pack& both) { return Half(_mm512_extractf32x8_ps(both, 1)); }

  [[gnu::always_inline]] static void load(const ShellSweep& s, const BatchOffsets* offset, Pack (&out)[3]) {
    Half a[3], b[3];
    Single::Lanes::load(s.displacement4, offset[0].lane, a);
    Single::Lanes::load(s.displacement4, offset[6].lane, b);
    for (int r = 0; r < 3; ++r) out[r] = both(a[r], b[r]);
  }

  [[gnu::always_inline]] static void gather(const ShellSweep& s, const BatchOffsets* offset, Pack (&u1)[3],
                                            Pack (&u)[5][3]) {
    load(s, offset, u1);
    for (int a = 0; a < 5; ++a) {
      load(s, offset + a + 1, u[a]);
      for (int r = 0; r < 3; ++r) u[a][r] = u[a][r] - u1[r];
    }
  }

  template <class Part>
  [[gnu::always_inline]] static void scatter(const ShellSweep& s, const BatchOffsets* offset, const Pack (&f)[5][3],
                                             const Part& part) {
    Half half[1][5][3];
    for (int a = 0; a < 5; ++a)
      for (int r = 0; r < 3; ++r) half[0][a][r] = part(f[a][r]);
    Single::scatter(s, offset, half);
  }

  template <class Part>
  [[gnu::always_inline]] static void addShares(const ShellSweep& s, const BatchOffsets* offset, const Pack (&share)[3],
                                               const Part& part) {
    const Half half[3] = {part(share[0]), part(share[1]), part(share[2])};
    for (int a = 0; a < 3; ++a) Single::Lanes::add(s.volume_gradient4, offset[a].lane, half);
  }

  struct Stress {
    Single::Stress a, b;
    bool given() const { return a.given(); }
    Pack operator()(int row) const { return both(a(row), b(row)); }
  };

  template <Law law, int kRows>
  static double sweepAll(ShellSweep& s) {
    const WallTerms<Pack> terms(*s.constants, s.poisson_ratio);
    Single::Sums sums;
    const BatchReals* rows = s.rest;
    const bool volume = s.volume_gradient4 != nullptr;
    int batch = s.first;
    for (; batch + 1 < s.last; batch += 2, rows += 2 * kRows) {
      const BatchOffsets* offset = s.node + batch * 6;
      const auto rest = [=](int row) {
        return both(Half::load_aligned(rows[row].lane), Half::load_aligned(rows[kRows + row].lane));
      };
      Pack u1[3], u[5][3], f[5][3];
      gather(s, offset, u1, u);
      Pack shorter(0.0f);
      if constexpr (kRows == kShellMuscleRows)
        shorter = both(Single::contraction(s, offset, 0), Single::contraction(s, offset + 6, 0));
      if constexpr (kRows == kShellGhostRows) placeGhosts(rest, u);
      const Stress beside{Single::Stress::of(s, batch, 0), Single::Stress::of(s, batch + 1, 0)};
      Pack work;
      const Pack value =
          shellEnergy<law, LawFormula<law>::kThicknessSteps, kRows>(terms, rest, shorter, beside, u, f, work);
      sums.energy.add(first(value)), sums.energy.add(second(value));
      if (beside.given()) sums.stress_work.add(first(work)), sums.stress_work.add(second(work));
      if constexpr (kRows == kShellGhostRows) returnGhosts(rest, f);
      scatter(s, offset, f, first);
      scatter(s, offset + 6, f, second);
      if (volume) {
        Pack share[3];
        const Pack cone = coneVolume(rest, u, u1, share);
        sums.enclosed.add(first(cone)), sums.enclosed.add(second(cone));
        addShares(s, offset, share, first);
        addShares(s, offset + 6, share, second);
      }
    }
    if (batch < s.last)
      Single::sweepBatch<law, kRows>(s, WallTerms<Half>(*s.constants, s.poisson_ratio), batch, rows, sums);
    return sums.addTo(s);
  }
};

}  // namespace

ShellKernel shellKernelAvx512() {
  using Single = ShellKernelOfPairs::Single;
  return {"avx512",
          sweepShell<ShellKernelOfPairs>,
          Single::sweepFibres,
          sweepMuscle<Single>,
          sweepStress<Single>,
          Single::sweepFibreStress,
          Single::sweepStressWork};
}

}  // namespace vibe

#pragma once

#include "arithmetic/kernel_path.hpp"
#include "tissue/element_batch_impl.hpp"
#include "tissue/relaxation_kernel.hpp"
#include "tissue/shell_kernel.hpp"

namespace vibe {
namespace {

template <class Arch>
struct RelaxationKernelOf {
  using Lanes = BatchLanes<Arch>;
  using Pack = typename Lanes::Pack;
  static constexpr std::size_t kLanes = kBatchLanes, kWidth = Pack::size, kRows = kStressRows;

  static Pack load(const float* at) { return Pack::load_unaligned(at); }

  /// The sum of a function of the first number of each part of a batch.
  template <class Part>
  [[gnu::always_inline]] static double sumOf(std::size_t size, const Part& part) {
    typename Lanes::Sum sum;
    for (std::size_t batch = 0; batch < size; batch += kRows * kLanes)
      for (std::size_t lane = 0; lane < kLanes; lane += kWidth)
        sum.add(part(batch + lane), static_cast<int>(lane / kWidth));
    return sum.total();
  }

  static double relaxed(const RelaxationSweep& s, const PronyTerm* term, std::size_t terms, const float* overstress,
                        float* out) {
    float share = 0;
    for (std::size_t k = 0; k < terms; ++k) share += term[k].ratio;
    return sumOf(
        s.size, [&](std::size_t first) __attribute__((always_inline)) {
          Pack stress[kRows], work(0.0f);
          for (std::size_t row = 0; row < kRows; ++row) stress[row] = Pack(-share) * load(s.law + first + row * kLanes);
          for (std::size_t k = 0; k < terms; ++k) {
            const Pack ahead(term[k].ahead);
            const float* const over = overstress + k * s.size + first;
            for (std::size_t row = 0; row < kRows; ++row) stress[row] = stress[row] + ahead * load(over + row * kLanes);
          }
          for (std::size_t row = 0; row < kRows; ++row) {
            stress[row].store_unaligned(out + first + row * kLanes);
            work = work + stress[row] * load(s.strain + first + row * kLanes);
          }
          return work;
        });
  }

  static double advance(const RelaxationSweep& s, const PronyTerm& term, float* overstress) {
    const Pack ratio(term.ratio), ahead(term.ahead), decay(term.decay), gain(term.gain);
    return sumOf(
        s.size, [&](std::size_t first) __attribute__((always_inline)) {
          Pack work(0.0f);
          for (std::size_t at = first; at < first + kRows * kLanes; at += kLanes) {
            const Pack law = load(s.law + at), over = load(overstress + at);
            work = work + (ratio * law - ahead * over) * (load(s.strain_end + at) - load(s.strain + at));
            (decay * over + gain * (load(s.law_end + at) - law)).store_unaligned(overstress + at);
          }
          return work;
        });
  }
};

}  // namespace

RelaxationKernel VIBE_KERNEL(relaxationKernel)() {
  using Kernel = RelaxationKernelOf<KernelSets::VIBE_KERNEL_SET>;
  return {Kernel::relaxed, Kernel::advance};
}

}  // namespace vibe

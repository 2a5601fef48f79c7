#pragma once

#include <vector>

#include "tissue/shell_part.hpp"
#include "vibe_core/threads/thread_pool.hpp"

namespace vibe {

class ShellElements;

/// The evaluation of a shell by several threads, with the bits of one piece after the other.
struct SharedEvaluation {
  struct Share {  // all but the first
    ShellPart part;
    std::vector<float> displacement, gradient, volume_gradient;  // of the part
  };
  int threads = 1;  // for which the shares are made
  std::vector<Share> shares;
  std::vector<double> value, volume, stress_work;  // per piece [J], [m^3], [J]

  /// Makes the shares for a number of threads.
  /// @param shell  null: there is nothing to share
  void divide(const ShellElements* shell, int number_of_threads);

  /// Where there are shares.
  /// @param gradient         (4 per node) zeros to add to [N]
  /// @param volume_gradient  the same [m^2]; null: volumes are not wanted, and are 0
  /// @param stress           beside that of the law, see ConstantStress [N/m]; null: none
  /// @returns the energy [J]
  double evaluate(const ShellElements& shell, ThreadPool& pool, const float* displacement, float* gradient,
                  float* volume_gradient, const float* stress);

 private:
  void evaluatePieces(const ShellElements& shell, int last, const float* displacement, float* gradient,
                      float* volume_gradient, const float* stress);
  void evaluateShare(const ShellElements& shell, Share& share, const float* displacement, float* gradient,
                     float* volume_gradient, const float* stress);
};

}  // namespace vibe

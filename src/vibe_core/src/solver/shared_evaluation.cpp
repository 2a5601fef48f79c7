#include "solver/shared_evaluation.hpp"

#include <algorithm>
#include <utility>

#include "vibe_core/solver/step_policy.hpp"
#include "vibe_core/tissue/shell.hpp"

namespace vibe {

void SharedEvaluation::divide(const ShellElements* shell, int number_of_threads) {
  threads = number_of_threads;
  shares.clear();
  if (shell == nullptr || threads == 1) return;
  for (ShellPart& part : shell->partsOf(std::min(threads, stepPolicy().shell_shares))) {
    const std::vector<float> zeros(part.size(), 0.0F);
    shares.push_back({std::move(part), zeros, zeros, zeros});
  }
  for (auto* v : {&value, &volume, &stress_work}) v->assign(static_cast<std::size_t>(shell->pieceCount()), 0);
}

double SharedEvaluation::evaluate(const ShellElements& shell, ThreadPool& pool, const float* displacement,
                                  float* gradient, float* volume_gradient, const float* stress) {
  pool.parallelFor(1 + static_cast<int>(shares.size()), 1, [&](int k, int) {
    if (k == 0)
      evaluatePieces(shell, shares.front().part.first_piece, displacement, gradient, volume_gradient, stress);
    else
      evaluateShare(shell, shares[static_cast<std::size_t>(k) - 1], displacement, gradient, volume_gradient, stress);
  });
  for (const Share& share : shares)
    for (std::size_t i = 0; i < share.part.copies.size(); ++i) {
      const std::size_t from = 4 * (share.part.own.size() + i), to = 4 * static_cast<std::size_t>(share.part.copies[i]);
      for (std::size_t c = 0; c < 3; ++c) {
        gradient[to + c] += share.gradient[from + c];
        if (volume_gradient != nullptr) volume_gradient[to + c] += share.volume_gradient[from + c];
      }
    }
  double energy = 0;
  for (const double part : value) energy += part;
  return energy;
}

// To the vectors of all nodes.
void SharedEvaluation::evaluatePieces(const ShellElements& shell, int last, const float* displacement, float* gradient,
                                      float* volume_gradient, const float* stress) {
  for (int p = 0; p < last; ++p) {
    double enclosed = 0;
    ConstantStress beside{stress};
    value[static_cast<std::size_t>(p)] = shell.evaluate(p, displacement, gradient, volume_gradient, enclosed, &beside);
    volume[static_cast<std::size_t>(p)] = enclosed;
    stress_work[static_cast<std::size_t>(p)] = beside.work;
  }
}

// To the vectors of the share, and from there to the nodes that nobody else adds to meanwhile.
void SharedEvaluation::evaluateShare(const ShellElements& shell, Share& share, const float* displacement,
                                     float* gradient, float* volume_gradient, const float* stress) {
  const ShellPart& part = share.part;
  float* to = share.displacement.data();
  for (const std::vector<int>* nodes : {&part.own, &part.copies})
    for (const int node : *nodes) to = std::copy_n(displacement + 4 * static_cast<std::size_t>(node), 4, to);
  for (std::vector<float>* sum : {&share.gradient, &share.volume_gradient}) std::fill(sum->begin(), sum->end(), 0.0F);
  for (int p = part.first_piece; p < part.last_piece; ++p) {
    double enclosed = 0;
    ConstantStress beside{stress};
    value[static_cast<std::size_t>(p)] =
        shell.evaluate(part, p, share.displacement.data(), share.gradient.data(),
                       volume_gradient != nullptr ? share.volume_gradient.data() : nullptr, enclosed, &beside);
    volume[static_cast<std::size_t>(p)] = enclosed;
    stress_work[static_cast<std::size_t>(p)] = beside.work;
  }
  for (std::size_t i = 0; i < part.own.size(); ++i) {
    const std::size_t node = 4 * static_cast<std::size_t>(part.own[i]);
    std::copy_n(share.gradient.data() + 4 * i, 4, gradient + node);
    if (volume_gradient != nullptr) std::copy_n(share.volume_gradient.data() + 4 * i, 4, volume_gradient + node);
  }
}

}  // namespace vibe

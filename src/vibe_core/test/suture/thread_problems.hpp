#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "suture/capstan.hpp"
#include "vibe_core/arithmetic/random.hpp"

namespace vibe::test {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Numbers that are the same everywhere.
struct Random {
  std::uint64_t state;
  double operator()(double low, double high) { return low + (high - low) * nextUniform(state); }
};

struct Problem {
  VectorXd residual;
  MatrixXd compliance;
  VectorXd factor;
};

inline ThreadSlide solve(const Problem& p) {
  ThreadSlide result;
  slideThread(p.residual, p.compliance, p.factor, result);
  return result;
}

/// Length balance, signs, complementarity, friction: the worst violation, in shares of the largest length and force.
inline double worstViolation(const Problem& p, const ThreadSlide& r) {
  const int m = static_cast<int>(p.residual.size());
  VectorXd balance = p.compliance * r.tension - p.residual - r.slack;
  for (int k = 0; k + 1 < m; ++k) {
    balance[k] -= r.slide[k];
    balance[k + 1] += r.slide[k];
  }
  const double length = (p.residual.cwiseAbs() + (p.compliance * r.tension).cwiseAbs()).maxCoeff() + 1e-300;
  const double force = r.tension.maxCoeff() + 1e-300;
  double worst = balance.cwiseAbs().maxCoeff() / length;
  worst = std::max({worst, -r.tension.minCoeff() / force, -r.slack.minCoeff() / length});
  for (int k = 0; k < m; ++k) worst = std::max(worst, std::min(r.tension[k] / force, r.slack[k] / length));
  for (int k = 0; k + 1 < m; ++k) {
    const double slide = r.slide[k] / length;
    if (std::isinf(p.factor[k])) {
      worst = std::max(worst, std::abs(slide));
      continue;
    }
    const double forward = (p.factor[k] * r.tension[k] - r.tension[k + 1]) / (p.factor[k] * force);
    const double backward = (p.factor[k] * r.tension[k + 1] - r.tension[k]) / (p.factor[k] * force);
    worst = std::max({worst, -forward, -backward, std::min(slide, forward), std::min(-slide, backward)});
  }
  return worst;
}

inline Problem even(int m, double factor, double compliance = 1e-3) {
  return {VectorXd::Zero(m), MatrixXd(compliance * MatrixXd::Identity(m, m)), VectorXd::Constant(m - 1, factor)};
}

/// The first end pulled by a weight: a segment that gives without limit, see slideThread().
inline void hangWeight(Problem& p, int segment, double weight, double give = 1e9) {
  p.compliance(segment, segment) = give;
  p.residual[segment] = give * weight;
}

}  // namespace vibe::test

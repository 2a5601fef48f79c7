#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "solver/thread_slides.hpp"
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

/// Equilibrium of m segments between m - 1 eyelets.
struct ThreadSlide {
  VectorXd tension, slide, slack;
  bool converged = false;
};

/// Threads that follow each other in one problem, each with so many segments.
struct Threads {
  Threads(const Problem& p, const VectorXd& spare, const std::vector<int>& counts, int guesses = 100)
      : slides(guesses) {
    int first = 0;
    for (const int count : counts) {
      slides.addThread();
      for (int k = first; k < first + count; ++k) slides.addSegment(k + 1 < first + count ? p.factor[k] : 1, spare[k]);
      first += count;
    }
    setCompliance(p.compliance);
  }
  void setCompliance(const MatrixXd& compliance) {
    compliance_ = compliance;
    slides.beginCompliance();
    for (int i = 0; i < slides.size(); ++i)
      for (int j = 0; j < slides.size(); ++j) slides.compliance(i, j) = compliance(i, j);
  }
  ThreadSlide solve(const VectorXd& lack) {
    slides.solve(lack.data());
    ThreadSlide r;
    r.converged = slides.violation() == 0;
    const int m = slides.size();
    r.tension.resize(m), r.slide.resize(m - 1);
    for (int k = 0; k < m; ++k) r.tension[k] = slides.tension(k);
    for (int k = 0; k + 1 < m; ++k) r.slide[k] = slides.slide(k);
    r.slack = compliance_ * r.tension - lack;
    for (int k = 0; k + 1 < m; ++k) r.slack[k] -= r.slide[k], r.slack[k + 1] += r.slide[k];
    return r;
  }
  ThreadSlides slides;

 private:
  MatrixXd compliance_;
};

/// One thread that gives away whatever it has.
inline ThreadSlide solve(const Problem& p) {
  const int m = static_cast<int>(p.residual.size());
  return Threads(p, VectorXd::Constant(m, 1e9), {m}).solve(p.residual);
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

/// The first end pulled by a weight: a segment that gives so much that what slides hardly changes it, while it is not
/// lost in rounding.
inline void hangWeight(Problem& p, int segment, double weight, double give = 1e3) {
  p.compliance(segment, segment) = give;
  p.residual[segment] = give * weight;
}

}  // namespace vibe::test

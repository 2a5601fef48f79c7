#pragma once

#include <Eigen/Core>

#include "vibe_core/state/impedance_memory.hpp"

namespace vibe {

/// Corrects a stiffness along the latest motion to the change of force that was observed along it: with the step s and
/// the loss of force y, K - K s (K s)^T / (s^T K s) + y y^T / (s^T y), the update of Broyden, Fletcher, Goldfarb and
/// Shanno (Nocedal, Wright 2006, Numerical Optimization, eq. 6.19). K stays symmetric and positive semidefinite, and
/// K s becomes y. The pair is kept for the frames in which the tool rests.
template <int N>
class SlopeCorrection {
 public:
  using Vector = Eigen::Matrix<double, N, 1>;
  using Matrix = Eigen::Matrix<double, N, N>;

  /// @param memory  of the past frames; must outlive this
  explicit SlopeCorrection(SlopeMemory<N>& memory)
      : memory_(memory),
        place_(memory.place.data()),
        force_(memory.force.data()),
        step_(memory.step.data()),
        change_(memory.change.data()) {}

  void forget() { memory_.known = memory_.has_pair = false; }

  /// @param place   of the tool
  /// @param force   elastic part, at `place`
  /// @param usable  the step from the last place to this one is long enough, and the same nodes are touched
  void observe(const Matrix& stiffness, const Vector& place, const Vector& force, bool usable) {
    if (memory_.known && usable) keepPair(stiffness, place - place_, force_ - force);
    memory_.known = true;
    place_ = place;
    force_ = force;
  }

  Matrix corrected(const Matrix& stiffness) const {
    const Vector pulled = stiffness * step_;
    const double expected = step_.dot(pulled);
    if (!memory_.has_pair || !(expected > 0)) return stiffness;
    return stiffness - pulled * pulled.transpose() / expected + change_ * change_.transpose() / step_.dot(change_);
  }

  Vector lastPlace() const { return place_; }

 private:
  static constexpr double kMin = 0.2, kMax = 2;  // times the expected slope; outside, it is not taken for a slope
  static constexpr double kMaxAngle = 2;         // inverse cosine of the angle between step and change

  void keepPair(const Matrix& stiffness, const Vector& step, const Vector& change) {
    const Vector pulled = stiffness * step;
    const double expected = step.dot(pulled), observed = step.dot(change);
    if (!(observed >= kMin * expected && observed <= kMax * expected && observed > 0)) return;
    step_ = step;
    change_ = change;
    memory_.has_pair = true;
    // the units of the components differ; the roots of the stiffnesses make them comparable
    const Vector scale = stiffness.diagonal().cwiseMax(0).cwiseSqrt();
    double step2 = 0, change2 = 0;
    for (int i = 0; i < N; ++i) {
      step2 += scale[i] * scale[i] * step[i] * step[i];
      if (scale[i] > 0) change2 += change[i] * change[i] / (scale[i] * scale[i]);
    }
    const bool skew = !(step2 * change2 <= kMaxAngle * kMaxAngle * observed * observed);
    if (skew || (scale.array() == 0).any()) change_ = pulled * (observed / expected);  // its size along the step only
  }

  SlopeMemory<N>& memory_;
  Eigen::Map<Vector> place_, force_, step_, change_;
};

}  // namespace vibe

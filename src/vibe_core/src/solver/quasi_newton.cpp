#include "solver/quasi_newton.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "solver/node_vectors.hpp"
#include "vibe_core/solver/step_policy.hpp"

namespace vibe {

namespace {

// The minimum of the parabola over the part that was tried.
// @param slope   foreseen change of the value over the part; negative
// @param change  true change
double shortening(double slope, double change) {
  const StepPolicy& policy = stepPolicy();
  const double bend = change - slope;
  return bend > 0 ? std::clamp(-slope / (2 * bend), policy.shortest_part, policy.longest_part) : policy.longest_part;
}

}  // namespace

QuasiNewton::QuasiNewton(const ElasticBody& body, Potential& potential, BodyLoads& loads, StepperWorkspace& scratch,
                         double safe_length, int max_evaluations)
    : body_(body),
      potential_(potential),
      gas_(loads.gas),
      extra_(loads.extra),
      scratch_(scratch),
      at_(scratch.iterate),
      history_(scratch.history),
      system_(scratch.system),
      unknowns_(scratch.system.unknowns),
      safe_length_(safe_length),
      max_evaluations_(max_evaluations) {}

void QuasiNewton::start() {
  start(evaluate(at_.z, at_.gradient));
}

void QuasiNewton::start(double value) {
  restart();
  aimed_ = false;
  last_length_ = -1;
  value_ = value;
}

double QuasiNewton::evaluate(const std::vector<double>& z, std::vector<float>& gradient) {
  ++evaluations_;
  const InStage stage(scratch_.stages, StepStage::Energy);
  return potential_.evaluate(z, gradient);
}

// Without the history, which may have led astray, the direction is that of the factor.
bool QuasiNewton::startAgain() {
  if (history_.count == 0 || exhausted()) return false;
  ways_.count(StepWay::SearchRestarted);
  restart();
  last_length_ = -1;
  failed_ = false;
  return true;
}

// A whole step that was followed by a shorter one says how the next ones go on.
double QuasiNewton::residual() const {
  if (failed_ || before_length_ <= 0) return direction_length_;
  return direction_length_ * std::min(1.0, direction_length_ / before_length_);
}

double QuasiNewton::resolution() const {
  return 4 * std::numeric_limits<float>::epsilon() * largest(at_.last.displacement);
}

// The value with the rows' (and a prescribed volume's) forces as multipliers, and the energy of what rows give way: it
// falls along the direction although the rows move.
double QuasiNewton::lagrangian(double part) const {
  return unknowns_.energy(part) - (1 - part) * (lagrangianSlope(part) - unknowns_.slope(part));
}

double QuasiNewton::lagrangianSlope(double part) const {
  double sum = unknowns_.slope(part);
  system_.rows.forEachMultiplier(
      [&](int row, const LinearForm&) { sum -= system_.schur.forces()[row] * system_.row_moves[row]; });
  return sum;
}

void QuasiNewton::setTrial(double part) {
  for (std::size_t i = 0; i < at_.z.size(); ++i) at_.trial[i] = at_.z[i] + part * static_cast<double>(at_.direction[i]);
}

// Whether the rows that hold stay where they are, but for rounding. Contacts that open or slip, threads that slide and
// slack ones may move freely.
bool QuasiNewton::rowsStay() const {
  const Eigen::VectorXd &moves = system_.row_moves, &forces = system_.schur.forces();
  const double rounding = stepPolicy().row_roundings * resolution();
  const double limit = std::max(stepPolicy().small_residual * direction_length_, rounding);
  // equations and contacts are rigid or nearly so: any motion beyond rounding is one that the pair would repeat
  const int contacts_end = system_.rows.contactRow(system_.rows.counted);
  for (int row = 0; row < contacts_end; ++row)
    if (system_.schur.holds(row) && std::abs(moves[row]) > limit) return false;
  // threads are elastic and move their rows by what they are stretched
  const double of_thread = std::max(stepPolicy().thread_residual * direction_length_, rounding);
  for (const ThreadRows& thread : system_.rows.threads)
    for (int k = 0; k < thread.count(); ++k) {
      const int row = thread.pullRow(k);
      if (forces[row] > 0 && std::abs(moves[row] - unknowns_.loss(row)) > of_thread) return false;
    }
  return true;
}

void QuasiNewton::keepPair(double part) {
  // the oldest pair makes room, and its vectors take the new one
  if (history_.count == PairHistory::kSize) {
    std::rotate(history_.move.begin(), history_.move.begin() + 1, history_.move.end());
    std::rotate(history_.change.begin(), history_.change.begin() + 1, history_.change.end());
    std::rotate(history_.curvature.begin(), history_.curvature.begin() + 1, history_.curvature.end());
    --history_.count;
    unknowns_.forgetOldest();
  }
  std::vector<float>&move = history_.move[history_.count], &change = history_.change[history_.count];
  const auto p = static_cast<float>(part);
  for (std::size_t i = 0; i < move.size(); ++i) {
    move[i] = p * at_.direction[i];
    change[i] = at_.trial_gradient[i] - at_.gradient[i];
  }
  // a pair without curvature would make the inverse indefinite
  const double product = dot(move, change) + unknowns_.curvature(part);
  if (!(product > stepPolicy().pair_cosine * std::sqrt(dot(move, move) * dot(change, change)))) return;
  unknowns_.keep(history_.count, part);
  history_.curvature[history_.count++] = 1 / product;
}

double QuasiNewton::iterate(double max, bool verify) {
  aim();
  aimed_ = false;
  if (!std::isfinite(direction_length_)) return direction_length_;
  return advance(max, verify);
}

// What is left after this direction if the next ones go on to shrink as this one did: the sum of a geometric series
// [m].
double QuasiNewton::rest() const {
  return direction_length_ * direction_length_ / (last_length_ - direction_length_);
}

double QuasiNewton::advance(double max, bool verify) {
  const double part = direction_length_ > max ? max / direction_length_ : 1;
  // convergence is judged by the first direction, unless the caller has said by what
  const bool begins = first_length_ == 0;
  if (begins) first_length_ = direction_length_;
  const bool shrinks = last_length_ > 0 && direction_length_ < stepPolicy().contraction * last_length_;
  // a first direction that is short leaves nothing that a second could find in single precision
  const bool is_short = direction_length_ < safe_length_ && begins;
  contracts_ = part == 1 && (is_short || (shrinks && rest() < stepPolicy().rest_part * first_length_));
  before_length_ = last_length_;
  last_length_ = -1;  // only a whole step says how fast the next ones shrink
  if (verify || !contracts_) return search(part);
  takeUnseen();
  return direction_length_;
}

// The whole direction, without an evaluation at its end.
void QuasiNewton::takeUnseen() {
  ways_.count(StepWay::LastMoveUnseen);
  setTrial(1);
  at_.z.swap(at_.trial);
  unknowns_.move(1);
  if (gas_.control != GasLoad::Control::None) potential_.moveVolume(dot(at_.last.volume_gradient, at_.direction));
}

double QuasiNewton::slopeAtTrial(double part) const {
  return dot(at_.trial_gradient, at_.direction) + lagrangianSlope(part);
}

// As much of the direction as lowers the energy.
double QuasiNewton::search(double part) {
  const StepPolicy& policy = stepPolicy();
  const double prescribed = gas_.control == GasLoad::Control::Volume ? system_.schur.gasForce() : 0;
  const double old_pressure = gas_.pressure;
  const double from = value_ + lagrangian(0), slope = slope_ + lagrangianSlope(0);
  double to = value_;
  // each evaluation overwrites `last`; should none be of use, the one at z is still there
  std::swap(at_.last, at_.kept);
  for (int trial = 1;; ++trial) {
    setTrial(part);
    if (prescribed != 0) gas_.pressure = old_pressure + part * prescribed;
    to = evaluate(at_.trial, at_.trial_gradient);
    if (prescribed != 0) break;  // the volume is held: no energy to compare
    // enough of what the slope promises (Armijo)
    const double change = to + lagrangian(part) - from;
    if (std::isfinite(to) && change <= policy.sufficient_decrease * part * slope + potential_.noise()) break;
    // a change that is rounding says nothing, but the slope at the end does (approximate Wolfe)
    const bool is_rounding = change <= policy.energy_roundings * potential_.noise();
    if (is_rounding && slopeAtTrial(part) <= (2 * policy.sufficient_decrease - 1) * slope) break;
    if (trial == policy.search_trials || exhausted()) {
      failed_ = true;
      std::swap(at_.last, at_.kept);
      return 0;
    }
    part *= std::isfinite(to) ? shortening(part * slope, change) : policy.shortest_part;
  }
  // a pair in which the rows move would move them again
  if (rowsStay()) keepPair(part);
  if (part == 1) last_length_ = direction_length_;
  unknowns_.move(part);
  value_ = to;
  at_.gradient.swap(at_.trial_gradient);
  at_.z.swap(at_.trial);
  return part * direction_length_;
}

}  // namespace vibe

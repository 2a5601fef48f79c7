#include "solver/quasi_newton.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "vibe_core/solver/energy_term.hpp"

namespace vibe {

namespace {

// Share of the linear prediction by which the energy must fall (Armijo). Nocedal, Wright 2006, Numerical Optimization,
// section 3.1: "c1 is chosen to be quite small, say c1 = 1e-4" [1].
constexpr double kSufficientDecrease = 1e-4;
// Bounds of the next part of a direction over the one that was too long, between which it is the minimum of the
// parabola through value, slope and trial. Nocedal, Wright 2006, section 3.5: "quadratic interpolation", safeguarded
// [1].
constexpr double kShortest = 0.1, kLongest = 0.5;
// Rounding errors of a value that may hide a decrease; then the slope decides (approximate Wolfe condition: Hager,
// Zhang 2005, doi 10.1137/030601880, equation 2.4). Design choice: the errors of many elements seldom add up to more
// [1].
constexpr double kEnergyRoundings = 10;
// Trials along a direction before it counts as useless. Design choice: at the shortest, a part of 1e-4 of a direction,
// which is below what a step can use.
constexpr int kMaxTrials = 5;
// Residual of the constraints over the resolution of single precision, above which it is not rounding. Design choice:
// a row sums up to some ten nodes, each a few roundings off [1].
constexpr double kUnmet = 100;
// Residual of the rows over the length of the direction, below which the rows hardly move. Design choice: a pair of the
// history with larger row moves would repeat them in later directions [1].
constexpr double kSmallResidual = 1e-4;
// The same over the resolution of single precision, in which the solution with all forces of the rows is stored. Design
// choice: a row sums up to some ten nodes [1].
constexpr double kRowRoundings = 10;
// The same as kSmallResidual for threads, which are elastic. Design choice [1].
constexpr double kThreadShare = 1.0 / 3;
// Length of a direction over the one before, below which the iteration contracts. Design choice: halving per iteration
// is the weakest rate that bounds the rest by the last move [1].
constexpr double kSafeContraction = 0.5;
// What is left after the last move of a step over its first direction. Design choice: a hundredth. A force that a
// device renders from one frame to the next is then 5 % of its change off, with a fiftieth 7 %, with half a
// hundredth 4.5 % [1].
constexpr double kSafeRest = 0.01;
// Smallest cosine between move and change of gradient of a pair that is kept. Design choice: the rounding of single
// precision; below it the curvature has no correct digit [1].
constexpr double kMinPairCosine = 1e-8;

// Two nodes at once: eight sums in double precision, added up in a fixed order.
double dot(const std::vector<float>& a, const std::vector<float>& b) {
  double sum[8] = {0, 0, 0, 0, 0, 0, 0, 0};
  const std::size_t even = a.size() / 8 * 8;
  for (std::size_t i = 0; i < even; i += 8)
    for (std::size_t k = 0; k < 8; ++k) sum[k] += static_cast<double>(a[i + k]) * static_cast<double>(b[i + k]);
  for (std::size_t i = even; i < a.size(); ++i) sum[i - even] += static_cast<double>(a[i]) * static_cast<double>(b[i]);
  return ((sum[0] + sum[4]) + (sum[1] + sum[5])) + ((sum[2] + sum[6]) + (sum[3] + sum[7]));
}

void addMultiple(double scale, const std::vector<float>& a, std::vector<float>& to) {
  const auto s = static_cast<float>(scale);
  for (std::size_t i = 0; i < a.size(); ++i) to[i] += s * a[i];
}

double largest(const std::vector<float>& a) {
  float max = 0;
  for (std::size_t i = 0; i < a.size(); i += 4)
    max = std::max(max, a[i] * a[i] + a[i + 1] * a[i + 1] + a[i + 2] * a[i + 2]);
  return std::sqrt(static_cast<double>(max));
}

// The minimum of the parabola over the part that was tried.
// @param slope   foreseen change of the value over the part; negative
// @param change  true change
double shortening(double slope, double change) {
  const double bend = change - slope;
  return bend > 0 ? std::clamp(-slope / (2 * bend), kShortest, kLongest) : kLongest;
}

}  // namespace

QuasiNewton::QuasiNewton(const ElasticBody& body, Potential& potential, BodyLoads& loads, StepperWorkspace& scratch,
                         double safe_length, int max_evaluations)
    : body_(body),
      potential_(potential),
      gas_(loads.gas),
      extra_(loads.extra),
      scratch_(scratch),
      unknowns_(scratch.unknowns),
      safe_length_(safe_length),
      max_evaluations_(max_evaluations) {
  unknowns_.begin(scratch.rows);
}

void QuasiNewton::start() {
  start(evaluate(scratch_.z, scratch_.gradient));
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
  if (scratch_.pairs == 0 || exhausted()) return false;
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

// How far the rows are from their targets at z. The potential has the springs.
void QuasiNewton::rowResidual() {
  scratch_.rhs.setZero();
  scratch_.rows.forEachMultiplier(
      [this](int row, const LinearForm& form) { scratch_.rhs[row] = scratch_.target[row] - form.value(scratch_.z); });
}

// Whether the rows that hold stay where they are, but for rounding. Contacts that open or slip, threads that slide and
// slack ones may move freely.
bool QuasiNewton::rowsStay() const {
  const Eigen::VectorXd &moves = scratch_.row_moves, &forces = scratch_.schur.forces();
  const double rounding = kRowRoundings * resolution();
  const double limit = std::max(kSmallResidual * direction_length_, rounding);
  const int contacts_end = scratch_.rows.contactRow(scratch_.rows.counted);
  for (int row = 0; row < contacts_end; ++row)
    if (scratch_.schur.holds(row) && std::abs(moves[row]) > limit) return false;
  const double of_thread = std::max(kThreadShare * direction_length_, rounding);
  for (const ThreadRows& thread : scratch_.rows.threads)
    for (int k = 0; k < thread.count(); ++k) {
      const int row = thread.pullRow(k);
      if (forces[row] > 0 && std::abs(moves[row] - unknowns_.loss(row)) > of_thread) return false;
    }
  return true;
}

// By the move of least energy of the factor, whatever the true energy: what a tool holds goes where the tool goes. The
// line search would admit only small parts of a far move, and no number of them meets the constraint.
bool QuasiNewton::satisfyConstraints() {
  if (extra_ != nullptr && extra_->acts()) return false;  // walls that meet may forbid it
  StepperWorkspace& s = scratch_;
  rowResidual();
  s.rhs += unknowns_.lost();
  unknowns_.addDisplacement(s.rhs);
  double max = 0;
  for (std::size_t i = 0; i < s.rows.equations.size(); ++i) {
    double& rhs = s.rhs[static_cast<Eigen::Index>(i)];
    if (s.rows.equations[i].compliance > 0) rhs = 0;
    max = std::max(max, std::abs(rhs));
  }
  if (max <= std::max(kSmallResidual * direction_length_, kUnmet * resolution())) return false;
  std::fill(s.half.begin(), s.half.end(), 0.0F);
  s.schur.holdThreads(true);  // these forces come in addition: those that limit the slide are not among them
  s.schur.eliminate(s.rhs, 0, s.half.data());
  s.schur.holdThreads(false);
  unknowns_.push(s.schur);
  s.factor->backward(s.half.data(), *s.pool);
  s.factor->store(s.half.data(), s.direction.data());
  for (int i = 0; i < body_.nodeCount(); ++i)
    if (body_.fixed[i] != 0)
      for (int k = 0; k < 3; ++k) s.direction[4 * i + k] = 0;
  setTrial(1);
  s.z.swap(s.trial);
  contracts_ = false;
  start();
  return true;
}

double QuasiNewton::resolution() const {
  return 4 * std::numeric_limits<float>::epsilon() * largest(scratch_.last.displacement);
}

// The forces that the last elimination found.
void QuasiNewton::addRowForces(double sign, std::vector<float>& vector) const {
  scratch_.rows.forEachMultiplier([&](int row, const LinearForm& form) {
    const double force = sign * scratch_.schur.forces()[row];
    if (force != 0) form.addForce(force, vector);
  });
}

void QuasiNewton::setGas(double volume) {
  gas_piece_ = potential_.gas().pieceAt(volume);
  scratch_.schur.setGas(scratch_.last.volume_gradient.data(),
                        potential_.gas().lineOf(gas_piece_, scratch_.last.volume).stiffness, *scratch_.factor);
}

// @returns whether the direction leads to another piece of the gas law than the one it was computed with
bool QuasiNewton::changeGas() {
  if (gas_.control != GasLoad::Control::Regulated) return false;
  const double end = scratch_.last.volume + dot(scratch_.last.volume_gradient, scratch_.direction);
  if (potential_.gas().pieceAt(end) == gas_piece_) return false;
  setGas(end);
  return true;
}

// By how much the volume changes in the direction where the gas has no stiffness of its own. The piece of an
// insufflator's law may lie elsewhere than the present volume.
double QuasiNewton::swelling() const {
  if (gas_.control == GasLoad::Control::Volume) return gas_.target_volume - scratch_.last.volume;
  if (gas_.control != GasLoad::Control::Regulated || gas_piece_ == GasLaw::Piece::Kept) return 0;
  const GasLaw::Line line = potential_.gas().lineOf(gas_piece_, scratch_.last.volume);
  return (line.pressure - scratch_.last.pressure) / line.stiffness;
}

// With what the pressure lacks to the set point where the direction leads there.
void QuasiNewton::loadWork() {
  StepperWorkspace& s = scratch_;
  const double lack = gas_.control == GasLoad::Control::Regulated && gas_piece_ == GasLaw::Piece::Kept
                          ? gas_.set_pressure - s.last.pressure
                          : 0;
  if (lack == 0) return s.factor->load(s.work.data(), s.half.data());
  s.direction = s.work;
  addMultiple(lack, s.last.volume_gradient, s.direction);
  s.factor->load(s.direction.data(), s.half.data());
}

// Two-loop recursion (Nocedal 1980) with the factor, the rows and the gas as initial inverse.
void QuasiNewton::findDirection() {
  StepperWorkspace& s = scratch_;
  const InStage stage(s.stages, StepStage::Inverse);
  rowResidual();
  s.work = s.gradient;
  // forces of rows may be far larger than the remaining gradient: without this, a pair that moves rows by a rounding
  // would consist of their forces only
  if (s.pairs > 0) addRowForces(-1, s.work);
  unknowns_.beginDirection(s.schur);
  double alpha[StepperWorkspace::kHistory];
  for (int i = s.pairs - 1; i >= 0; --i) {
    alpha[i] = s.curvature[i] * (dot(s.move[i], s.work) + unknowns_.gradientTerm(i));
    addMultiple(-alpha[i], s.change[i], s.work);
    unknowns_.subtract(i, alpha[i]);
  }
  if (s.pairs > 0) addRowForces(1, s.work);
  for (float& value : s.work) value = -value;
  applyInverse(alpha);
  if (changeGas()) {
    rowResidual();
    applyInverse(alpha);
  }
  direction_length_ = largest(s.direction);
  slope_ = dot(s.gradient, s.direction);
}

// To the work vector: what follows the first loop.
void QuasiNewton::applyInverse(const double* alpha) {
  StepperWorkspace& s = scratch_;
  ++solves_;
  loadWork();
  s.factor->forward(s.half.data(), *s.pool);
  {
    const InStage stage(s.stages, StepStage::Rows);
    unknowns_.addTargets(s.rhs);
    s.schur.eliminate(s.rhs, swelling(), s.half.data());
    unknowns_.setDirection(s.schur, s.row_moves);
  }
  s.factor->backward(s.half.data(), *s.pool);
  s.factor->store(s.half.data(), s.direction.data());
  for (int i = 0; i < s.pairs; ++i) {
    const double beta = -s.curvature[i] * (dot(s.change[i], s.direction) + unknowns_.directionTerm(i));
    addMultiple(-(alpha[i] - beta), s.move[i], s.direction);
    unknowns_.reduce(i, alpha[i] - beta, s.row_moves);
  }
  for (int i = 0; i < body_.nodeCount(); ++i)
    if (body_.fixed[i] != 0)
      for (int k = 0; k < 3; ++k) s.direction[4 * i + k] = 0;
}

// The value with the rows' (and a prescribed volume's) forces as multipliers, and the energy of what rows give way: it
// falls along the direction although the rows move.
double QuasiNewton::lagrangian(double part) const {
  return unknowns_.energy(part) - (1 - part) * (lagrangianSlope(part) - unknowns_.slope(part));
}

double QuasiNewton::lagrangianSlope(double part) const {
  double sum = unknowns_.slope(part);
  scratch_.rows.forEachMultiplier(
      [&](int row, const LinearForm&) { sum -= scratch_.schur.forces()[row] * scratch_.row_moves[row]; });
  return sum;
}

void QuasiNewton::setTrial(double part) {
  for (std::size_t i = 0; i < scratch_.z.size(); ++i)
    scratch_.trial[i] = scratch_.z[i] + part * static_cast<double>(scratch_.direction[i]);
}

void QuasiNewton::keepPair(double part) {
  StepperWorkspace& s = scratch_;
  if (s.pairs == StepperWorkspace::kHistory) {
    std::rotate(s.move.begin(), s.move.begin() + 1, s.move.end());
    std::rotate(s.change.begin(), s.change.begin() + 1, s.change.end());
    std::rotate(s.curvature.begin(), s.curvature.begin() + 1, s.curvature.end());
    --s.pairs;
    unknowns_.forgetOldest();
  }
  std::vector<float>&move = s.move[s.pairs], &change = s.change[s.pairs];
  const auto p = static_cast<float>(part);
  for (std::size_t i = 0; i < move.size(); ++i) {
    move[i] = p * s.direction[i];
    change[i] = s.trial_gradient[i] - s.gradient[i];
  }
  const double product = dot(move, change) + unknowns_.curvature(part);
  if (!(product > kMinPairCosine * std::sqrt(dot(move, move) * dot(change, change)))) return;
  unknowns_.keep(s.pairs, part);
  s.curvature[s.pairs++] = 1 / product;
}

// Where contacts slide or change, what the history knows of them may lead up. The factor alone leads down then.
void QuasiNewton::aim() {
  if (aimed_) return;
  findDirection();
  if (scratch_.pairs > 0 && slope_ + lagrangianSlope(0) > potential_.noise()) {
    restart();
    findDirection();
  }
  aimed_ = true;
}

const std::vector<double>& QuasiNewton::foreseen() {
  aim();
  setTrial(1);
  return scratch_.trial;
}

void QuasiNewton::takeRows() {
  unknowns_.begin(scratch_.rows);
  aimed_ = false;
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
  const bool begins = first_length_ == 0;
  if (begins) first_length_ = direction_length_;
  const bool shrinks = last_length_ > 0 && direction_length_ < kSafeContraction * last_length_;
  const bool is_short = direction_length_ < safe_length_ && begins;
  contracts_ = part == 1 && (is_short || (shrinks && rest() < kSafeRest * first_length_));
  before_length_ = last_length_;
  last_length_ = -1;  // only a whole step says how fast the next ones shrink
  if (verify || !contracts_) return search(part);
  takeUnseen();
  return direction_length_;
}

// The whole direction, without an evaluation at its end.
void QuasiNewton::takeUnseen() {
  StepperWorkspace& s = scratch_;
  setTrial(1);
  s.z.swap(s.trial);
  unknowns_.move(1);
  if (gas_.control != GasLoad::Control::None) potential_.moveVolume(dot(s.last.volume_gradient, s.direction));
}

double QuasiNewton::slopeAtTrial(double part) const {
  return dot(scratch_.trial_gradient, scratch_.direction) + lagrangianSlope(part);
}

// As much of the direction as lowers the energy.
double QuasiNewton::search(double part) {
  StepperWorkspace& s = scratch_;
  const double prescribed = gas_.control == GasLoad::Control::Volume ? s.schur.gasForce() : 0;
  const double old_pressure = gas_.pressure;
  const double from = value_ + lagrangian(0), slope = slope_ + lagrangianSlope(0);
  double to = value_;
  std::swap(s.last, s.kept);
  for (int trial = 1;; ++trial) {
    setTrial(part);
    if (prescribed != 0) gas_.pressure = old_pressure + part * prescribed;
    to = evaluate(s.trial, s.trial_gradient);
    if (prescribed != 0) break;  // the volume is held: no energy to compare
    const double change = to + lagrangian(part) - from;
    if (std::isfinite(to) && change <= kSufficientDecrease * part * slope + potential_.noise()) break;
    if (change <= kEnergyRoundings * potential_.noise() && slopeAtTrial(part) <= (2 * kSufficientDecrease - 1) * slope)
      break;
    if (trial == kMaxTrials || exhausted()) {
      failed_ = true;
      std::swap(s.last, s.kept);
      return 0;
    }
    part *= std::isfinite(to) ? shortening(part * slope, change) : kShortest;
  }
  // a pair in which the rows move would move them again
  if (rowsStay()) keepPair(part);
  if (part == 1) last_length_ = direction_length_;
  unknowns_.move(part);
  value_ = to;
  s.gradient.swap(s.trial_gradient);
  s.z.swap(s.trial);
  return part * direction_length_;
}

}  // namespace vibe

#include <algorithm>
#include <cmath>

#include "solver/node_vectors.hpp"
#include "solver/quasi_newton.hpp"
#include "vibe_core/solver/energy_term.hpp"
#include "vibe_core/solver/step_policy.hpp"

// How an iteration finds its direction; quasi_newton.cpp has how far it goes along it.

namespace vibe {

void QuasiNewton::takeRows() {
  unknowns_.begin(system_.rows);
  aimed_ = false;
}

// Where contacts slide or change, what the history knows of them may lead up. The factor alone leads down then.
void QuasiNewton::aim() {
  if (aimed_) return;
  findDirection();
  if (history_.count > 0 && slope_ + lagrangianSlope(0) > potential_.noise()) {
    ways_.count(StepWay::PairsDropped);
    restart();
    findDirection();
  }
  aimed_ = true;
}

const std::vector<double>& QuasiNewton::foreseen() {
  aim();
  setTrial(1);
  return at_.trial;
}

// Two-loop recursion (Nocedal 1980) with the factor, the rows and the gas as initial inverse.
void QuasiNewton::findDirection() {
  const InStage stage(scratch_.stages, StepStage::Inverse);
  rowResidual();
  at_.work = at_.gradient;
  // forces of rows may be far larger than the remaining gradient: without this, a pair that moves rows by a rounding
  // would consist of their forces only
  if (history_.count > 0) addRowForces(-1, at_.work);
  unknowns_.beginDirection(system_.schur);
  double alpha[PairHistory::kSize];
  for (int i = history_.count - 1; i >= 0; --i) {
    alpha[i] = history_.curvature[i] * (dot(history_.move[i], at_.work) + unknowns_.gradientTerm(i));
    addMultiple(-alpha[i], history_.change[i], at_.work);
    unknowns_.subtract(i, alpha[i]);
  }
  if (history_.count > 0) addRowForces(1, at_.work);
  for (float& value : at_.work) value = -value;
  applyInverse(alpha);
  // the direction may lead to where an insufflator's law is another: once more with the stiffness there
  if (changeGas()) {
    rowResidual();
    applyInverse(alpha);
  }
  direction_length_ = largest(at_.direction);
  slope_ = dot(at_.gradient, at_.direction);
}

// To the work vector: what follows the first loop.
void QuasiNewton::applyInverse(const double* alpha) {
  ++solves_;
  loadWork();
  scratch_.factors.current->forward(at_.half.data(), *scratch_.pool);
  // half solved, the rows cost their own few nodes only
  {
    const InStage stage(scratch_.stages, StepStage::Rows);
    unknowns_.addTargets(system_.rhs);
    system_.schur.eliminate(system_.rhs, swelling(), at_.half.data());
    unknowns_.setDirection(system_.schur, system_.row_moves);
  }
  scratch_.factors.current->backward(at_.half.data(), *scratch_.pool);
  scratch_.factors.current->store(at_.half.data(), at_.direction.data());
  // second loop; the rows move with the pairs that it takes back
  for (int i = 0; i < history_.count; ++i) {
    const double beta = -history_.curvature[i] * (dot(history_.change[i], at_.direction) + unknowns_.directionTerm(i));
    addMultiple(-(alpha[i] - beta), history_.move[i], at_.direction);
    unknowns_.reduce(i, alpha[i] - beta, system_.row_moves);
  }
  for (int i = 0; i < body_.nodeCount(); ++i)
    if (body_.fixed[i] != 0)
      for (int k = 0; k < 3; ++k) at_.direction[4 * i + k] = 0;
}

// How far the rows are from their targets at z. The potential has the springs.
void QuasiNewton::rowResidual() {
  system_.rhs.setZero();
  system_.rows.forEachMultiplier(
      [this](int row, const LinearForm& form) { system_.rhs[row] = system_.target[row] - form.value(at_.z); });
}

// The forces that the last elimination found.
void QuasiNewton::addRowForces(double sign, std::vector<float>& vector) const {
  system_.rows.forEachMultiplier([&](int row, const LinearForm& form) {
    const double force = sign * system_.schur.forces()[row];
    if (force != 0) form.addForce(force, vector);
  });
}

// With what the pressure lacks to the set point where the direction leads there.
void QuasiNewton::loadWork() {
  const double lack = gas_.control == GasLoad::Control::Regulated && gas_piece_ == GasLaw::Piece::Kept
                          ? gas_.set_pressure - at_.last.pressure
                          : 0;
  if (lack == 0) return scratch_.factors.current->load(at_.work.data(), at_.half.data());
  at_.direction = at_.work;
  addMultiple(lack, at_.last.volume_gradient, at_.direction);
  scratch_.factors.current->load(at_.direction.data(), at_.half.data());
}

void QuasiNewton::setGas(double volume) {
  gas_piece_ = potential_.gas().pieceAt(volume);
  system_.schur.setGas(at_.last.volume_gradient.data(), potential_.gas().lineOf(gas_piece_, at_.last.volume).stiffness,
                       *scratch_.factors.current);
}

// @returns whether the direction leads to another piece of the gas law than the one it was computed with
bool QuasiNewton::changeGas() {
  if (gas_.control != GasLoad::Control::Regulated) return false;
  const double end = at_.last.volume + dot(at_.last.volume_gradient, at_.direction);
  if (potential_.gas().pieceAt(end) == gas_piece_) return false;
  setGas(end);
  return true;
}

// By how much the volume changes in the direction where the gas has no stiffness of its own. The piece of an
// insufflator's law may lie elsewhere than the present volume.
double QuasiNewton::swelling() const {
  if (gas_.control == GasLoad::Control::Volume) return gas_.target_volume - at_.last.volume;
  if (gas_.control != GasLoad::Control::Regulated || gas_piece_ == GasLaw::Piece::Kept) return 0;
  const GasLaw::Line line = potential_.gas().lineOf(gas_piece_, at_.last.volume);
  return (line.pressure - at_.last.pressure) / line.stiffness;
}

// By the move of least energy of the factor, whatever the true energy: what a tool holds goes where the tool goes. The
// line search would admit only small parts of a far move, and no number of them meets the constraint.
bool QuasiNewton::satisfyConstraints() {
  if (extra_ != nullptr && extra_->acts()) return false;  // walls that meet may forbid it
  rowResidual();
  system_.rhs += unknowns_.lost();
  unknowns_.addDisplacement(system_.rhs);
  // springs are met where they balance, so only what is held exactly counts
  double max = 0;
  for (std::size_t i = 0; i < system_.rows.equations.size(); ++i) {
    double& rhs = system_.rhs[static_cast<Eigen::Index>(i)];
    if (system_.rows.equations[i].compliance > 0) rhs = 0;
    max = std::max(max, std::abs(rhs));
  }
  const double met =
      std::max(stepPolicy().small_residual * direction_length_, stepPolicy().unmet_roundings * resolution());
  if (max <= met) return false;
  ways_.count(StepWay::ConstraintsMet);
  std::fill(at_.half.begin(), at_.half.end(), 0.0F);
  system_.schur.holdThreads(true);  // these forces come in addition: those that limit the slide are not among them
  system_.schur.eliminate(system_.rhs, 0, at_.half.data());
  system_.schur.holdThreads(false);
  unknowns_.push(system_.schur);
  scratch_.factors.current->backward(at_.half.data(), *scratch_.pool);
  scratch_.factors.current->store(at_.half.data(), at_.direction.data());
  for (int i = 0; i < body_.nodeCount(); ++i)
    if (body_.fixed[i] != 0)
      for (int k = 0; k < 3; ++k) at_.direction[4 * i + k] = 0;
  setTrial(1);
  at_.z.swap(at_.trial);
  contracts_ = false;
  start();
  return true;
}

}  // namespace vibe

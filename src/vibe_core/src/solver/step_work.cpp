#include "solver/step_work.hpp"

#include <cmath>

#include "vibe_core/solver/step_policy.hpp"

namespace vibe {

namespace {

/// Sums over the nodes of products with their moves over the step.
struct Sums {
  double move2 = 0;                  // of the moves with themselves [m^2]
  double inertia = 0, damping = 0;   // of mass times mean acceleration, of mass times mean velocity [J], [J s]
  double kinetic = 0;                // change of the kinetic energy [J]
  double weight = 0;                 // of the gravity [J]
  double to_z = 0;                   // of z - x [m^2]
  double to_first = 0, to_last = 0;  // of the points of evaluation [m^2]
};

// Moves one coordinate of the nodes.
void moveAxis(const ElasticBody& body, const TimeScheme& scheme, int k, const MotionView& motion, bool mean_velocity,
              StepperWorkspace& scratch, Sums& sums) {
  const double per_gain = 1 / scheme.z_gain, per_step = 1 / scheme.h;
  double *const x = motion.x[k], *const v = motion.v[k], *const a = motion.a[k];
  const double* const z = scratch.iterate.z.data() + k;
  const double* const rest = scratch.rest.data() + k;
  double* const move = scratch.moves.data() + k;
  const float *const first = scratch.iterate.first.displacement.data() + k,
                     *const last = scratch.iterate.last.displacement.data() + k;
  for (int i = 0; i < body.nodeCount(); ++i) {
    move[4 * i] = 0;
    if (body.fixed[i] != 0) continue;
    // the acceleration at the end, from which the scheme gives position and velocity
    const double end = (z[4 * i] - scheme.free_z(x[i], v[i], a[i])) * per_gain;
    const double to = scheme.free_x(x[i], v[i], a[i]) + scheme.x_gain * end, d = to - x[i];
    const double speed = v[i] + scheme.free_v_a * a[i] + scheme.v_gain * end, mass = body.mass[i];
    const double from = x[i] - rest[4 * i];
    sums.move2 += d * d;
    sums.inertia += mass * ((1 - scheme.alpha_m) * end + scheme.alpha_m * a[i]) * d;
    sums.damping += mass * (speed + scheme.alpha_f * (v[i] - speed)) * d;
    // what the step leaves behind may be the mean velocity; then the kinetic energy is that of it
    const double stored = mean_velocity ? d * per_step : speed;
    sums.kinetic += 0.5 * mass * (stored * stored - v[i] * v[i]);
    sums.weight += mass * body.gravity[k] * d;
    sums.to_z += (z[4 * i] - x[i]) * d;
    sums.to_first += (first[4 * i] - from) * d;
    sums.to_last += (last[4 * i] - from) * d;
    move[4 * i] = d;
    x[i] = to;
    v[i] = stored;
    a[i] = mean_velocity ? 0 : end;
  }
}

double dotInDouble(const std::vector<float>& a, const std::vector<double>& b) {
  double sum[4] = {0, 0, 0, 0};
  for (std::size_t i = 0; i < a.size(); i += 4)
    for (int k = 0; k < 4; ++k) sum[k] += static_cast<double>(a[i + k]) * b[i + k];
  return (sum[0] + sum[1]) + sum[2];
}

/// A force along the way of the step, times this way, as a polynomial in the part of the step.
struct ForceAlong {
  double from = 0, length = 0;  // of the interval between the points of evaluation
  double first = 0, slope = 0, curvature = 0;

  double at(double part) const {
    const double u = part - from;
    return first + u * (slope + curvature * (u - length));
  }
  /// From the start of the step to its end.
  double integral() const { return integralTo(1 - from) - integralTo(-from); }
  /// From the start of the step to the first point of evaluation.
  double integralToFirst() const { return -integralTo(-from); }

 private:
  double integralTo(double u) const { return u * (first + u * (slope / 2 + curvature * (u / 3 - length / 2))); }
};

/// @param energy  how much more energy the last point has than the trapezoidal rule between the two says [J]
ForceAlong forceAlong(double from, double to, double first, double last, double energy) {
  ForceAlong force;
  force.from = from;
  force.length = to - from;
  force.first = first;
  if (std::abs(force.length) > stepPolicy().least_slope_part) force.slope = (last - first) / force.length;
  if (force.length > stepPolicy().least_curved_part)
    force.curvature = -6 * energy / (force.length * force.length * force.length);
  return force;
}

// How much more energy the last point of evaluation has than the trapezoidal rule says, with that of a constant stress
// [J].
double beyondTrapezoid(const Evaluation& first, const Evaluation& last) {
  double twice = 0;
  for (std::size_t i = 0; i < last.displacement.size(); ++i)
    twice += (static_cast<double>(first.elastic_gradient[i]) + last.elastic_gradient[i]) *
             (static_cast<double>(last.displacement[i]) - first.displacement[i]);
  return (last.elastic_value + last.stress_work) - (first.elastic_value + first.stress_work) - 0.5 * twice;
}

// Of the rows on the body, in all.
double workOfRows(StepperWorkspace& scratch, BodyLoads& loads) {
  const std::vector<double>& move = scratch.moves;
  const ConstraintRows& rows = scratch.system.rows;
  const Eigen::VectorXd& force = scratch.system.schur.forces();
  double sum = 0;
  Eigen::VectorXd& work = scratch.system.work;
  work.setZero(rows.count());
  rows.forEachMultiplier(
      [&](int row, const LinearForm& form) { work[row] = force[row] == 0 ? 0 : force[row] * form.value(move); });
  rows.forEachSpring([&](int row, const LinearForm& form, double compliance) {
    work[row] = (scratch.system.target[row] - form.value(scratch.iterate.z)) / compliance * form.value(move);
  });
  for (std::size_t i = 0; i < loads.constraints.size(); ++i) sum += loads.constraints[i].work = work[i];
  for (ContactConstraint& contact : loads.contacts) contact.work = 0;
  for (std::size_t c = 0; c < rows.counted; ++c)
    sum += loads.contacts[rows.contacts[c].load].work = work.segment<3>(rows.contactRow(c)).sum();
  for (std::size_t t = 0; t < loads.threads.size(); ++t)
    sum += loads.threads[t].work = work.segment(rows.threads[t].first_row, 3 * rows.threads[t].count()).sum();
  return sum;
}

}  // namespace

StepWork finishMotion(const ElasticBody& body, const TimeScheme& scheme, const MotionView& motion, BodyLoads& loads,
                      bool mean_velocity, StepperWorkspace& scratch) {
  Sums s;
  for (int k = 0; k < 3; ++k) moveAxis(body, scheme, k, motion, mean_velocity, scratch, s);
  StepWork work;
  const double rows = workOfRows(scratch, loads);
  // nothing moved: no force has worked
  if (!(s.move2 > 0)) return work;
  const std::vector<double>& move = scratch.moves;
  const double first = s.to_first / s.move2, last = s.to_last / s.move2, at = s.to_z / s.move2;
  const ForceAlong elastic = forceAlong(first, last, dotInDouble(scratch.iterate.first.elastic_gradient, move),
                                        dotInDouble(scratch.iterate.last.elastic_gradient, move),
                                        beyondTrapezoid(scratch.iterate.first, scratch.iterate.last));
  if (loads.extra != nullptr)
    work.extra = -forceAlong(first, last, dotInDouble(scratch.iterate.first.extra_gradient, move),
                             dotInDouble(scratch.iterate.last.extra_gradient, move), 0)
                      .at(at);
  if (loads.gas.control != GasLoad::Control::None)
    work.gas = scratch.iterate.last.pressure * dotInDouble(scratch.iterate.last.volume_gradient, move);
  // what the scheme and the damping take is the difference between forces at their points of evaluation and along the
  // way
  work.mass_damping = scheme.rate * s.damping;
  work.viscous = elastic.at(at) - elastic.at(scheme.part());
  work.stored = elastic.integral();
  work.to_first = elastic.integralToFirst();
  work.numerical = s.inertia - s.kinetic + elastic.at(scheme.part()) - work.stored;
  work.residual = s.inertia + work.mass_damping + elastic.at(at) - s.weight - work.gas - work.extra - rows;
  return work;
}

}  // namespace vibe

#include "policy/policy_study.hpp"

#include <algorithm>
#include <cmath>

#include "contact/bench_tools.hpp"
#include "contact/contact_table.hpp"
#include "vibe_core/arithmetic/random.hpp"
#include "vibe_core/files/fnv1a.hpp"
#include "vibe_core/files/number_text.hpp"
#include "vibe_core/simulation/simulation.hpp"

namespace vibe::benchmarks {

namespace {

constexpr int kTargets = 64;
constexpr int kOutOfReach = 4;    // every so many targets one lies farther away
constexpr double kFarther = 0.1;  // [m]

void addPoints(const State& state, PolicyTrace& trace) {
  std::vector<Eigen::Vector3d>& points = trace.points.emplace_back();
  for (std::size_t i = 0; i < state.x.size(); ++i) points.emplace_back(state.x[i], state.y[i], state.z[i]);
}

void addStep(const ContactCase& one, const Simulation& simulation, PolicyTrace& trace, Fnv1a& bits) {
  const StepReport& report = simulation.report();
  trace.force.push_back(signalOf(one, simulation.state()));
  trace.stiffness.emplace_back(Eigen::Matrix3d::Zero());
  if (report.tool_impedance) trace.stiffness.back() = report.tool_impedance->stiffness;
  addPoints(simulation.state(), trace);
  ++trace.steps;
  trace.iterations += report.iterations;
  trace.evaluations += report.evaluations;
  trace.solved_again += report.solves > 1 ? 1 : 0;
  trace.fallback += report.fallback ? 1 : 0;
  const std::uint64_t hash = simulation.hash();
  bits.add(&hash, sizeof hash);
  bits.add(trace.force.back().data(), 3 * sizeof(double));
  bits.add(trace.stiffness.back().data(), 9 * sizeof(double));
}

/// The model and all that a step needs are made with the policy in use.
PolicyTrace runState(const ContactCase& one) {
  const Scene& scene = one.model->scene;
  const int rate = static_cast<int>(std::lround(1 / scene.step_period));
  Simulation simulation(modelAt(one, {rate, scene.tissue.iterations, scene.tissue.spectral_radius}),
                        SimulationSettings::study(1));
  simulation.replaceState(one.start);
  PolicyTrace trace;
  Fnv1a bits;
  const int steps = static_cast<int>(std::lround(one.duration * rate));
  for (int k = 1; k <= steps; ++k) {
    simulation.step(one.input(static_cast<double>(k) / rate));
    addStep(one, simulation, trace, bits);
  }
  trace.bits = bits.result();
  return trace;
}

/// The tip where inverse kinematics brings it, one target after the other, as a trainee that looks around.
PolicyTrace aim(const ToolModel& tool) {
  PolicyTrace trace;
  Fnv1a bits;
  std::uint64_t random = 7;
  std::vector<Eigen::Isometry3d> poses(static_cast<std::size_t>(tool.linkCount()));
  const auto tip = static_cast<std::size_t>(tool.linkIndex("scope_tip"));
  std::array<double, kJointCount> joints{};
  for (int target = 0; target < kTargets; ++target) {
    std::array<double, kJointCount> wanted{};
    for (std::size_t j = 0; j < kScopeJointCount; ++j) {
      const JointLimits& limit = tool.limits()[j];
      wanted[j] = limit.lower + (limit.upper - limit.lower) * nextUniform(random);
    }
    tool.forwardKinematics(wanted, poses);
    Eigen::Isometry3d aimed = poses[tip];
    if (target % kOutOfReach == 0) aimed.translation() += kFarther * aimed.linear().col(2);
    joints = tool.inverseKinematics(aimed, joints);
    tool.forwardKinematics(joints, poses);
    trace.points.push_back({poses[tip].translation()});
    bits.add(joints.data(), sizeof joints);
  }
  trace.bits = bits.result();
  return trace;
}

void compareForces(const PolicyTrace& with, const PolicyTrace& without, PolicyEffect& effect) {
  double most = 0, change = 0, stiffest = 0, softer = 0;
  for (std::size_t k = 0; k < without.force.size(); ++k) {
    most = std::max(most, without.force[k].norm());
    change = std::max(change, (with.force[k] - without.force[k]).norm());
    stiffest = std::max(stiffest, without.stiffness[k].norm());
    softer = std::max(softer, (with.stiffness[k] - without.stiffness[k]).norm());
  }
  if (most > 0) effect.force = std::max(effect.force, change / most);
  if (stiffest > 0) effect.stiffness = std::max(effect.stiffness, softer / stiffest);
}

void compareMotion(const PolicyTrace& with, const PolicyTrace& without, PolicyEffect& effect) {
  double sum = 0, count = 0, most2 = 0;
  for (std::size_t k = 0; k < without.points.size(); ++k)
    for (std::size_t i = 0; i < without.points[k].size(); ++i) {
      const double off2 = (with.points[k][i] - without.points[k][i]).squaredNorm();
      sum += off2, most2 = std::max(most2, off2), ++count;
    }
  effect.motion_rms = std::max(effect.motion_rms, std::sqrt(sum / std::max(1.0, count)));
  effect.motion_max = std::max(effect.motion_max, std::sqrt(most2));
}

}  // namespace

PolicyStudy::PolicyStudy(const Scene& scene, const std::string& urdf, std::ostream& log)
    : states_(policyStates(scene, urdf, log)), scope_(states_.front().model), defaults_(runAll()) {}

std::vector<PolicyTrace> PolicyStudy::runAll() const {
  std::vector<PolicyTrace> traces;
  for (const ContactCase& one : states_) traces.push_back(runState(one));
  traces.push_back(aim(*scope_->tool));
  return traces;
}

PolicyEffect PolicyStudy::effectOf(const PolicyNumber& number, double factor) const {
  StepPolicy shifted = stepPolicy();
  number.scale(shifted, factor);
  const ScopedStepPolicy scoped(shifted);
  const std::vector<PolicyTrace> traces = runAll();
  PolicyEffect effect;
  effect.factor = factor;
  effect.value = number.of(shifted);
  for (std::size_t s = 0; s < traces.size(); ++s) {
    const PolicyTrace &with = traces[s], &without = defaults_[s];
    if (with.bits != without.bits) effect.states.push_back(s < states_.size() ? states_[s].name : "aimed");
    compareForces(with, without, effect);
    compareMotion(with, without, effect);
    effect.iterations += with.iterations - without.iterations;
    effect.evaluations += with.evaluations - without.evaluations;
    effect.solved_again += with.solved_again - without.solved_again;
    effect.fallback += with.fallback - without.fallback;
  }
  return effect;
}

PolicyTrace PolicyStudy::total() const {
  PolicyTrace sum;
  for (const PolicyTrace& trace : defaults_) {
    sum.steps += trace.steps;
    sum.iterations += trace.iterations;
    sum.evaluations += trace.evaluations;
    sum.solved_again += trace.solved_again;
    sum.fallback += trace.fallback;
  }
  return sum;
}

void writePolicyHeader(std::ostream& out) {
  out << "number,factor,value,states,force_change,motion_rms_mm,motion_max_mm,stiffness_change,iterations,evaluations,"
         "solved_again,fallback_steps,steps\n";
}

void writePolicyTotal(const PolicyTrace& total, std::ostream& out) {
  out << "defaults,1,,,,,,," << total.iterations << "," << total.evaluations << "," << total.solved_again << ","
      << total.fallback << "," << total.steps << "\n";
}

void writePolicyEffect(const PolicyNumber& number, const PolicyEffect& effect, std::ostream& out) {
  std::string states;
  for (const std::string& state : effect.states) states += (states.empty() ? "" : " ") + state;
  out << number.name << ","
      << formatted("%g,%g,%s,%.3g,%.3g,%.3g,%.3g,%ld,%ld,%d,%d,\n", effect.factor, effect.value, states.c_str(),
                   effect.force, 1e3 * effect.motion_rms, 1e3 * effect.motion_max, effect.stiffness, effect.iterations,
                   effect.evaluations, effect.solved_again, effect.fallback)
      << std::flush;
}

namespace {

constexpr double kSweep = 0.7;          // of both angles of the tip, beyond those of a pressed scope [rad]
constexpr double kSweepTime = 0.4;      // [s]
constexpr double kRamSpeed = 0.5;       // [m/s]
constexpr double kRamWay = 0.06;        // [m]
constexpr double kRamTime = 0.4;        // until it is withdrawn again, and after it [s]
constexpr double kLowPressure = 130;    // 1 mmHg: walls of a fold meet [Pa]
constexpr double kDeflationTime = 1.5;  // [s]

/// The scope presses the wall and then slides along it.
ContactCase swept(ContactCase pressed) {
  pressed.name = "swept";
  pressed.input = [press = pressed.input, begin = pressed.duration](double end) {
    StepInput input = press(end);
    const double part = std::clamp((end - begin) / kSweepTime, 0.0, 1.0);
    input.joints[TipUpDown] += kSweep * part;
    input.joints[TipLeftRight] += kSweep * part;
    return input;
  };
  pressed.duration += kSweepTime + 0.1;
  return pressed;
}

/// The scope, straight, is pushed into the wall at a speed at which a step is longer than the wall is thick.
ContactCase rammed(ContactCase pressed) {
  pressed.name = "rammed";
  JointLimits limits = pressed.model->tool->limits()[Insertion];
  limits.velocity = std::max(limits.velocity, 1.01 * kRamSpeed);
  pressed.urdf = withJointLimits(pressed.urdf, "insertion", limits);
  pressed.input = [near = holdAt(pressed.start)](double end) {
    StepInput input = near;
    const double way = std::min(kRamWay, kRamSpeed * end), back = std::max(0.0, kRamSpeed * (end - kRamTime));
    input.joints[Insertion] += way - std::min(way, back);
    return input;
  };
  pressed.duration = 2 * kRamTime;
  return pressed;
}

/// The hand holds a fold while the stomach collapses around it.
ContactCase deflated(ContactCase wound) {
  wound.name = "deflated";
  Scene scene = wound.model->scene;
  scene.gas->regulated_pressure = kLowPressure;
  wound.model = modelWith(scene, wound.urdf, *wound.model);
  wound.input = [still = wound.input(0)](double) { return still; };
  wound.duration = kDeflationTime;
  return wound;
}

}  // namespace

std::vector<ContactCase> policyStates(const Scene& scene, const std::string& urdf, std::ostream& log) {
  ContactStates states(scene, urdf, log);
  const ContactCase pressed = states.prepare("pressed"), wound = states.prepare("wound");
  return {pressed, swept(pressed), rammed(pressed), wound, deflated(wound), states.prepare("cinch1")};
}

std::string describePolicyStates() {
  return "  pressed, wound, cinch1  as those of `vibe_contact states`\n"
         "  swept                   pressed, then the tip is bent by 0.7 rad both ways in 0.4 s\n"
         "  rammed                  the scope, straight, is pushed 60 mm into the wall at 0.5 m/s and withdrawn\n"
         "  deflated                wound, held while the pressure falls to 1 mmHg\n"
         "  aimed                   joints for 64 targets of the tip, of which a quarter is out of reach\n";
}

}  // namespace vibe::benchmarks

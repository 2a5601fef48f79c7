#include "vibe_hardware/emulator/haptic_loop.hpp"

#include <algorithm>
#include <cmath>

#include "emulator/loop_host.hpp"
#include "vibe_core/files/files.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe::hardware {
namespace {

std::shared_ptr<const Model> modelOf(Scene scene, double step_period) {
  scene.step_period = step_period;
  return buildModel(scene, scene.scope ? readTextFile(resolveAddress(scene.scope->urdf), "URDF") : "");
}

/// Force of the tissue on the tool along the insertion [N].
double insertionForce(const Simulation& simulation) {
  const Model& model = simulation.model();
  std::vector<Eigen::Isometry3d> poses;
  model.tool->forwardKinematics(simulation.state().joints, simulation.state().tool_displacement, poses);
  const Eigen::Isometry3d tip = model.tool_base * poses[model.tip_link];
  const Eigen::Vector3d force = tip.linear() * simulation.state().tool_force;
  return model.tool_base.linear().col(0).dot(force);
}

/// Everything that runs at the same time.
class Loop {
 public:
  Loop(const Scene& scene, const HapticLoopSettings& settings)
      : settings_(settings),
        emulator_(settings.setup, settings.hand),
        bus_(emulator_),
        host_(bus_, settings.setup.calibration, [this] { return emulator_.time(); }),
        frames_(modelOf(scene, scene.step_period), SimulationSettings::study(scene.seed)),
        reference_model_(modelOf(scene, kTick)) {
    axis_ = axisOfInsertion(settings.setup.calibration);
  }

  HapticLoopResult run() {
    const auto count = std::lround(settings_.duration / kTick);
    for (long i = 0; i < count; ++i) millisecond();
    const HapticStatistics statistics = host_.statistics();
    result_.parameter_sets = static_cast<int>(statistics.sent);
    result_.clamped = static_cast<int>(statistics.clamped);
    result_.refused = static_cast<int>(statistics.refused);
    result_.mismatched = static_cast<int>(statistics.mismatched);
    for (const auto& suture : frames_.state().procedure.sutures)
      for (const double tension : suture.tension) result_.thread_tension = std::max(result_.thread_tension, tension);
    return std::move(result_);
  }

 private:
  static std::size_t axisOfInsertion(const Calibration& calibration) {
    const JointCalibration& insertion = calibration.joints[Insertion];
    if (insertion.device != DeviceKind::Haptic)
      throw Error("The insertion is not on the haptic device; the loop needs a calibration that puts it there.");
    return static_cast<std::size_t>(insertion.axis);
  }

  void millisecond() {
    const double frame_end = static_cast<double>(frame_ + 1) * frames_.stepPeriod();
    if (emulator_.time() >= frame_end) computeFrame();
    if (pending_ && emulator_.time() >= pending_time_) {
      host_.render(frames_.toolImpedance(), settings_.rendering);
      pending_ = false;
    }
    emulator_.tick();
    bus_.collect();
    host_.poll();
    const bool passivity = emulator_.haptic().firmware().state().axes[axis_].passivity_acts;
    result_.passivity_acts += passivity ? 1 : 0;
    result_.samples.push_back(sampleNow());
  }

  /// The frame that has just ended, with the input that was known when it began.
  void computeFrame() {
    frames_.step(host_.inputAt(static_cast<double>(frame_) * frames_.stepPeriod()));
    ++frame_;
    pending_ = true;
    pending_time_ = emulator_.time() + settings_.latency;
    const auto& impedance = frames_.toolImpedance();
    if (!impedance) return;
    result_.max_stiffness = std::max(result_.max_stiffness, impedance->joints[Insertion].stiffness);
    result_.max_damping = std::max(result_.max_damping, impedance->joints[Insertion].damping);
  }

  HapticLoopSample sampleNow() {
    const AxisPlantState& axis = emulator_.haptic().axis(axis_);
    const AxisPlant& plant = emulator_.haptic().plant(axis_);
    const JointScale& joint = settings_.setup.calibration.joints[Insertion].scale;
    HapticLoopSample sample;
    sample.time = emulator_.time();
    sample.insertion = jointPosition(joint, axis.position);
    sample.rendered = jointEffort(joint, static_cast<double>(emulator_.haptic().torques()[axis_]));
    // the hand pulls with as much as the device pushes; its own mass counts as part of the device
    const double speed = (axis.intended - last_intended_) / kTick;
    last_intended_ = axis.intended;
    sample.felt = -jointEffort(
        joint, plant.hand.stiffness * (axis.intended - axis.position) + plant.hand.damping * (speed - axis.velocity));
    sample.motor = axis.energy.motor;
    sample.frame = frames_.toolImpedance() ? insertionForce(frames_) : 0;
    if (sample.time > settings_.measure_from) measure(sample);
    return sample;
  }

  void measure(HapticLoopSample& sample) {
    if (!reference_) {
      reference_ = std::make_unique<Simulation>(reference_model_, SimulationSettings::study(0));
      reference_->replaceState(frames_.state());
    }
    StepInput input = host_.input();
    for (std::size_t joint = 0; joint < kScopeJointCount; ++joint) {  // without encoder and without delay
      const JointCalibration& c = settings_.setup.calibration.joints[joint];
      if (c.device != DeviceKind::Haptic) continue;
      const double position = emulator_.haptic().axis(static_cast<std::size_t>(c.axis)).position;
      input.joints[joint] = jointPosition(c.scale, position);
    }
    reference_->step(input);
    sample.reference = insertionForce(*reference_);
    sample.measured = true;
  }

  const HapticLoopSettings& settings_;
  Emulator emulator_;
  EmulatorBus bus_;
  LoopHost host_;
  Simulation frames_;
  std::shared_ptr<const Model> reference_model_;
  std::unique_ptr<Simulation> reference_;
  HapticLoopResult result_;
  std::size_t axis_ = 0;
  std::int64_t frame_ = 0;
  bool pending_ = false;
  double pending_time_ = 0, last_intended_ = 0;
};

void removeMean(std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  for (double& value : values) value -= sum / static_cast<double>(values.size());
}

/// Mean product of two series, the second one read `lag` samples later.
double correlation(const std::vector<double>& a, const std::vector<double>& b, long lag, long margin) {
  double sum = 0;
  const long size = static_cast<long>(a.size());
  for (long i = margin; i < size - margin; ++i) sum += a[i] * b[i + lag];
  return sum;
}

/// Lag of b behind a at the maximum of their correlation, between samples by a parabola [samples].
double lagOf(const std::vector<double>& a, const std::vector<double>& b) {
  constexpr long kMargin = 60;
  if (a.size() < 4 * kMargin) return 0;
  long best = 0;
  double most = correlation(a, b, 0, kMargin);
  for (long lag = 1 - kMargin; lag < kMargin; ++lag) {
    const double value = correlation(a, b, lag, kMargin);
    if (value > most) most = value, best = lag;
  }
  if (std::abs(best) == kMargin - 1) return static_cast<double>(best);  // no maximum within
  const double before = correlation(a, b, best - 1, kMargin), after = correlation(a, b, best + 1, kMargin);
  const double bend = before - 2 * most + after;
  return static_cast<double>(best) + (bend < 0 ? 0.5 * (before - after) / bend : 0);
}

}  // namespace

RenderingError renderingError(const std::vector<HapticLoopSample>& samples) {
  std::vector<double> reference, rendered;
  RenderingError error;
  const HapticLoopSample* first = nullptr;
  const HapticLoopSample* last = nullptr;
  for (const HapticLoopSample& s : samples) {
    if (!s.measured) continue;
    reference.push_back(s.reference), rendered.push_back(s.rendered);
    error.rendered += std::pow(s.rendered - s.reference, 2);
    error.felt += std::pow(s.felt - s.reference, 2);
    if (last != nullptr) error.tissue_energy += s.reference * (s.insertion - last->insertion);
    first = first == nullptr ? &s : first;
    last = &s;
    error.motor_energy = s.motor - first->motor;
    error.most_energy = std::max(error.most_energy, error.motor_energy);
  }
  removeMean(reference), removeMean(rendered);
  for (const double value : reference) error.change += value * value;
  const auto count = static_cast<double>(std::max<std::size_t>(reference.size(), 1));
  for (double* value : {&error.change, &error.rendered, &error.felt}) *value = std::sqrt(*value / count);
  error.delay = kTick * lagOf(reference, rendered);
  return error;
}

HapticLoopResult runHapticLoop(const Scene& scene, const HapticLoopSettings& settings) {
  if (!scene.scope)
    throw Error("The scene '" + scene.name +
                "' has no scope, so there is no force to render; add the key 'scope' to it.");
  return Loop(scene, settings).run();
}

}  // namespace vibe::hardware

#include "vibe_hardware/emulator/haptic_loop.hpp"

#include <algorithm>
#include <cmath>
#include <deque>

#include "vibe_core/common/package_path.hpp"
#include "vibe_firmware/core/passivity.hpp"

namespace vibe {
namespace {

using vibe_firmware::ParameterReport;

std::shared_ptr<const Model> modelOf(Scene scene, double step_period) {
  scene.step_period = step_period;
  return buildModel(scene, scene.scope ? readTextFile(resolveAddress(scene.scope->urdf), "URDF") : "");
}

/// Force of the tissue on the tool along the insertion [N].
double insertionForce(const Simulation& simulation) {
  const Model& model = simulation.model();
  std::vector<Eigen::Isometry3d> poses;
  model.tool->forwardKinematics(simulation.state().joints, poses);
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
        host_(emulator_.haptic().function()),
        frames_(modelOf(scene, scene.step_period), SimulationSettings::study(scene.seed)),
        reference_model_(modelOf(scene, kTick)) {}

  HapticLoopResult run() {
    const auto count = std::lround(settings_.duration / kTick);
    for (long i = 0; i < count; ++i) millisecond();
    return std::move(result_);
  }

 private:
  void millisecond() {
    const double frame_end = static_cast<double>(frame_ + 1) * frames_.stepPeriod();
    if (emulator_.time() >= frame_end) computeFrame();
    if (pending_ && emulator_.time() >= pending_time_) sendPending();
    emulator_.tick();
    readReports();
    const bool passivity = (emulator_.haptic().firmware().state().status.flags & vibe_firmware::kPassivityActs) != 0;
    result_.passivity_acts += passivity ? 1 : 0;
    result_.samples.push_back(sampleNow());
  }

  // --- host

  struct Reported {
    double time;
    std::array<double, kScopeJointCount> joints;
  };

  void readReports() {
    std::uint8_t bytes[vibe_firmware::kInputReportSize];
    const std::array<EmulatedDevice*, 2> devices{&emulator_.haptic(), &emulator_.input()};
    for (std::size_t d = 0; d < devices.size(); ++d) {
      vibe_firmware::InputReport report;
      if (!devices[d]->nextReport(bytes) || !unpack(bytes, sizeof bytes, report)) continue;
      const auto& axes = d == 0 ? settings_.setup.haptic.axes : settings_.setup.input.axes;
      for (std::size_t a = 0; a < axes.size(); ++a)
        joints_[2 * d + a] = jointPosition(settings_.setup.joints[2 * d + a],
                                           report.counts[a] * static_cast<double>(axes[a].radians_per_count));
      if (d == 1) reported_.push_back({emulator_.time(), joints_});
    }
  }

  /// The frame that has just ended, with the joints that were known when it began.
  void computeFrame() {
    const double begin = static_cast<double>(frame_) * frames_.stepPeriod();
    while (reported_.size() > 1 && reported_[1].time <= begin) reported_.pop_front();
    StepInput input;
    if (!reported_.empty() && reported_[0].time <= begin)
      std::copy(reported_[0].joints.begin(), reported_[0].joints.end(), input.joints.begin());
    if (settings_.others) settings_.others(begin, input);
    frames_.step(input);
    ++frame_;
    prepareParameters();
  }

  void prepareParameters() {
    const auto& impedance = frames_.toolImpedance();
    if (!impedance && !touched_) return;
    touched_ = impedance.has_value();
    pending_ = ParameterReport();
    pending_->number = static_cast<std::uint16_t>(++result_.parameter_sets);
    pending_time_ = emulator_.time() + settings_.latency;
    if (!impedance) return;  // contact has ended: nothing is rendered
    for (std::size_t axis = 0; axis < pending_->axes.size(); ++axis)
      pending_->axes[axis] = parametersOf(impedance->joints[axis], axis);
    result_.max_stiffness = std::max(result_.max_stiffness, impedance->joints[Insertion].stiffness);
    result_.max_damping = std::max(result_.max_damping, impedance->joints[Insertion].damping);
  }

  vibe_firmware::AxisParameters parametersOf(const JointResponse& joint, std::size_t axis) {
    const vibe_firmware::AxisConfig& config = settings_.setup.haptic.axes[axis];
    JointSpring spring{joint.position, joint.effort, 0, 0};
    if (settings_.rendering == Rendering::Spring) {
      spring.stiffness = joint.stiffness;
      spring.damping = joint.damping;
      spring.effort += joint.damping * joint.velocity;
    }
    vibe_firmware::AxisParameters parameters =
        axisSpring(settings_.setup.joints[axis], spring, static_cast<double>(config.torque_limit));
    const float stiffness = std::min(parameters.stiffness, vibe_firmware::maxStiffness(config, 0));
    const float damping = std::min(parameters.damping, vibe_firmware::maxDamping(config, stiffness));
    const float torque = std::clamp(parameters.torque, -config.torque_limit, config.torque_limit);
    result_.clamped +=
        stiffness != parameters.stiffness || damping != parameters.damping || torque != parameters.torque ? 1 : 0;
    parameters.stiffness = stiffness;
    parameters.damping = damping;
    parameters.torque = torque;
    return parameters;
  }

  void sendPending() {
    std::uint8_t bytes[vibe_firmware::kParameterReportSize];
    pack(*pending_, bytes);
    host_.setFeature(bytes, sizeof bytes);
    pending_.reset();
    const std::vector<std::uint8_t> answer = host_.getFeature(vibe_firmware::kStatusReportId);
    vibe_firmware::StatusReport status;
    if (unpack(answer.data(), answer.size(), status)) result_.refused = static_cast<int>(status.refused);
  }

  // --- what is measured

  HapticLoopSample sampleNow() {
    const AxisPlantState& axis = emulator_.haptic().axis(0);
    const AxisPlant& plant = emulator_.haptic().plant(0);
    const JointScale& joint = settings_.setup.joints[Insertion];
    HapticLoopSample sample;
    sample.time = emulator_.time();
    sample.insertion = jointPosition(joint, axis.position);
    sample.rendered = jointEffort(joint, static_cast<double>(emulator_.haptic().torques()[0]));
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
    StepInput input;
    std::copy(joints_.begin(), joints_.end(), input.joints.begin());
    for (std::size_t axis = 0; axis < 2; ++axis)
      input.joints[axis] = jointPosition(settings_.setup.joints[axis], emulator_.haptic().axis(axis).position);
    if (settings_.others) settings_.others(sample.time, input);
    reference_->step(input);
    sample.reference = insertionForce(*reference_);
    sample.measured = true;
  }

  const HapticLoopSettings& settings_;
  Emulator emulator_;
  UsbHost host_;
  Simulation frames_;
  std::shared_ptr<const Model> reference_model_;
  std::unique_ptr<Simulation> reference_;
  HapticLoopResult result_;
  std::int64_t frame_ = 0;
  std::array<double, kScopeJointCount> joints_{};
  std::deque<Reported> reported_;
  std::optional<ParameterReport> pending_;
  double pending_time_ = 0, last_intended_ = 0;
  bool touched_ = false;
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
  return Loop(scene, settings).run();
}

}  // namespace vibe

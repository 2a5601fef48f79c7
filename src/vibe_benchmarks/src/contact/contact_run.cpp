#include "contact/contact_run.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <thread>

#include "contact/bench_tools.hpp"
#include "contact/way_counts.hpp"
#include "vibe_core/clocks/step_timer.hpp"
#include "vibe_core/constraints/wall_contacts.hpp"
#include "vibe_core/model/accounting.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe::benchmarks {

std::shared_ptr<const Model> modelAt(const ContactCase& one, const ContactSetting& setting) {
  Scene scene = one.model->scene;
  scene.step_period = 1.0 / setting.rate;
  scene.tissue.iterations = setting.iterations;
  scene.tissue.spectral_radius = setting.spectral_radius;
  return modelWith(scene, one.urdf, *one.model);
}

ContactCheck::ContactCheck(const Model& model) : model_(model) {
  for (const End end : model.organ.end) open_.push_back(end != End::None ? 1 : 0);
}

std::vector<test::CrossingPair> ContactCheck::wall(const State& state) {
  return test::findWallCrossings({model_.organ.surface.triangles, state.x, state.y, state.z});
}

test::ToolCrossing ContactCheck::tool(const State& state) {
  if (!model_.tool) return {};
  passes_ = open_;
  const double whole = wholeWeight(state.grip);
  for (const GripPoint& point : state.grip)
    if (point.weight >= whole) passes_[static_cast<std::size_t>(point.particle)] = 1;
  model_.tool->forwardKinematics(state.joints, state.tool_displacement, poses_);
  for (Eigen::Isometry3d& pose : poses_) pose = model_.tool_base * pose;
  return test::findToolCrossing(*model_.tool, poses_, {model_.organ.surface.triangles, state.x, state.y, state.z},
                                passes_);
}

namespace {

constexpr int kFramesPerSecond = 60;
constexpr std::size_t kFirstForceFrame = 5;  // before, the force is that of a shock wave

bool isMishap(const Event& event) {
  return event.kind == Event::Kind::Slip || event.kind == Event::Kind::TearOut ||
         event.kind == Event::Kind::ThreadBroke || event.kind == Event::Kind::Recovery;
}

}  // namespace

Eigen::Vector3d signalOf(const ContactCase& one, const State& state) {
  if (one.signal == ContactSignal::ToolForce) return state.tool_force;
  const std::vector<double>& tension = state.procedure.sutures.back().tension;
  return {tension.empty() ? 0 : tension.front(), 0, 0};
}

double workBetween(const EnergyAccount& a, const EnergyAccount& b) {
  return std::abs(b.tool_work - a.tool_work) + std::abs(b.gas_work - a.gas_work) +
         std::abs(b.thread_work - a.thread_work) + std::abs(b.pull_work - a.pull_work);
}

namespace {

double distance(const std::array<std::vector<double>, 3>& a, const std::array<std::vector<double>, 3>& b) {
  double sum = 0;
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (std::size_t i = 0; i < a[axis].size(); ++i) sum += std::pow(a[axis][i] - b[axis][i], 2);
  return std::sqrt(sum);
}

SimulationSettings settingsOf(const ContactSetting& setting) {
  SimulationSettings settings = SimulationSettings::study(1);
  settings.stages = setting.stages;
  settings.threads = setting.threads;
  return settings;
}

void takeLess(const std::vector<double>& other, std::vector<double>& times) {
  for (std::size_t k = 0; k < times.size(); ++k) times[k] = std::min(times[k], other[k]);
}

/// CPU time of all threads but the calling one, since the program's start [s].
double timeOfOthers() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC - threadCpuTime();
}

/// Steps one case and fills its record.
class Recorder {
 public:
  Recorder(const ContactCase& one, const ContactSetting& setting, WayCounts* ways)
      : one_(one),
        ways_(ways),
        simulation_(modelAt(one, setting), settingsOf(setting)),
        check_(simulation_.model()),
        contacts_(simulation_.model()) {
    trace_.setting = setting;
    simulation_.replaceState(one.start);
    trace_.frames.push_back({one.start.x, one.start.y, one.start.z});
  }

  ContactTrace run() {
    const int per_frame = trace_.setting.rate / kFramesPerSecond;
    const int frames = static_cast<int>(std::lround(one_.duration * kFramesPerSecond));
    const double before = energyBalance(simulation_.model(), simulation_.state());
    for (int frame = 0; frame < frames; ++frame) {
      Eigen::Vector3d force = Eigen::Vector3d::Zero();
      for (int k = 1; k <= per_frame; ++k) {
        step((frame * per_frame + k) / static_cast<double>(trace_.setting.rate));
        force += signalOf(one_, simulation_.state()) / per_frame;
      }
      endFrame(force);
    }
    trace_.iterations /= frames * per_frame;
    trace_.others = 1e3 * (timeOfOthers() - others_) / static_cast<double>(trace_.cpu.size());
    trace_.balance = energyBalance(simulation_.model(), simulation_.state()) - before;
    trace_.hash = simulation_.hash();
    if (simulation_.stages() != nullptr) trace_.stages = simulation_.stages()->text();
    return std::move(trace_);
  }

 private:
  void step(double end) {
    const EnergyAccount before = simulation_.state().energy;
    if (trace_.setting.real_time) std::this_thread::sleep_until(begin_ + std::chrono::duration<double>(end));
    const StepInput input = one_.input(end);
    const auto& events = first_ ? simulation_.step(input) : countedStep(simulation_, input);
    const State& state = simulation_.state();
    noteTimes(end);
    const StepReport& report = simulation_.report();
    if (ways_ != nullptr) ways_->add(report);
    trace_.iterations += report.iterations;
    trace_.max_iterations = std::max(trace_.max_iterations, report.iterations);
    trace_.fallback_steps += report.fallback ? 1 : 0;
    trace_.contacts = std::max(trace_.contacts, state.contact_count);
    trace_.events += static_cast<int>(std::count_if(events.begin(), events.end(), isMishap));
    trace_.work += workBetween(before, state.energy);
  }

  void noteTimes(double end) {
    if (!first_) {
      trace_.cpu.push_back(1e3 * simulation_.timer().last_cpu);
      trace_.wall.push_back(1e3 * simulation_.timer().last_wall);
      return;
    }
    first_ = false;
    begin_ = std::chrono::steady_clock::now() - std::chrono::duration<double>(end);
    others_ = timeOfOthers();
  }

  void endFrame(const Eigen::Vector3d& force) {
    const State& state = simulation_.state();
    trace_.force.push_back(force);
    trace_.frames.push_back({state.x, state.y, state.z});
    trace_.crossings = std::max(trace_.crossings, static_cast<int>(check_.wall(state).size()));
    trace_.depth = std::max(trace_.depth, check_.tool(state).depth);
    trace_.pairs = std::max(trace_.pairs, static_cast<int>(contacts_.find(state).size()));
  }

  const ContactCase& one_;
  WayCounts* ways_;
  Simulation simulation_;
  ContactCheck check_;
  WallContacts contacts_;
  ContactTrace trace_;
  bool first_ = true;
  std::chrono::time_point<std::chrono::steady_clock, std::chrono::duration<double>> begin_;
  double others_ = 0;  // after the first step [s]
};

}  // namespace

[[gnu::noinline]] const std::vector<Event>& countedStep(Simulation& simulation, const StepInput& input) {
  return simulation.step(input);
}

ContactTrace runContact(const ContactCase& one, const ContactSetting& setting, WayCounts* ways) {
  return Recorder(one, setting, ways).run();
}

void takeFaster(const ContactTrace& other, ContactTrace& trace) {
  if (other.hash != trace.hash) throw Error("Two runs of the same motion end with different bits.");
  takeLess(other.cpu, trace.cpu);
  takeLess(other.wall, trace.wall);
  trace.others = std::min(trace.others, other.others);
}

ContactErrors compareContact(const ContactTrace& trace, const ContactTrace& reference) {
  ContactErrors errors;
  double moved = 0;
  for (std::size_t f = 0; f < reference.frames.size(); ++f) {
    moved = std::max(moved, distance(reference.frames[f], reference.frames.front()));
    errors.motion_end = distance(trace.frames[f], reference.frames[f]);
    errors.motion = std::fmax(errors.motion, errors.motion_end);
  }
  for (std::size_t f = 0; f < reference.force.size(); ++f) {
    errors.largest = std::max(errors.largest, reference.force[f].norm());
    errors.force_end = (trace.force[f] - reference.force[f]).norm();
    if (f >= kFirstForceFrame) errors.force = std::fmax(errors.force, errors.force_end);
  }
  errors.motion /= moved, errors.motion_end /= moved;
  errors.force /= errors.largest, errors.force_end /= errors.largest;
  return errors;
}

}  // namespace vibe::benchmarks

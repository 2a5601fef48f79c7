#include "replay/replay.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "simulation/scene_source.hpp"
#include "vibe_core/arithmetic/machine.hpp"
#include "vibe_core/metrics/session_report.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_core/simulation/simulator.hpp"
#include "vibe_core/simulation/snapshot.hpp"
#include "vibe_core/state/state_fields.hpp"

namespace vibe::sim {
namespace {

// "compiler (recorded: GCC 12.2, here: Clang 14)"; empty if they are equal.
std::string comparison(const std::string& name, const std::string& recorded, const std::string& here) {
  if (recorded == here) return "";
  return name + " (recorded: " + recorded + ", here: " + here + ")";
}

std::string differences(const vibe_msgs::SessionInfo& info) {
  const MachineInfo here = machineInfo();
  std::string all;
  for (const std::string& one :
       {comparison("version", info.version, here.version), comparison("arithmetic", info.arithmetic, here.arithmetic),
        comparison("compiler", info.compiler, here.compiler), comparison("C library", info.c_library, here.c_library),
        comparison("instruction set", info.instruction_set, here.instruction_set),
        comparison("processor", info.processor, here.processor)}) {
    if (!one.empty()) all += (all.empty() ? "" : ", ") + one;
  }
  return all;
}

std::int64_t firstStamp(const RecordedRun& run) {
  return run.steps.front().stamp;
}

// A run begins when the one before it has ended, also if a reset set the time back.
std::vector<std::int64_t> beginsOf(const std::vector<RecordedRun>& runs) {
  std::vector<std::int64_t> begins = {0};
  for (std::size_t r = 1; r < runs.size(); ++r) {
    const std::int64_t length = runs[r - 1].steps.back().stamp - firstStamp(runs[r - 1]);
    begins.push_back(begins.back() + std::max(length, firstStamp(runs[r]) - firstStamp(runs[r - 1])));
  }
  return begins;
}

}  // namespace

std::string findEdit(const vibe_msgs::SessionInfo& info) {
  if (hash(info.scene) != info.scene_hash) return "the scene is not the recorded one";
  if (hash(info.urdf) != info.urdf_hash) return "the URDF of the tool is not the recorded one";
  return "";
}

std::string causeOfModel(const vibe_msgs::SessionInfo& info) {
  const std::string all = differences(info);
  return "the surface file that the scene names may have changed" +
         (all.empty() ? "" : ", or another build makes another model: " + all);
}

std::string causeOfState(const vibe_msgs::SessionInfo& info) {
  const std::string all = differences(info);
  if (!all.empty()) return "what differs: " + all;
  return "version and machine are those of the recording; the file may have been edited, or this is an error of the "
         "simulator: please report it";
}

Replay::Replay(const Recording& recording, Listener& listener, Stamps stamps)
    : recording_(recording), listener_(listener), begins_(beginsOf(recording.runs())), stamps_(stamps) {
  beginRun(0, 0);
  listener_.newState(*simulation_);
}

bool Replay::done() const {
  return run_ + 1 == recording_.runs().size() && next_ == run().steps.size();
}

double Replay::timeOf(std::size_t run, std::int64_t stamp) const {
  return 1e-9 * static_cast<double>(begins_[run] + stamp - firstStamp(recording_.runs()[run]));
}

double Replay::time() const {
  return timeOf(run_, recordedNow());
}

double Replay::duration() const {
  return timeOf(begins_.size() - 1, recording_.runs().back().steps.back().stamp) + simulation_->time().period();
}

void Replay::step() {
  if (done()) return;
  if (next_ == run().steps.size()) {
    beginRun(run_ + 1, 0);
    listener_.newState(*simulation_);
  }
  prepareStep();
  listener_.beforeStep(*simulation_);
  takeStep();
  listener_.afterStep(*simulation_);
}

void Replay::prepareStep() {
  matchStamp();
  simulation_->setInput(recorded().input);
  checkStep();
}

void Replay::takeStep() {
  simulation_->step();
  ++next_;
  checkEnd();
}

void Replay::seek(double time, bool exact) {
  const auto since = static_cast<std::int64_t>(1e9 * std::max(time, 0.0) + 0.5);
  std::size_t r = begins_.size() - 1;
  while (r > 0 && begins_[r] > since) --r;
  const auto& steps = recording_.runs()[r].steps;
  const std::int64_t stamp = steps.front().stamp + since - begins_[r];
  const auto after = std::upper_bound(steps.begin(), steps.end(), stamp,
                                      [](std::int64_t t, const RecordedStep& step) { return t < step.stamp; });
  const auto target = static_cast<std::size_t>(std::max<std::ptrdiff_t>(after - steps.begin(), 1) - 1);
  std::size_t start = target;
  while (start > 0 && recording_.runs()[r].snapshots.count(steps[start].step) == 0) --start;
  const std::int64_t before = simulation_->now();
  // forward within the run, what lies between is stepped unless a snapshot is nearer
  if (!(exact && r == run_ && next_ <= target && next_ >= start)) beginRun(r, start);
  while (exact && next_ < target) {
    prepareStep();
    takeStep();
  }
  goForward(before);
  listener_.newState(*simulation_);
}

// Stamps go on from where they were.
void Replay::goForward(std::int64_t before) {
  if (stamps_ != Stamps::Forward || simulation_->now() > before) return;
  stamp_shift_ += before + 1 - simulation_->now();
  matchStamp();
}

void Replay::beginRun(std::size_t number, std::size_t index) {
  const RecordedRun& begun = recording_.runs()[number];
  const bool first = !simulation_;
  const std::int64_t before = first ? 0 : simulation_->now();
  const bool new_model = useModel(begun);
  run_ = number;
  next_ = index;
  checkRun();  // first: a snapshot of another model could not be read, which would not say why
  restore(begun, index, new_model);
  const bool has_revision = begun.info && begun.info->revision > 0;
  simulation_->renumber(begun.number, has_revision ? begun.info->revision : simulation_->revision());
  simulation_->setSession(recording_.session().id);
  matchStamp();
  if (!first) goForward(before);
  if (new_model) listener_.newModel(*simulation_);
}

void Replay::restore(const RecordedRun& begun, std::size_t index, bool new_model) {
  try {
    State state = stateAt(begun, index);
    if (hash(state) != hash(simulation_->state()) || !new_model) simulation_->replaceState(std::move(state));
  } catch (const Error& error) {
    next_ = run().steps.size();  // nothing of this run can be stepped
    if (result_.difference) throw ReplayEnd(error, *result_.difference, result_.same);
    throw;
  }
}

// @return whether it is another one than before
bool Replay::useModel(const RecordedRun& begun) {
  const std::string urdf = begun.info ? begun.info->urdf : "";
  if (simulation_ && begun.scene == scene_ && urdf == urdf_) return false;
  if (begun.info && !begun.info->arithmetic.empty())
    setArithmetic(begun.info->arithmetic == wordFor(Arithmetic::Plain) ? Arithmetic::Plain : Arithmetic::Fused);
  SceneModel made;
  try {
    made = modelOfText(begun.scene, recording_.file() + " (topic scene)", urdf);
  } catch (const Error& error) {
    throw Error("Recording '" + recording_.file() + "' has a scene that this build cannot read: " + error.what() +
                " (If an older release recorded it, replay it with that release.)");
  }
  scene_ = begun.scene;
  urdf_ = urdf;
  if (simulation_) {
    simulation_->replaceModel(made);
  } else {
    simulation_ = std::make_unique<TimedSimulation>(made, made.model->scene.seed, firstStamp(begun), 1);
  }
  return true;
}

State Replay::stateAt(const RecordedRun& begun, std::size_t index) {
  const std::uint64_t step = begun.steps[index].step;
  if (step == 0 && begun.number <= 1) return initialState(simulation_->model(), simulation_->model().scene.seed);
  return decodeSnapshot(simulation_->model(), recording_.snapshot(begun, step),
                        recording_.file() + ": step " + std::to_string(step));
}

// The stamps are those of the recording, also where the simulator fell behind the wall clock.
void Replay::matchStamp() {
  if (recorded().stamp != 0) simulation_->shiftTime(recorded().stamp - recordedNow());
}

void Replay::checkRun() {
  if (!run().info || result_.difference) return;
  const std::string edited = findEdit(*run().info);
  if (!edited.empty()) return differ(edited, "it may have been edited after the recording");
  if (run().info->model_hash != modelFingerprint(simulation_->model()))
    differ("the model (rest shape, masses) is not the recorded one", causeOfModel(*run().info));
}

void Replay::checkStep() {
  if (result_.difference) return;
  const std::string why = uncheckedWhy();
  if (!why.empty()) {
    ++result_.unchecked;
    result_.unchecked_why = why;
    return;
  }
  const std::uint64_t state = hash(simulation_->state());
  if (recorded().input_hash != hash(recorded().input, simulation_->state().step))
    return differ("the input of this step is not the recorded one: it does not have its hash",
                  "it may have been edited after the recording");
  if (recorded().state_hash != state)
    return differ("the state at the start of this step has hash " + toHex(state) + ", recorded was " +
                      toHex(recorded().state_hash),
                  causeOfState(*run().info));
  ++result_.same;
}

// The message of the solver's statistics has the hash after the last step, which has no successor that carries it.
void Replay::checkEnd() {
  const auto [known, end] = recording_.stateHashes().equal_range(recordedNow());
  if (result_.difference || known == end || next_ == 0) return;
  --next_;
  const std::string why = uncheckedWhy();
  const std::string state = why.empty() ? toHex(hash(simulation_->state())) : "";
  if (why.empty() && std::none_of(known, end, [&](const auto& entry) { return entry.second == state; }))
    differ("the state after this step has hash " + state + ", recorded was " + known->second,
           causeOfState(*run().info));
  ++next_;
}

std::string Replay::uncheckedWhy() const {
  if (!recorded().has_hashes) return "the topic applied_input has no hashes, as in recordings of older releases";
  if (!run().info) return "the topic session_info, which says to which version the hashes belong, is not recorded";
  if (recorded().state_hash == 0) return "nobody listened to applied_input when they were sent";
  if (run().info->state_version != kStateVersion)
    return "version " + run().info->version + " recorded it, whose state has other fields (version " +
           std::to_string(run().info->state_version) + ", here " + std::to_string(kStateVersion) + ")";
  return "";
}

void Replay::differ(const std::string& what, const std::string& cause) {
  const std::size_t index = std::min(next_, run().steps.size() - 1);
  result_.difference = {run().number, run().steps[index].step, timeOf(run_, run().steps[index].stamp), what, cause};
}

}  // namespace vibe::sim

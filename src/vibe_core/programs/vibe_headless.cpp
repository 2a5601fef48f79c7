// Runs a scene under a trainee script without ROS: CSV out, summary and state hash at the end. For sweeps and tests.
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "vibe_core/clocks/step_timer.hpp"
#include "vibe_core/files/files.hpp"
#include "vibe_core/files/number_text.hpp"
#include "vibe_core/metrics/session_outcome.hpp"
#include "vibe_core/metrics/session_report.hpp"
#include "vibe_core/program/command_line.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_core/scene/scene_parser.hpp"
#include "vibe_core/simulation/simulation.hpp"
#include "vibe_core/trainee/protocol.hpp"
#include "vibe_core/trainee/trainee.hpp"
#include "vibe_core/trainee/trainee_script.hpp"

namespace {

using namespace vibe;

struct Options {
  std::string scene = "package://vibe_core/scenes/stomach.yaml";
  std::string script, mesh, csv, inputs, contacts, measures, snapshot;
  double duration = 0;
  int threads = 1;
  std::optional<double> novice;
  std::optional<std::uint64_t> seed;
  bool stages = false, quiet = false;
  bool script_length = false, list_measures = false;
};

void addOptions(OptionList& line, Options& o) {
  line.option("--scene", o.scene, "scene to run (default: package://vibe_core/scenes/stomach.yaml)").typeName("FILE");
  line.option("--script", o.script, "what the trainee does: a script or a protocol of goals (default: nothing)")
      .typeName("FILE");
  line.option("--mesh", o.mesh, "surface of the organ instead of the scene's").typeName("FILE");
  line.option("--duration", o.duration,
              "simulated seconds (default: length of the script, else 10); a protocol ends before if its goals have")
      .typeName("S")
      .check(finiteFrom(0));
  line.option("--csv", o.csv, "write one row per step there (- for standard output)").typeName("FILE");
  line.option("--inputs", o.inputs, "write the input of each step there, as CSV with all digits").typeName("FILE");
  line.option("--contacts", o.contacts, "write the forces of the tissue on the tool there, one by one, as CSV")
      .typeName("FILE");
  line.option("--measures", o.measures, "write the measures by name there, as JSON").typeName("FILE");
  line.option("--snapshot", o.snapshot, "write the last state there").typeName("FILE");
  line.option("--threads", o.threads, "threads inside a step (default: 1); the result is the same")
      .typeName("N")
      .check(wholeFrom(1, 1024));
  line.option("--novice", o.novice, "skill of the trainee instead of the protocol's, 0: expert to 1: novice")
      .typeName("PART")
      .check(inRange(0.0, 1.0));
  line.option("--seed", o.seed, "seed of random numbers instead of the scene's and the protocol's")
      .typeName("N")
      .check(finiteFrom(0));
  line.flag("--stages", o.stages, "print at the end what the steps have spent their time on");
  line.flag("--quiet", o.quiet, "print the state hash only");
  line.flag("--list-measures", o.list_measures, "print names and units of all measures as JSON and end");
  line.flag("--script-length", o.script_length,
            "print the length of the script [s] and end; 0: a protocol, which takes as long as its goals");
}

std::shared_ptr<const Model> load(const Options& o) {
  Scene scene = loadScene(resolveAddress(o.scene));
  const std::string guesses = o.mesh.empty() ? "" : useMesh(scene, std::filesystem::absolute(resolveAddress(o.mesh)));
  if (!guesses.empty()) std::fprintf(stderr, "%s\n", guesses.c_str());
  if (o.seed) scene.seed = *o.seed;
  const std::string urdf = scene.scope ? readTextFile(resolveAddress(scene.scope->urdf), "URDF") : "";
  const bool show = !o.quiet && isatty(STDERR_FILENO) == 1;
  return buildModel(scene, urdf, [show](const std::string& what, double fraction) {
    if (show) std::fprintf(stderr, "\r%3.0f %% %-60s%s", 100 * fraction, what.c_str(), fraction >= 1 ? "\n" : "");
  });
}

std::unique_ptr<TraineeScript> loadScript(const Options& o) {
  if (o.script.empty() || isProtocol(resolveAddress(o.script))) return nullptr;
  return std::make_unique<TraineeScript>(TraineeScript::load(resolveAddress(o.script)));
}

std::optional<Protocol> loadProtocol(const Options& o) {
  if (!o.script.empty() && isProtocol(resolveAddress(o.script))) return Protocol::load(resolveAddress(o.script));
  if (o.novice) throw Error("--novice is the skill of a protocol of goals; name one with --script.");
  return std::nullopt;
}

std::unique_ptr<Trainee> makeTrainee(const Options& o, const Protocol& protocol,
                                     const std::shared_ptr<const Model>& model) {
  const Skill skill = o.novice ? between(Skill::expert(), Skill::novice(), *o.novice) : protocol.skill;
  auto trainee = std::make_unique<Trainee>(model, skill, o.seed.value_or(protocol.seed));
  for (const Goal& goal : protocol.goals) trainee->add(goal);
  return trainee;
}

void printProgress(double time, double duration, const std::string& doing) {
  if (duration > 0)
    std::fprintf(stderr, "\r%7.2f of %.2f s  %-50s", time, duration, doing.c_str());
  else
    std::fprintf(stderr, "\r%7.2f s  %-50s", time, doing.c_str());
}

void printScriptLength(const Options& o) {
  const std::unique_ptr<TraineeScript> script = loadScript(o);
  std::printf("%.3f\n", script ? script->duration() : 0.0);
}

void printEvents(const std::vector<Event>& events, bool over_progress) {
  for (const Event& event : events)
    std::fprintf(stderr, "%s%7.2f s  %s: %s\n", over_progress ? "\r" : "", event.time, toString(event.kind),
                 describe(event).c_str());
}

void reportGoals(bool show, Trainee& trainee, const Simulation& simulation) {
  trainee.on_result = [show, &trainee, &simulation](int number, const GoalResult& result) {
    std::fprintf(stderr, "%s%7.2f s  goal %d (%s) %s%s%s\n", show ? "\r" : "", simulation.time(), number + 1,
                 describe(trainee.goals()[number]).c_str(), result.reached ? "reached" : "given up",
                 result.reason.empty() ? "" : ": ", result.reason.c_str());
  };
}

// Of a session that follows a protocol.
std::string goalSentence(const Trainee* trainee, const SessionMetrics& metrics) {
  if (trainee == nullptr) return "";
  const std::vector<Measure> measures = goalMeasures(trainee, metrics.skill.sets);
  const auto count = [&](const char* name) { return static_cast<int>(valueOf(measures, name).value_or(0)); };
  return formatted("goals              %8d     reached %d   sets as planned %d   bites given up %d of %d\n",
                   count("goals"), count("goals_reached"), count("sets_as_planned"), count("bites_given_up"),
                   count("bites_planned"));
}

// 0: until the goals have ended
double durationOf(const Options& o, const TraineeScript* script, const Trainee* trainee) {
  if (o.duration > 0) return o.duration;
  if (trainee != nullptr) return 0;
  return script != nullptr ? script->duration() : 10;
}

SessionOutcome outcomeOf(const SessionMetrics& metrics, const std::vector<Suture>& sutures, const Trainee* trainee) {
  SessionOutcome outcome;
  outcome.measures = measuresOf(metrics, sutures);
  for (Measure& measure : goalMeasures(trainee, metrics.skill.sets)) outcome.measures.push_back(std::move(measure));
  outcome.events = metrics.events;
  if (trainee != nullptr) outcome.goals = goalOutcomes(*trainee);
  return outcome;
}

/// A table with rows for each step.
struct StepTable {
  StepTable(const std::string& file, const std::string& columns, int digits)
      : whole(file, "The table"), out(whole.part()) {
    out << columns << '\n' << std::setprecision(digits);
  }
  void finish() {
    out.close();
    whole.finish(out.good());
  }

  WholeFile whole;
  std::ofstream out;  // of whole.part()
};

std::unique_ptr<StepTable> inputTable(const std::string& file) {
  if (file.empty()) return nullptr;
  std::string columns = "step";
  for (const char* name : kJointNames) columns += std::string(",") + name;
  for (const char* name : kButtonNames) columns += std::string(",") + name;
  return std::make_unique<StepTable>(file, columns, std::numeric_limits<double>::max_digits10);
}

std::unique_ptr<StepTable> contactTable(const std::string& file) {
  constexpr int kDigits = 7;
  if (file.empty()) return nullptr;
  return std::make_unique<StepTable>(
      file, "step,grip,x,y,z,normal_x,normal_y,normal_z,gap,force_x,force_y,force_z,triangle,region", kDigits);
}

void writeInput(const Simulation& simulation, std::ostream& out) {
  out << simulation.stepCount() - 1;
  for (const double joint : simulation.input().joints) out << ',' << joint;
  for (const std::uint8_t button : simulation.input().buttons) out << ',' << int{button};
  out << '\n';
}

void writeContacts(const Simulation& simulation, std::ostream& out) {
  for (const ToolContact& c : simulation.contacts()) {
    out << simulation.stepCount() - 1 << ',' << (c.kind == ToolContact::Kind::Grip);
    for (const Eigen::Vector3d& v : {c.point, c.normal}) out << ',' << v.x() << ',' << v.y() << ',' << v.z();
    out << ',' << c.gap << ',' << c.force.x() << ',' << c.force.y() << ',' << c.force.z() << ',' << c.triangle << ','
        << toString(c.region) << '\n';
  }
}

void writeMeasures(const std::string& file, const Simulation& simulation, const Trainee* trainee) {
  SessionOutcome outcome = outcomeOf(simulation.metrics(), simulation.state().procedure.sutures, trainee);
  outcome.steps = simulation.stepCount();
  outcome.state_hash = simulation.hash();
  writeFile(file, toJson(outcome), "Table of measures");
}

void run(const Options& o) {
  if (o.script_length) return printScriptLength(o);
  if (o.list_measures) return void(std::cout << toJson(outcomeOf(SessionMetrics(), {}, nullptr)));
  // the script first: to build the model takes longer
  const std::unique_ptr<TraineeScript> script = loadScript(o);
  const std::optional<Protocol> protocol = loadProtocol(o);
  const std::shared_ptr<const Model> model = load(o);
  const std::unique_ptr<Trainee> trainee = protocol ? makeTrainee(o, *protocol, model) : nullptr;
  for (const std::string& warning : warningsAbout(*model)) std::fprintf(stderr, "%s\n", warning.c_str());
  const double duration = durationOf(o, script.get(), trainee.get());
  const std::unique_ptr<SessionCsv> csv = o.csv.empty() ? nullptr : std::make_unique<SessionCsv>(o.csv);
  const auto inputs = inputTable(o.inputs), contacts = contactTable(o.contacts);
  const bool show = !o.quiet && isatty(STDERR_FILENO) == 1;

  SimulationSettings settings;
  settings.threads = o.threads;
  settings.stages = o.stages;
  Simulation simulation(model, settings);
  simulation.warmUp();
  if (trainee && !o.quiet) reportGoals(show, *trainee, simulation);
  const double begin = steadyTime();
  const auto inputAt = [&](double time) {
    if (trainee) return trainee->next(observe(simulation));
    return script ? script->at(time) : StepInput{};
  };
  const auto observer = [&](const Simulation& s) {
    if (csv) csv->write(*model, s.state(), s.events());
    if (inputs) writeInput(s, inputs->out);
    if (contacts) writeContacts(s, contacts->out);
    if (!o.quiet) printEvents(s.events(), show);
    const std::string doing = trainee ? trainee->activity() : script ? script->phaseAt(s.time()) : "";
    if (show && s.stepCount() % 30 == 1) printProgress(s.time(), duration, doing);
  };
  long left = duration > 0 ? std::lround(duration / simulation.stepPeriod()) : std::numeric_limits<long>::max();
  while (left-- > 0 && !(trainee && trainee->done())) simulation.run(1, inputAt, observer);
  if (csv) csv->finish();
  for (StepTable* table : {inputs.get(), contacts.get()})
    if (table != nullptr) table->finish();
  if (show) std::fprintf(stderr, "\r%-60s\r", "");
  if (!o.snapshot.empty()) simulation.saveSnapshot(o.snapshot);
  if (!o.measures.empty()) writeMeasures(o.measures, simulation, trainee.get());
  if (o.stages) std::cout << simulation.stages()->text() << "\n";
  if (o.quiet)
    std::cout << "state hash: " << toHex(simulation.hash()) << "\n";
  else
    std::cout << landmarkRemark(model->scene) << goalSentence(trainee.get(), simulation.metrics())
              << runSummary(simulation.metrics(), simulation.timer().cpu.all, model->particle_count, simulation.time(),
                            steadyTime() - begin, simulation.hash());
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CommandLine line{"Runs a scene under a trainee script as fast as possible, without ROS.", "vibe_headless"};
  addOptions(line, options);
  return runProgram(line, argc, argv, [&] { run(options); });
}

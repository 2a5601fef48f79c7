#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "recording/recording.hpp"
#include "replay/bag_filler.hpp"
#include "replay/replay.hpp"
#include "vibe_core/clocks/step_timer.hpp"
#include "vibe_core/files/number_text.hpp"
#include "vibe_core/metrics/session_report.hpp"
#include "vibe_core/program/command_line.hpp"
#include "vibe_core/program/error.hpp"

// Steps the simulator through the inputs of a recording, without a roscore, and compares every step with it.

namespace {

using namespace vibe;
using namespace vibe::sim;

constexpr int kSame = 0, kDiffers = 1, kNotChecked = 3;
constexpr int kProgressSteps = 120;

const char kAbout[] =
    "Repeats a recorded session from its scene and inputs, without a roscore, compares every step with the recorded\n"
    "hashes, and prints its summary. Several bags are the parts of a split recording.";
const char kStatus[] =
    "Ends with 0 if all steps are the same, 1 if one differs, 2 if the recording cannot be repeated, 3 if it could "
    "not\n"
    "be checked, or not all of it, because hashes are missing or are of another version.";

struct Options {
  std::vector<std::string> bags;
  std::string fill, record;
  SessionChoice choice;
  bool list = false;
  double from = 0, to = INFINITY;
};

void addOptions(OptionList& line, Options& o) {
  line.option("BAG", o.bags, "recording").typeName("").required();
  line.option("--from", o.from, "begin at the last snapshot before S seconds").typeName("S").check(finiteFrom(0));
  line.option("--to", o.to, "end after S seconds").typeName("S").check(finiteFrom(0));
  line.option("--fill", o.fill, "also write a bag with every message of every topic that the simulator sent")
      .typeName("FILE");
  line.option("--record", o.record,
              "also record it as a new session: of inputs and a scene alone, or of another release's recording")
      .typeName("FILE");
  line.option("--session", o.choice.session,
              "which session: its number in the list, or the beginning of its identity (default: the first)")
      .typeName("S");
  line.option("--namespace", o.choice.name_space, "the first session in this namespace").typeName("NS");
  line.flag("--list", o.list, "list the sessions and end");
  line.footer(kStatus);
}

void check(const Options& o) {
  if (o.to <= o.from) throw Error("--to must be later than --from; exchange their values.");
  if (!o.fill.empty() && !o.record.empty()) throw Error("--fill and --record write one bag each; give one of them.");
  if (!(o.fill + o.record).empty() && (o.from > 0 || std::isfinite(o.to)))
    throw Error("--fill and --record write the whole recording; leave --from and --to out.");
}

std::string seconds(double value) {
  return formatted("%.2f s", value);
}

int reportDifference(const ReplayDifference& d, std::uint64_t same) {
  std::printf("NOT the same: %llu steps are, then at step %llu (%.3f s) %s; %s\n",
              static_cast<unsigned long long>(same), static_cast<unsigned long long>(d.step), d.time, d.what.c_str(),
              d.cause.c_str());
  return kDiffers;
}

int report(const Recording& recording, const ReplayResult& result) {
  const auto same = static_cast<unsigned long long>(result.same);
  if (recording.stepsLeftOut() > 0)
    std::printf("%zu steps before the first snapshot were left out: nothing before them is recorded to begin from\n",
                recording.stepsLeftOut());
  if (result.difference) return reportDifference(*result.difference, result.same);
  if (result.unchecked > 0) {
    std::printf("not checked: %llu of %llu steps, since %s\n", static_cast<unsigned long long>(result.unchecked),
                same + static_cast<unsigned long long>(result.unchecked), result.unchecked_why.c_str());
    return kNotChecked;
  }
  if (!recording.lost().empty()) {
    std::printf("not checked: the %llu steps that could be repeated are the same, but %s\n", same,
                recording.lost().c_str());
    return kNotChecked;
  }
  std::printf("the same: all %llu steps have the recorded input and the recorded state\n", same);
  return kSame;
}

void showProgress(const Replay& replay) {
  if (replay.simulation().state().step % kProgressSteps != 0) return;
  std::fprintf(stderr, "\rrepeated %.0f of %.0f s ", replay.time(), replay.duration());
}

// The scene's name is in its text, as a line "name: ...".
std::string sceneOf(const RecordedSession& session) {
  const auto first = session.runs.begin();
  const std::string text =
      first != session.runs.end() && first->second.info ? first->second.info->scene : session.scene;
  const std::size_t at = text.rfind("name: ", 0) == 0 ? 0 : text.find("\nname: ");
  if (at == std::string::npos) return "-";
  const std::size_t begin = text.find(' ', at) + 1;
  return text.substr(begin, text.find('\n', begin) - begin);
}

int list(const std::vector<std::string>& bags) {
  const std::vector<RecordedSession> sessions = listSessions(bags);
  if (sessions.empty()) Recording(bags, {});  // says why
  std::printf("%6s  %-16s  %-12s  %10s  %8s  %5s  %s\n", "number", "session", "namespace", "length", "steps", "runs",
              "scene");
  for (std::size_t i = 0; i < sessions.size(); ++i)
    std::printf("%6zu  %-16s  %-12s  %8.2f s  %8zu  %5zu  %s\n", i + 1, sessions[i].idText().c_str(),
                sessions[i].nameSpace().c_str(), (sessions[i].end - sessions[i].begin).toSec(), sessions[i].stepCount(),
                sessions[i].runs.size(), sceneOf(sessions[i]).c_str());
  return kSame;
}

int run(const Options& options) {
  check(options);
  if (options.list) return list(options.bags);
  const Recording recording(options.bags, options.choice);
  if (!recording.remarkOnChoice().empty()) std::printf("%s\n", recording.remarkOnChoice().c_str());
  const Filling filling = options.record.empty() ? Filling::Whole : Filling::NewSession;
  const std::string file = options.fill + options.record;
  Replay::Listener nobody;
  std::unique_ptr<BagFiller> filler;
  if (!file.empty()) filler = std::make_unique<BagFiller>(recording, file, filling);
  Replay replay(recording, filler ? *filler : nobody);
  if (options.from > replay.duration())
    throw Error("--from " + seconds(options.from) + " is after the end of the session, at " +
                seconds(replay.duration()) + "; begin before that.");
  if (options.from > 0) replay.seek(options.from, false);
  const double begin = steadyTime(), first = replay.time();
  std::uint64_t steps = 0;
  for (; !replay.done() && replay.time() < options.to; ++steps) {
    replay.step();
    showProgress(replay);
  }
  std::fprintf(stderr, "\r");
  std::printf("repeated %llu steps, %.2f s\n", static_cast<unsigned long long>(steps), replay.time() - first);
  const TimedSimulation& simulation = replay.simulation();
  std::fputs(runSummary(simulation.metrics(), simulation.timer().cpu.all, simulation.model().particle_count,
                        replay.time() - first, steadyTime() - begin, hash(simulation.state()))
                 .c_str(),
             stdout);
  if (filler) {
    filler->finish(replay.simulation());
    std::printf("%s: %s, %llu messages\n", filling == Filling::Whole ? "filled" : "recorded", file.c_str(),
                static_cast<unsigned long long>(filler->messageCount()));
  }
  const int status = report(recording, replay.result());
  return status == kNotChecked && filling == Filling::NewSession ? kSame : status;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CommandLine line(kAbout, "vibe_replay");
  addOptions(line, options);
  return runProgram(line, argc, argv, [&] {
    try {
      return run(options);
    } catch (const ReplayEnd& end) {
      std::fprintf(stderr, "vibe_replay: it ends here: %s\n", end.what());
      return reportDifference(end.difference, end.same);
    }
  });
}

// Every command in every state that can be reached, and the way from each of them to a finished set.
#include <gtest/gtest.h>

#include <deque>
#include <functional>
#include <map>
#include <set>
#include <tuple>

#include "procedure/procedure_bench.hpp"

namespace vibe::procedure_table_test {
namespace {

using test::Bench;
using test::benchScene;
using test::finishOneSet;
using Kind = Event::Kind;

struct Command {
  std::string name;
  std::function<void(Bench&)> give;
  std::vector<Kind> acting;  // of these or a refusal exactly one; empty: never refused
};

std::vector<Command> commands() {
  const auto down = [](Button button) { return [button](Bench& b) { b.hold(button); }; };
  const auto up = [](Button button) { return [button](Bench& b) { b.hold(button, false); }; };
  return {{"close", [](Bench& b) { b.closeArm(); }, {Kind::Pierced}},
          {"close in air", [](Bench& b) { b.closeInAir(); }, {Kind::BiteMissed, Kind::ArmClosed}},
          {"open", [](Bench& b) { b.openArm(); }, {}},
          {"needle", down(Needle), {Kind::Bite, Kind::NeedleExchanged}},
          {"needle up", up(Needle), {}},
          {"t-tag", down(TTag), {Kind::TTagDropped}},
          {"t-tag up", up(TTag), {}},
          {"cinch", down(Cinch), {Kind::CinchPulling}},
          {"cinch up", up(Cinch), {}},
          {"pedal", down(ApcPedal), {}},
          {"pedal up", up(ApcPedal), {}},
          {"insufflate", down(Insufflate), {}},
          {"wait", [](Bench& b) { b.act(); }, {}}};
}

// What decides the answer to commands; everything else of the state is amounts.
using Key = std::tuple<bool, bool, bool, bool, int, std::size_t, std::size_t, std::array<std::uint8_t, kButtonCount>>;

Key keyOf(const ProcedureState& p) {
  const bool active = !p.sutures.empty() && !p.sutures.back().permanent();
  return {p.arm_closed,
          p.needle_on_arm,
          p.needle_loaded,
          p.pierced,
          active ? static_cast<int>(p.sutures.back().stage) : -1,
          active ? p.sutures.back().bites.size() : 0,
          std::min<std::size_t>(p.sutures.size(), 2),
          p.pressed};
}

struct Snapshot {
  State state;
  StepInput input;
};

void restore(const Snapshot& from, Bench& bench) {
  bench.state() = from.state;
  bench.input = from.input;
}

Scene smallScene() {
  Scene scene = benchScene();
  scene.suture->max_bites = 3;
  return scene;
}

// Goes through all states and calls visit(bench in the state, its command) after each command that was given in each.
std::vector<Snapshot> explore(Bench& bench, const std::function<void(Bench&, const Command&, const Snapshot&)>& visit) {
  std::set<Key> known{keyOf(bench.procedure())};
  std::vector<Snapshot> found{{bench.state(), bench.input}};
  for (std::size_t next = 0; next < found.size(); ++next) {
    for (const Command& command : commands()) {
      const Snapshot before = found[next];
      restore(before, bench);
      bench.goTo(bench.procedure().sutures.empty() ? 0
                                                   : static_cast<int>(bench.procedure().sutures.back().bites.size()));
      command.give(bench);
      visit(bench, command, before);
      if (bench.procedure().sutures.size() > 2) continue;  // from here on it repeats
      if (known.insert(keyOf(bench.procedure())).second) found.push_back({bench.state(), bench.input});
    }
  }
  return found;
}

bool isNewCommand(const Command& command, const State& before, const State& after) {
  if (command.name.rfind("close", 0) == 0) return !before.procedure.arm_closed;
  for (int b = 0; b < kButtonCount; ++b)
    if (after.procedure.pressed[b] > before.procedure.pressed[b]) return true;
  return false;
}

bool sameProcedure(const ProcedureState& a, const ProcedureState& b) {
  if (a.sutures.size() != b.sutures.size() || a.needle_on_arm != b.needle_on_arm || a.pierced != b.pierced ||
      a.needle_loaded != b.needle_loaded || a.thread_used != b.thread_used || a.phase != b.phase ||
      a.pending.particle != b.pending.particle)
    return false;
  for (std::size_t k = 0; k < a.sutures.size(); ++k) {
    const bool drawn = b.sutures[k].stage == Suture::Stage::Cinching;  // goes on whatever else is asked
    if (a.sutures[k].stage != b.sutures[k].stage || a.sutures[k].bites.size() != b.sutures[k].bites.size() ||
        (!drawn && a.sutures[k].length != b.sutures[k].length))
      return false;
  }
  return true;
}

TEST(ProcedureTable, EveryNewCommandActsOnceOrIsRefusedOnceAndARefusalChangesNothing) {
  Bench bench(smallScene());
  std::map<std::string, std::set<std::string>> reasons;  // by command
  int acted = 0, refused = 0;
  explore(bench, [&](Bench& b, const Command& command, const Snapshot& before) {
    int acting = 0;
    for (Kind kind : command.acting) acting += b.count(kind);
    const int no = b.count(Kind::Rejected);
    const bool is_new = isNewCommand(command, before.state, b.state());
    const bool must_answer =
        is_new && (!command.acting.empty() || command.name == "pedal" || command.name == "insufflate");
    // a command on tissue may act in another way: an arm without a needle closes all the same
    if (command.name == "close") acting += b.count(Kind::ArmClosed);
    EXPECT_EQ(acting + no, must_answer ? 1 : 0) << command.name;
    if (no > 0) {
      EXPECT_TRUE(sameProcedure(before.state.procedure, b.procedure())) << command.name << ": " << b.refusal();
      EXPECT_FALSE(b.refusal().empty());
      reasons[command.name == "close in air" ? "close" : command.name].insert(b.refusal());
    }
    acted += acting;
    refused += no;
  });
  EXPECT_GT(acted, 100);
  EXPECT_GT(refused, 100);
  EXPECT_EQ(reasons["close"].size(), 1u) << "no needle";
  EXPECT_EQ(reasons["needle"].size(), 4u) << "no needle, arm open, arm in the bite, set full";
  EXPECT_EQ(reasons["t-tag"].size(), 4u) << "dropped already, no bite, needle in the wall, too few bites";
  EXPECT_EQ(reasons["cinch"].size(), 2u) << "no thread, no T-tag";
  std::set<std::string> all;
  std::size_t sum = 0;
  for (const auto& [name, texts] : reasons) {
    all.insert(texts.begin(), texts.end());
    sum += texts.size();
  }
  EXPECT_EQ(all.size(), sum) << "no two reasons read the same";
}

TEST(ProcedureTable, FromEveryStateASetCanBeFinished) {
  Bench bench(smallScene());
  const std::vector<Snapshot> found = explore(bench, [](Bench&, const Command&, const Snapshot&) {});
  EXPECT_GT(found.size(), 200u);
  for (const Snapshot& from : found) {
    restore(from, bench);
    const auto finished = [&] {
      int n = 0;
      for (const Suture& s : bench.procedure().sutures) n += s.stage == Suture::Stage::Cinched ? 1 : 0;
      return n;
    };
    const int before = finished();
    finishOneSet(bench);
    EXPECT_GT(finished(), before);
    EXPECT_TRUE(bench.procedure().needle_loaded && bench.procedure().needle_on_arm);
  }
}

TEST(ProcedureTable, ASceneWithoutAPartSaysSoOncePerPress) {
  for (const bool with_scope : {true, false}) {
    Scene scene = test::bareScene();
    if (with_scope) scene.scope = ScopeScene{};
    if (with_scope) scene.scope->base_from_anatomy = false;
    test::World world(scene, test::plainOrgan(test::icosphere(0.03, 1), 2e-3), scopeText());
    std::set<std::string> texts;
    for (int button = 0; button < kButtonCount; ++button) {
      StepInput input;
      input.buttons[button] = 1;
      world.events.clear();
      for (int k = 0; k < 5; ++k) world.step(input);
      ASSERT_EQ(world.count(Kind::Rejected), 1) << kButtonNames[button];
      EXPECT_EQ(world.events.front().value, button);
      texts.insert(describe(world.events.front()));
      world.step();
    }
    EXPECT_EQ(texts.size(), static_cast<std::size_t>(kButtonCount));
    EXPECT_TRUE(world.state.procedure.sutures.empty());
  }
}

TEST(ProcedureTable, TheHelixGrabsOrMissesOncePerPress) {
  test::World world(benchScene(), test::plainOrgan(test::icosphere(0.03, 2), 2e-3), scopeText());
  StepInput press;
  press.buttons[HelixGrab] = 1;
  for (int k = 0; k < 3; ++k) {
    world.step(press);
    world.step(press);
    world.step();
  }
  EXPECT_EQ(world.count(Kind::Grab) + world.count(Kind::GrabMissed), 3);
  EXPECT_EQ(world.count(Kind::Rejected), 0);
}

}  // namespace
}  // namespace vibe::procedure_table_test

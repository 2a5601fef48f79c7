// Snapshot and hash of the procedure: every member counts, every member survives, damage is refused.
#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <functional>
#include <set>

#include "vibe_core/program/error.hpp"
#include "vibe_core/simulation/snapshot.hpp"
#include "vibe_testing/worlds.hpp"

namespace vibe::snapshot_procedure_test {
namespace {

using test::World;

World balloon() {
  return World(test::bareScene(), test::plainOrgan(test::icosphere(0.05, 1), 2e-3));
}

Bite bite(int first) {
  Bite result;
  result.particle = {first, first + 1, first + 2};
  result.weight = {0.5, 0.25, 0.25};
  result.time = 3.5 + first;
  result.depth = 2.5e-3;
  result.thickness = 2.3e-3;
  result.region = Region::Antrum;
  result.wall = Wall::Posterior;
  result.along = 0.75;
  return result;
}

/// A procedure in which no member has its default.
ProcedureState busyProcedure(int particles) {
  ProcedureState p;
  p.phase = Phase::Pull;
  p.pressed = {1, 0, 1, 0, 1, 0};
  p.heat.assign(static_cast<std::size_t>(particles), 1.5f);
  p.dose.assign(static_cast<std::size_t>(particles), 30.f);
  p.grade.assign(static_cast<std::size_t>(particles), 1);
  p.beam_energy = 800;
  for (auto* base : {&p.base_x, &p.base_y, &p.base_z}) base->assign(static_cast<std::size_t>(particles), 0.25);
  p.grip_rotation = 4;
  p.grip_turns = 2.5;
  p.arm_closed = true;
  p.needle_on_arm = false;
  p.needle_loaded = false;
  p.pierced = true;
  p.pending = bite(30);
  Suture suture;
  suture.stage = Suture::Stage::Cinched;
  suture.bites = {bite(3), bite(10), bite(20)};
  suture.length = {0.02, 0.03};
  suture.tension = {2.5, 1.5};
  suture.taken = {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}};
  suture.technique = 2;
  suture.technique_margin = 0.4;
  suture.transitions = {1, 2};
  suture.pulled = 0.05;
  suture.cinch_tension = 2.5;
  suture.begin = 1;
  suture.end = 9;
  suture.tear_outs = 1;
  p.sutures = {suture, Suture{}};
  p.sutures[1].bites = {bite(5)};
  p.thread_used = 0.3;
  p.bleedings = {{1, 0, 5, true, 4.5, 2.5e-7, 1e-6, true}};
  p.blood_lost = 1e-6;
  return p;
}

using Change = std::function<void(ProcedureState&)>;

/// One change of every member, by name.
std::vector<std::pair<const char*, Change>> changes() {
  using P = ProcedureState;
  return {
      {"phase", [](P& p) { p.phase = Phase::Mark; }},
      {"pressed", [](P& p) { p.pressed[5] = 1; }},
      {"heat", [](P& p) { p.heat[41] += 1e-6f; }},
      {"dose", [](P& p) { p.dose[0] = 31; }},
      {"grade", [](P& p) { p.grade[7] = 2; }},
      {"beam_energy", [](P& p) { p.beam_energy += 1e-9; }},
      {"base_x", [](P& p) { p.base_x[5] = 0; }},
      {"base_y", [](P& p) { p.base_y[41] = 0; }},
      {"base_z", [](P& p) { p.base_z[0] = 0; }},
      {"grip_rotation", [](P& p) { p.grip_rotation = -4; }},
      {"grip_turns", [](P& p) { p.grip_turns = 2; }},
      {"arm_closed", [](P& p) { p.arm_closed = false; }},
      {"needle_on_arm", [](P& p) { p.needle_on_arm = true; }},
      {"needle_loaded", [](P& p) { p.needle_loaded = true; }},
      {"pierced", [](P& p) { p.pierced = false; }},
      {"pending", [](P& p) { p.pending.depth = 1e-3; }},
      {"stage", [](P& p) { p.sutures[0].stage = Suture::Stage::Cinching; }},
      {"bites", [](P& p) { p.sutures[1].bites.push_back(bite(8)); }},
      {"bite particle", [](P& p) { p.sutures[0].bites[2].particle[1] = 0; }},
      {"bite weight",
       [](P& p) {
         p.sutures[0].bites[0].weight = {0.25, 0.5, 0.25};
       }},
      {"bite size", [](P& p) { p.sutures[0].bites[0].particle = {1}, p.sutures[0].bites[0].weight = {1}; }},
      {"bite time", [](P& p) { p.sutures[0].bites[1].time = 0; }},
      {"bite depth", [](P& p) { p.sutures[0].bites[1].depth = 0; }},
      {"bite thickness", [](P& p) { p.sutures[0].bites[1].thickness = 0; }},
      {"bite region", [](P& p) { p.sutures[0].bites[1].region = Region::Body; }},
      {"bite wall", [](P& p) { p.sutures[0].bites[1].wall = Wall::Anterior; }},
      {"bite along", [](P& p) { p.sutures[0].bites[1].along = 0.5; }},
      {"length", [](P& p) { p.sutures[0].length[1] = 0.04; }},
      {"tension", [](P& p) { p.sutures[0].tension[0] = 0; }},
      {"taken", [](P& p) { p.sutures[0].taken[2].z() = 0; }},
      {"technique", [](P& p) { p.sutures[0].technique = 1; }},
      {"corrected_technique", [](P& p) { p.sutures[0].corrected_technique = 1; }},
      {"printed_technique", [](P& p) { p.sutures[0].printed_technique = 1; }},
      {"technique_margin", [](P& p) { p.sutures[0].technique_margin = 0; }},
      {"transitions", [](P& p) { p.sutures[0].transitions[1] = -1; }},
      {"pulled", [](P& p) { p.sutures[0].pulled = 0; }},
      {"cinch_tension", [](P& p) { p.sutures[0].cinch_tension = 0; }},
      {"begin", [](P& p) { p.sutures[0].begin = 0; }},
      {"end", [](P& p) { p.sutures[0].end = 0; }},
      {"tear_outs", [](P& p) { p.sutures[0].tear_outs = 0; }},
      {"thread_used", [](P& p) { p.thread_used = 0; }},
      {"bleeding suture", [](P& p) { p.bleedings[0].suture = 0; }},
      {"bleeding bite", [](P& p) { p.bleedings[0].bite = 1; }},
      {"bleeding particle", [](P& p) { p.bleedings[0].particle = -1; }},
      {"bleeding brisk", [](P& p) { p.bleedings[0].brisk = false; }},
      {"bleeding begin", [](P& p) { p.bleedings[0].begin = 0; }},
      {"bleeding rate", [](P& p) { p.bleedings[0].rate = 0; }},
      {"bleeding amount", [](P& p) { p.bleedings[0].amount = 0; }},
      {"bleeding overdue", [](P& p) { p.bleedings[0].overdue = false; }},
      {"bleedings", [](P& p) { p.bleedings.clear(); }},
      {"blood_lost", [](P& p) { p.blood_lost = 0; }},
      // the same numbers, spread over other lists
      {"a bite moved to another suture",
       [](P& p) {
         p.sutures[1].bites.insert(p.sutures[1].bites.begin(), p.sutures[0].bites.back());
         p.sutures[0].bites.pop_back();
         p.sutures[0].stage = Suture::Stage::Broken;
       }},
      {"a suture without content", [](P& p) { p.sutures.emplace_back(); }},
  };
}

TEST(ProcedureHash, changesWithEveryMember) {
  World world = balloon();
  world.state.procedure = busyProcedure(42);
  std::set<std::uint64_t> hashes = {hash(world.state)};
  for (const auto& [name, change] : changes()) {
    State changed = world.state;
    change(changed.procedure);
    EXPECT_TRUE(hashes.insert(hash(changed)).second) << name;
  }
}

class ProcedureSnapshot : public ::testing::Test {
 protected:
  std::string file = ::testing::TempDir() + "vibe_snapshot_procedure_test.bin";
  World world = balloon();
  ProcedureSnapshot() { world.state.procedure = busyProcedure(42); }
  ~ProcedureSnapshot() override { std::remove(file.c_str()); }

  /// The sentence with which loading ends after a change was saved; empty if it loads.
  std::string refusal(const Change& change) {
    State changed = world.state;
    change(changed.procedure);
    saveSnapshot(*world.model, changed, file);
    try {
      loadSnapshot(*world.model, file);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }

  std::string bytes() const {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
};

TEST_F(ProcedureSnapshot, everyMemberSurvives) {
  for (const auto& [name, change] : changes()) {
    State changed = world.state;
    change(changed.procedure);
    if (hash(changed) == hash(world.state)) ADD_FAILURE() << name;
    saveSnapshot(*world.model, changed, file);
    EXPECT_EQ(hash(loadSnapshot(*world.model, file)), hash(changed)) << name;
  }
}

TEST_F(ProcedureSnapshot, refusesWhatNoSessionCanReach) {
  using P = ProcedureState;
  const std::vector<std::pair<const char*, Change>> damages = {
      {"phase", [](P& p) { p.phase = static_cast<Phase>(9); }},
      {"marks", [](P& p) { p.dose.pop_back(); }},
      {"marks", [](P& p) { p.heat.clear(), p.dose.clear(); }},
      {"particle", [](P& p) { p.sutures[0].bites[1].particle[0] = 42; }},
      {"particle", [](P& p) { p.sutures[0].bites[1].particle[0] = -1; }},
      {"particle", [](P& p) { p.pending.particle[0] = 1 << 30; }},
      {"weight", [](P& p) { p.pending.weight.pop_back(); }},
      {"weight", [](P& p) { p.sutures[0].bites[0].weight[0] = std::nan(""); }},
      {"holds nothing", [](P& p) { p.sutures[1].bites[0] = Bite{}; }},
      {"region", [](P& p) { p.sutures[0].bites[0].region = static_cast<Region>(5); }},
      {"wall", [](P& p) { p.sutures[0].bites[0].wall = static_cast<Wall>(4); }},
      {"stage", [](P& p) { p.sutures[0].stage = static_cast<Suture::Stage>(5); }},
      {"technique", [](P& p) { p.sutures[0].technique = 7; }},
      {"technique", [](P& p) { p.sutures[0].corrected_technique = 7; }},
      {"technique", [](P& p) { p.sutures[0].printed_technique = 7; }},
      {"thread", [](P& p) { p.sutures[0].length.push_back(1); }},
      {"thread", [](P& p) { p.sutures[0].tension.clear(), p.sutures[0].length.clear(); }},
      {"thread", [](P& p) { p.sutures[0].tension[0] = INFINITY; }},
      {"bleeds", [](P& p) { p.bleedings[0].suture = 2; }},
      {"bleeds", [](P& p) { p.bleedings[0].particle = 42; }},
  };
  EXPECT_EQ(refusal([](P&) {}), "");
  for (const auto& [word, damage] : damages) {
    const std::string sentence = refusal(damage);
    EXPECT_NE(sentence.find("is damaged: "), std::string::npos) << word;
    EXPECT_NE(sentence.find(word), std::string::npos) << sentence;
  }
}

/// Whatever byte is hit, the answer is a state or one sentence: no crash, no endless memory.
TEST_F(ProcedureSnapshot, anyDamagedByteGivesAStateOrAnError) {
  saveSnapshot(*world.model, world.state, file);
  const std::string whole = bytes();
  int refused = 0;
  for (std::size_t at = 0; at < whole.size(); at += 3) {
    std::string damaged = whole;
    damaged[at] = static_cast<char>(~damaged[at]);
    std::ofstream(file, std::ios::binary | std::ios::trunc) << damaged;
    try {
      loadSnapshot(*world.model, file);
    } catch (const Error& error) {
      ++refused;
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    }
  }
  EXPECT_GT(refused, 50);
}

TEST_F(ProcedureSnapshot, belongsToScenesWithTheSameParts) {
  saveSnapshot(*world.model, world.state, file);
  Model other = *world.model;
  EXPECT_NO_THROW(loadSnapshot(other, file));
  other.scene.suture.emplace();
  EXPECT_THROW(loadSnapshot(other, file), Error);
}

}  // namespace
}  // namespace vibe::snapshot_procedure_test

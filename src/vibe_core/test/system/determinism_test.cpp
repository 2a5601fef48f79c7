#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <limits>

#include "vibe_core/program/error.hpp"
#include "vibe_core/simulation/simulation.hpp"
#include "vibe_core/simulation/snapshot.hpp"
#include "vibe_core/state/state_fields.hpp"
#include "vibe_testing/worlds.hpp"

namespace vibe::determinism_test {
namespace {

using test::bareScene;
using test::icosphere;
using test::plainOrgan;
using test::World;

Scene livelyScene() {
  Scene scene = bareScene();
  scene.tissue.mass_damping = 5;
  scene.gravity = GravityScene{};
  scene.foundation = FoundationScene{};
  scene.foundation->carries_weight = false;
  scene.gas = GasScene{};
  scene.gas->insufflator_on = true;
  return scene;
}

World livelyWorld(int threads = 1, double pressure = 1333) {
  Scene scene = livelyScene();
  scene.gas->regulated_pressure = pressure;
  return World(scene, plainOrgan(icosphere(0.05, 3), 2e-3), "", threads);
}

TEST(Determinism, SameBitsOnEveryRunAndThreadCount) {
  World a = livelyWorld(), b = livelyWorld(), c = livelyWorld(2), d = livelyWorld(5);
  for (World* world : {&a, &b, &c, &d}) world->run(0.5);
  EXPECT_EQ(hash(a.state), hash(b.state));
  EXPECT_EQ(hash(a.state), hash(c.state));
  EXPECT_EQ(hash(a.state), hash(d.state));
  EXPECT_EQ(a.state.x, d.state.x);
}

TEST(Determinism, AWarmUpChangesNothing) {
  const World world = livelyWorld();
  Simulation cold(world.model), warm(world.model);
  warm.warmUp();
  EXPECT_EQ(warm.hash(), cold.hash());
  EXPECT_EQ(warm.stepCount(), 0);
  for (int i = 0; i < 30; ++i) {
    cold.step();
    warm.step();
    if (i == 10) warm.warmUp();
    ASSERT_EQ(warm.hash(), cold.hash()) << i;
  }
}

TEST(Determinism, HashSeesTheLeastDifference) {
  World a = livelyWorld(), b = livelyWorld(1, std::nextafter(1333.0, 2000.0));
  EXPECT_EQ(hash(a.state), hash(b.state));
  a.run(0.5);
  b.run(0.5);
  EXPECT_EQ(hash(a.state) == hash(b.state), a.state.x == b.state.x);
  State changed = a.state;
  changed.x[7] = std::nextafter(changed.x[7], 1.0);
  EXPECT_NE(hash(changed), hash(a.state));
  changed = a.state;
  changed.joints[2] += 1e-12;
  EXPECT_NE(hash(changed), hash(a.state));
  changed = a.state;
  changed.grip.push_back({3, Eigen::Vector3d::Zero()});
  EXPECT_NE(hash(changed), hash(a.state));
}

TEST(Determinism, ACopyOfTheStateHasTheSameFuture) {
  World world = livelyWorld();
  world.run(0.3);
  State copy = world.state;
  Workspace other(*world.model);
  std::vector<Event> events;
  for (int i = 0; i < 20; ++i) {
    world.step();
    step(*world.model, copy, {}, other, events);
  }
  EXPECT_EQ(hash(copy), hash(world.state));
}

class SnapshotFile : public ::testing::Test {
 protected:
  std::string file = ::testing::TempDir() + "vibe_snapshot_test.bin";
  ~SnapshotFile() override { std::remove(file.c_str()); }
  std::string written() const {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
};

TEST_F(SnapshotFile, ContinuesToTheBit) {
  World world = livelyWorld();
  world.run(0.3);
  world.state.grip.push_back({5, Eigen::Vector3d(1e-3, 2e-3, 3e-3)});
  saveSnapshot(*world.model, world.state, file);
  State loaded = loadSnapshot(*world.model, file);
  EXPECT_EQ(hash(loaded), hash(world.state));
  EXPECT_EQ(firstDifference(loaded, world.state), "");
}

TEST_F(SnapshotFile, RefusesWhatDoesNotFit) {
  World world = livelyWorld();
  saveSnapshot(*world.model, world.state, file);
  EXPECT_NO_THROW(loadSnapshot(*world.model, file));
  World other(livelyScene(), plainOrgan(icosphere(0.051, 3), 2e-3));
  EXPECT_THROW(loadSnapshot(*other.model, file), Error);
  EXPECT_THROW(loadSnapshot(*world.model, file + ".missing"), Error);
  EXPECT_THROW(saveSnapshot(*world.model, world.state, "/no/such/folder/s"), Error);
  const std::string bytes = written();
  for (std::size_t size : {std::size_t{0}, std::size_t{5}, std::size_t{12}, bytes.size() / 2, bytes.size() - 1}) {
    std::ofstream(file, std::ios::binary | std::ios::trunc).write(bytes.data(), static_cast<std::streamsize>(size));
    EXPECT_THROW(loadSnapshot(*world.model, file), Error) << size << " bytes";
  }
  std::ofstream(file, std::ios::binary | std::ios::trunc) << bytes << "x";
  EXPECT_THROW(loadSnapshot(*world.model, file), Error);
}

/// Whatever changes the future is looked at; what does not is not.
TEST_F(SnapshotFile, OfASceneWithOtherValuesIsTakenOnRequestOnly) {
  World world = livelyWorld();
  saveSnapshot(*world.model, world.state, file);
  const auto with = [](void (*change)(Scene&)) {
    Scene scene = livelyScene();
    scene.gas->regulated_pressure = 1333;
    change(scene);
    return World(scene, plainOrgan(icosphere(0.05, 3), 2e-3));
  };
  for (const auto change :
       {+[](Scene& s) { s.tissue.young_modulus *= 1.001; }, +[](Scene& s) { s.gas.reset(); },
        +[](Scene& s) { s.tissue.mass_damping += 1; }, +[](Scene& s) { s.foundation->stiffness += 1; },
        +[](Scene& s) {
          s.gravity = GravityScene{{0, 0, -1}};
        }}) {
    const World other = with(change);
    EXPECT_THROW(loadSnapshot(*other.model, file), Error);
    EXPECT_EQ(hash(loadSnapshot(*other.model, file, OtherScene::Taken)), hash(world.state));
  }
  const World same = with([](Scene& s) { s.name = "renamed", s.seed += 1, s.render_surface = true; });
  EXPECT_EQ(hash(loadSnapshot(*same.model, file)), hash(world.state));
  const World organ(livelyScene(), plainOrgan(icosphere(0.051, 3), 2e-3));
  EXPECT_THROW(loadSnapshot(*organ.model, file, OtherScene::Taken), Error);
}

/// Any byte that has changed is found: most by what they mean, the rest by the checksum.
TEST_F(SnapshotFile, AFlippedByteIsFound) {
  World world = livelyWorld();
  saveSnapshot(*world.model, world.state, file);
  const std::string bytes = written();
  int by_checksum = 0;
  for (std::size_t at = 0; at < bytes.size(); at += 1 + bytes.size() / 400) {
    std::string changed = bytes;
    changed[at] = static_cast<char>(changed[at] ^ 1);
    std::ofstream(file, std::ios::binary | std::ios::trunc) << changed;
    try {
      loadSnapshot(*world.model, file);
      ADD_FAILURE() << "byte " << at << " was flipped";
    } catch (const Error& error) {
      by_checksum += std::string(error.what()).find("checksum") != std::string::npos;
    }
  }
  EXPECT_GT(by_checksum, 100) << "the last bit of a position is still a position";
}

/// A snapshot of another version is named as such; one byte of another list of fields is not read either.
TEST_F(SnapshotFile, OfAnotherVersionIsRejectedByName) {
  World world = livelyWorld();
  saveSnapshot(*world.model, world.state, file);
  const std::string bytes = written();
  const auto errorOf = [&](std::size_t at, char value) -> std::string {
    std::string changed = bytes;
    changed[at] = value;
    std::ofstream(file, std::ios::binary | std::ios::trunc) << changed;
    try {
      loadSnapshot(*world.model, file);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(bytes[7], static_cast<char>('A' + kStateVersion - 10));
  EXPECT_EQ(errorOf(7, bytes[7]), "") << "what is not changed is read";
  const std::string older = errorOf(7, '4');
  EXPECT_NE(older.find("is of version 4"), std::string::npos) << older;
  EXPECT_NE(older.find("reads version " + std::to_string(kStateVersion)), std::string::npos) << older;
  EXPECT_NE(errorOf(8, static_cast<char>(~bytes[8])).find("other fields"), std::string::npos);
  EXPECT_NE(errorOf(0, 'V').find("is not a snapshot"), std::string::npos);
}

TEST(Recovery, StateThatIsNoNumberIsPutBackAndReported) {
  World world = livelyWorld();
  world.state.vx[9] = std::numeric_limits<double>::quiet_NaN();
  world.run(0.1);
  EXPECT_GE(world.count(Event::Kind::Recovery), 1);
  for (double x : world.state.x) ASSERT_TRUE(std::isfinite(x));
  world.events.clear();
  world.run(1.0);
  EXPECT_EQ(world.count(Event::Kind::Recovery), 0) << "it goes on as if nothing had been";
}

TEST(Recovery, AThrowAtAbsurdSpeedIsLimitedAndReported) {
  World world = livelyWorld();
  world.state.vx[9] = 1e6;
  world.run(2.0);
  EXPECT_GE(world.count(Event::Kind::Recovery), 1);
  for (double x : world.state.x) ASSERT_LT(std::abs(x), 0.2);
}

}  // namespace
}  // namespace vibe::determinism_test

// The field tables of State: every field counts in hash, snapshot and comparison, and the list belongs to a version.
#include "vibe_core/state/state_fields.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "vibe_core/simulation/simulator.hpp"

namespace vibe {  // not one of its own: VIBE_FIELDS describes a struct in this namespace
namespace {

// One item in every list, so that the fields of its items exist.
State fullState() {
  State state;
  for (auto* list : {&state.x, &state.y, &state.z, &state.vx, &state.vy, &state.vz, &state.ax, &state.ay, &state.az,
                     &state.qw, &state.qx, &state.qy, &state.qz, &state.wx, &state.wy, &state.wz})
    *list = {0, 0};
  state.grip.emplace_back().local.setZero();
  state.pull.node = {0};
  state.pull.weight = {1};
  ProcedureState& procedure = state.procedure;
  procedure.heat = procedure.dose = {0};
  procedure.grade = {0};
  procedure.base_x = procedure.base_y = procedure.base_z = {0};
  Bite bite;
  bite.particle = {0};
  bite.weight = {1};
  procedure.pending = bite;
  Suture& suture = procedure.sutures.emplace_back();
  suture.bites = {bite};
  suture.length = suture.tension = {0};
  suture.taken = {Eigen::Vector3d::Zero()};
  suture.group.particle = suture.group.middle = {0};
  suture.group.offset = {Eigen::Vector3d::Zero()};
  suture.group.weight = {1};
  procedure.bleedings.emplace_back();
  state.solver.linearization_point = state.solver.next = {0};
  state.relaxation.stress = state.relaxation.overstress = {0};
  state.relaxation.held = {0};
  for (ImpedanceBasis* basis : {&state.impedance.current, &state.impedance.next}) {
    basis->positions = basis->gas_direction = {0};
    basis->node = {0};
    basis->direction = {Eigen::Vector3d::Zero()};
    basis->row_motion.emplace_back();
  }
  state.impedance.last_nodes = {0};
  return state;
}

/// An archive that changes the last bit of plain value number `target`; `count` is how many there are.
class BitFlip {
 public:
  explicit BitFlip(std::size_t target) : target_(target) {}
  template <class T>
  void block(T* data, std::size_t size) {
    for (std::size_t i = 0; i < size; ++i) {
      if (count++ != target_) continue;
      auto* byte = reinterpret_cast<unsigned char*>(data + i);
      *byte = static_cast<unsigned char>(*byte ^ 1);
    }
  }
  template <class T>
  void list(std::vector<T>& items) {
    for (T& item : items) transfer(*this, item);
  }
  std::size_t count = 0;

 private:
  std::size_t target_;
};

TEST(StateFields, HashAndComparisonSeeEveryBitOfEveryField) {
  const State state = fullState();
  State copy = state;
  EXPECT_EQ(firstDifference(state, copy), "");
  EXPECT_EQ(hash(state), hash(copy));
  BitFlip all(static_cast<std::size_t>(-1));
  transfer(all, copy);
  ASSERT_GT(all.count, 200U);

  std::set<std::uint64_t> hashes = {hash(state)};
  std::set<std::string> differences;
  for (std::size_t i = 0; i < all.count; ++i) {
    State changed = state;
    BitFlip flip(i);
    transfer(flip, changed);
    const std::string difference = firstDifference(state, changed);
    EXPECT_NE(difference, "") << i;
    EXPECT_TRUE(hashes.insert(hash(changed)).second) << difference;
    EXPECT_TRUE(differences.insert(difference.substr(0, difference.find(':'))).second) << difference;
  }
}

TEST(StateFields, TheHashSeesInWhichListAnItemIs) {
  State a, b;
  a.solver.linearization_point = {1, 2};
  b.solver.linearization_point = {1};
  b.solver.next = {2};
  EXPECT_NE(hash(a), hash(b));
}

TEST(StateFields, TheFirstDifferenceHasNameAndIndex) {
  const State state = fullState();
  const auto differenceOf = [&](auto change) {
    State changed = state;
    change(changed);
    return firstDifference(state, changed);
  };
  EXPECT_EQ(differenceOf([](State& s) { s.y[1] = 0.5; }), "y[1]: 0 against 0.5");
  EXPECT_EQ(differenceOf([](State& s) { s.vz.push_back(0); }), "vz: 2 against 3 items");
  EXPECT_EQ(differenceOf([](State& s) { s.tool_force.z() = 2; }), "tool_force[2]: 0 against 2");
  EXPECT_EQ(differenceOf([](State& s) { s.procedure.phase = Phase::Pull; }), "procedure.phase: 0 against 3");
  EXPECT_EQ(differenceOf([](State& s) { s.procedure.sutures[0].bites[0].weight[0] = 3; }),
            "procedure.sutures[0].bites[0].weight[0]: 1 against 3");
  EXPECT_EQ(differenceOf([](State& s) { s.procedure.pressed[2] = 1; }), "procedure.pressed[2]: 0 against 1");
  EXPECT_EQ(differenceOf([](State& s) { s.random = ~std::uint64_t{0}; }),
            "random: " + std::to_string(state.random) + " against 18446744073709551615");
  // the first in the order of the table, not the last
  EXPECT_EQ(differenceOf([](State& s) { s.energy.gas_work = 1, s.z[0] = -2; }), "z[0]: 0 against -2");
  // bits count, not values: a number that is not one equals itself, and zero has two signs
  State strange = state;
  strange.x[0] = std::nan("");
  EXPECT_EQ(firstDifference(strange, State(strange)), "");
  EXPECT_EQ(differenceOf([](State& s) { s.x[0] = -0.0; }), "x[0]: 0 against -0");
}

struct Inner {
  int count = 0;
  std::vector<float> values;
};

struct Outer {
  bool flag = false;
  Eigen::Vector3d place = Eigen::Vector3d::Zero();
  std::vector<Inner> items;
};

}  // namespace

VIBE_FIELDS(Inner, count, values);
VIBE_FIELDS(Outer, flag, place, items);

namespace {

TEST(Fields, TheListNamesFieldsAndTheirTypes) {
  EXPECT_EQ(fieldList<Outer>(), "{flag:b1x1;place:f8x3;items:[{count:i4x1;values:[f4x1];}];}");
}

/// What follows holds for one list of fields. If it fails, a field was added, removed, renamed or moved: raise the
/// version in state_fields.hpp, so that older files are refused by name, then put the new
/// values here.
TEST(Fields, AnotherListOfFieldsHasAnotherVersion) {
  EXPECT_EQ(kStateVersion, 12U);
  EXPECT_EQ(fieldFingerprint<State>(), 1451408101136081055U) << fieldList<State>();
  EXPECT_EQ(kStepInputVersion, 3U);
  EXPECT_EQ(fieldFingerprint<StepInput>(), 3494105037122736828U) << fieldList<StepInput>();
}

}  // namespace
}  // namespace vibe

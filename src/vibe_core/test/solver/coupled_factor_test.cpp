// The factor contains the stiffness of contacts between nodes that no element joins: two plates on stiff springs.
#include <gtest/gtest.h>

#include "solver/implicit_worlds.hpp"
#include "solver/quasi_newton.hpp"
#include "solver/step_rows.hpp"
#include "solver/stepper_workspace.hpp"
#include "vibe_core/solver/energy_term.hpp"

namespace vibe::coupled_factor_test {
namespace {

using namespace test;

constexpr std::array<int, 3> kCubes = {9, 9, 1};
constexpr double kGap = 0.2 * kSide;
constexpr double kContact = 30 * kE * kSide;  // stiff beside an element [N/m]

/// Springs between nodes of the lower plate and points on triangles of the upper one, along z, unstrained at rest.
class Springs : public EnergyTerm {
 public:
  Springs(const TetMesh& mesh, bool in_factor) : in_factor_(in_factor) {
    const int half = static_cast<int>(mesh.nodes.size()) / 2;
    const auto number = [](int x, int y, int z) { return (x * (kCubes[1] + 1) + y) * (kCubes[2] + 1) + z; };
    for (int x = 0; x < kCubes[0]; ++x)
      for (int y = 0; y < kCubes[1]; ++y) {
        StiffnessCoupling& c = couplings_.emplace_back();
        c.node = {number(x, y, kCubes[2]),
                  half + number(x, y, 0),
                  half + number(x + 1, y, 0),
                  half + number(x, y + 1, 0),
                  -1,
                  -1};
        c.weight = {1, -0.5F, -0.25F, -0.25F};
        c.stiffness = {0, 0, 0, 0, 0, static_cast<float>(kContact)};
        rest_.push_back(0);
        for (std::size_t i = 0; i < 4; ++i)
          rest_.back() += static_cast<double>(c.weight[i]) * mesh.nodes[static_cast<std::size_t>(c.node[i])].z();
      }
  }
  double evaluate(const double* x, float* gradient) const override {
    double energy = 0;
    for (std::size_t k = 0; k < couplings_.size(); ++k) {
      const StiffnessCoupling& c = couplings_[k];
      double longer = -rest_[k];
      for (std::size_t i = 0; i < 4; ++i) longer += static_cast<double>(c.weight[i]) * x[4 * c.node[i] + 2];
      energy += 0.5 * kContact * longer * longer;
      for (std::size_t i = 0; i < 4; ++i)
        gradient[4 * c.node[i] + 2] += static_cast<float>(kContact * longer * static_cast<double>(c.weight[i]));
    }
    return energy;
  }
  void addStiffness(const double*, std::vector<StiffnessCoupling>& couplings) const override {
    if (in_factor_) couplings.insert(couplings.end(), couplings_.begin(), couplings_.end());
  }
  const std::vector<StiffnessCoupling>& couplings() const { return couplings_; }

 private:
  bool in_factor_;
  std::vector<StiffnessCoupling> couplings_;
  std::vector<double> rest_;  // [m]
};

TetMesh plates() {
  TetMesh mesh = tetBox(kCubes, kSide, neoHookean());
  const TetMesh other = mesh;
  const int count = static_cast<int>(mesh.nodes.size());
  for (const Eigen::Vector3d& node : other.nodes)
    mesh.nodes.push_back(node + Eigen::Vector3d(0, 0, kCubes[2] * kSide + kGap));
  for (std::array<int, 4> element : other.elements) {
    for (int& node : element) node += count;
    mesh.elements.push_back(element);
  }
  return mesh;
}

/// Both held at x = 0; the upper one is pressed down.
ElasticBody platesBody() {
  const auto elements = std::make_shared<const LinearTetrahedra>(plates());
  ElasticBody body;
  body.elements = elements;
  body.rest = elements->mesh().nodes;
  body.mass = elements->lumpedMass(kDensity);
  for (std::size_t i = 0; i < body.rest.size(); ++i) {
    body.fixed.push_back(body.rest[i].x() < 1e-9 ? 1 : 0);
    body.load.push_back(Eigen::Vector3d(0, 0, i < body.rest.size() / 2 ? 0.0 : -2e-5 * kE * kSide * kSide));
  }
  return body;
}

/// Iterations towards the equilibrium with one factor about rest.
struct Descent {
  explicit Descent(bool in_factor)
      : body(platesBody()), springs(plates(), true), stepper(body, {}, FactorStorage::Double), motion(body) {
    const auto scratch = stepper.makeWorkspace();
    const std::vector<StiffnessCoupling> none;
    EXPECT_TRUE(factorAt(body, {{}, in_factor ? springs.couplings() : none}, 0, 1, scratch->factors.plan,
                         scratch->factors.matrix, *scratch->factors.current, scratch->single));
    scratch->system.schur.reset(*scratch->factors.current);
    for (int i = 0; i < body.nodeCount(); ++i)
      for (int k = 0; k < 3; ++k) scratch->iterate.z[4 * i + k] = body.rest[i][k];
    loads.extra = &springs;
    buildRows(loads, motion.view(), scratch->system);
    setEquilibriumTargets(loads, scratch->iterate.z, scratch->system);
    scratch->system.schur.setRows(scratch->system.rows, *scratch->factors.current, scratch->factors.columns);
    Potential potential(body, loads, 0, *scratch);
    QuasiNewton newton(body, potential, loads, *scratch);
    newton.takeRows();
    newton.start();
    for (int i = 0; i < 5; ++i) {
      newton.iterate(1, true);
      lengths.push_back(newton.directionLength());
    }
  }
  ElasticBody body;
  Springs springs;
  ImplicitStepper stepper;
  BodyMotion motion;
  BodyLoads loads;
  std::vector<double> lengths;
};

TEST(CoupledFactor, StiffContactsInTheFactorConvergeInAFewIterations) {
  const std::vector<double> with = Descent(true).lengths, without = Descent(false).lengths;
  EXPECT_GT(with.front(), 1e-6);
  EXPECT_LT(with[2], 1e-2 * with.front());
  EXPECT_GT(without[4], 0.1 * without.front()) << "negative control: the springs need no factor";
}

struct Session {
  explicit Session(bool in_factor) : springs(plates(), in_factor), body(platesBody(), settings()) {
    body.loads.extra = &springs;
  }
  static StepSettings settings() {
    StepSettings settings;
    settings.refactor_distance = 1e-7;
    settings.refactor_interval = 3 * settings.step;
    return settings;
  }
  void steps(int count) {
    for (int i = 0; i < count; ++i) last = body.step();
  }
  Springs springs;
  Body body;
  StepOutcome last;
};

TEST(CoupledFactor, StepsTakeTheCouplingsOfThePresentIntoTheNextFactor) {
  Session with(true), without(false);
  for (Session* run : {&with, &without}) run->steps(1);
  EXPECT_TRUE(with.body.memory.couplings.empty());
  const int before = with.last.evaluations;
  for (Session* run : {&with, &without}) run->steps(8);
  EXPECT_EQ(with.body.memory.couplings.size(), with.springs.couplings().size());
  EXPECT_TRUE(without.body.memory.couplings.empty());
  EXPECT_LT(2 * with.last.evaluations, before);
  EXPECT_LT(2 * with.last.evaluations, without.last.evaluations);
  EXPECT_LT(with.last.residual, 1e-3 * without.last.residual);
}

// A replay or a snapshot has no factor in the background.
TEST(CoupledFactor, TheStateAloneGivesTheSameBits) {
  Session session(true), replay(true);
  session.steps(5);
  replay.body.memory = session.body.memory;
  replay.body.motion = session.body.motion;
  for (int i = 0; i < 8; ++i) {
    for (Session* run : {&session, &replay}) run->steps(1);
    ASSERT_TRUE(sameBits(session.body.motion, replay.body.motion)) << "step " << i;
  }
  Session other(false);
  other.body.memory = session.body.memory;
  other.body.memory.couplings.clear();
  other.body.memory.next_couplings.clear();
  other.body.motion = session.body.motion;
  for (Session* run : {&session, &other}) run->steps(1);
  EXPECT_FALSE(sameBits(session.body.motion, other.body.motion)) << "negative control: couplings change nothing";
}

TEST(CoupledFactor, TheNameDependsOnTheCouplings) {
  std::vector<std::uint64_t> names;
  for (const bool in_factor : {true, true, false}) {
    Session session(in_factor);
    session.body.motion.x[2].back() += 1e-3;
    session.steps(1);
    names.push_back(session.body.memory.next_id);
  }
  EXPECT_EQ(names[0], names[1]);
  EXPECT_NE(names[0], names[2]);
}

TEST(CoupledFactor, FixedNodesAreLeftOut) {
  const ElasticBody body = platesBody();
  const auto springs = Springs(plates(), true);
  const auto pattern = blockPattern(body.nodeCount(), body.elements->nodeGroups());
  bool some_fixed = false;
  for (const StiffnessCoupling& c : springs.couplings())
    for (const int node : c.node) some_fixed = some_fixed || body.fixed[static_cast<std::size_t>(node)] != 0;
  ASSERT_TRUE(some_fixed);
  const ImplicitStepper stepper(body, {});
  const auto scratch = stepper.makeWorkspace();
  ASSERT_TRUE(factorAt(body, {{}, springs.couplings()}, 3600, 1, scratch->factors.plan, scratch->factors.matrix,
                       *scratch->factors.current, scratch->single));
  ASSERT_FALSE(scratch->factors.matrix.pairs().empty());
  for (const NodePair& pair : scratch->factors.matrix.pairs()) {
    EXPECT_EQ(body.fixed[static_cast<std::size_t>(pair.row)] + body.fixed[static_cast<std::size_t>(pair.column)], 0);
    EXPECT_LT(pattern.find(pair.row, pair.column), 0);
  }
}

}  // namespace
}  // namespace vibe::coupled_factor_test

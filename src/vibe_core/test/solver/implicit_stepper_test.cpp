// Implicit steps against what is known on paper: conservation, vibration, equilibrium.
#include "vibe_core/solver/implicit_stepper.hpp"

#include <gtest/gtest.h>

#include "solver/implicit_worlds.hpp"

namespace vibe::implicit_stepper_test {
namespace {

using namespace test;

StepSettings exactSettings(double step, double spectral_radius) {
  StepSettings settings;
  settings.step = step;
  settings.spectral_radius = spectral_radius;
  settings.iterations = 30;
  settings.tolerance = 1e-10;
  return settings;
}

// Spinning, drifting and swelling.
void throwIt(Body& run, double spinning = 1) {
  const Eigen::Vector3d drift(0.1, -0.2, 0.05), spin(3, 5, -8), middle(0.02, 0.01, 0.01);
  for (int i = 0; i < run.nodes(); ++i) {
    const Eigen::Vector3d r = run.position(i) - middle;
    const Eigen::Vector3d v = drift + spinning * spin.cross(r) + 20 * r.x() * Eigen::Vector3d::UnitX();
    for (int k = 0; k < 3; ++k) run.motion.v[k][i] = v[k];
  }
}

TEST(FreeBody, KeepsMomentumAndEnergyWithoutDissipation) {
  Body run(block({4, 2, 2}, neoHookean()), exactSettings(5e-4, 1));
  throwIt(run);
  const double energy = run.kinetic();
  const Eigen::Vector3d linear = run.momentum(), angular = run.angularMomentum();
  double max_stored = 0;
  for (int i = 0; i < 300; ++i) {
    ASSERT_FALSE(run.step().fallback);
    const double stored = run.elastic().energy;
    max_stored = std::max(max_stored, stored);
    ASSERT_NEAR(run.kinetic() + stored, energy, 1e-3 * energy) << "step " << i;
  }
  EXPECT_GT(max_stored, 0.05 * energy) << "the body must have deformed for this to mean anything";
  EXPECT_LT((run.momentum() - linear).norm(), 1e-5 * linear.norm());
  EXPECT_LT((run.angularMomentum() - angular).norm(), 1e-4 * angular.norm());
}

TEST(FreeBody, LosesEnergyWithDissipation) {
  Body run(block({4, 2, 2}, neoHookean()), exactSettings(5e-3, 0));
  throwIt(run, 0);
  const double energy = run.kinetic();
  const Eigen::Vector3d linear = run.momentum();
  for (int i = 0; i < 30; ++i) run.step();
  EXPECT_LT(run.kinetic() + run.elastic().energy, 0.95 * energy);
  EXPECT_LT((run.momentum() - linear).norm(), 1e-5 * linear.norm()) << "dissipation does not brake the whole";
}

TEST(FreeBody, FallsAsGalileoSays) {
  ElasticBody body = block({2, 1, 1}, neoHookean());
  body.gravity = {0, 0, -9.81};
  Body run(body, exactSettings(0.01, 0.2));
  for (int k = 0; k < run.nodes(); ++k) run.motion.a[2][k] = -9.81;
  for (int i = 0; i < 100; ++i) run.step();
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (int i = 0; i < run.nodes(); ++i) mean += body.mass[i] / run.mass() * (run.position(i) - body.rest[i]);
  EXPECT_LT((mean - Eigen::Vector3d(0, 0, -0.5 * 9.81)).norm(), 1e-4);
}

/// Lowest mode of a body about rest, normalised to the mass.
struct Mode {
  double frequency;  // [rad/s]
  Eigen::VectorXd shape;
};

Mode lowestMode(const ElasticBody& body) {
  const Eigen::Index n = 3 * body.nodeCount();
  const Eigen::MatrixXd stiffness = denseStiffness(*body.elements, Eigen::VectorXd::Zero(n));
  std::vector<int> free;
  for (int i = 0; i < n; ++i)
    if (body.fixed[i / 3] == 0) free.push_back(i);
  Eigen::VectorXd root(free.size());
  for (std::size_t i = 0; i < free.size(); ++i) root[i] = 1 / std::sqrt(body.mass[free[i] / 3]);
  const Eigen::MatrixXd scaled = root.asDiagonal() * Eigen::MatrixXd(stiffness(free, free)) * root.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(scaled);
  Mode mode{std::sqrt(eigen.eigenvalues()[0]), Eigen::VectorXd::Zero(n)};
  for (std::size_t i = 0; i < free.size(); ++i) mode.shape[free[i]] = root[i] * eigen.eigenvectors()(i, 0);
  return mode;
}

// Coordinate of the mode over time.
std::vector<double> vibration(const ElasticBody& body, const Mode& mode, const StepSettings& settings, double amplitude,
                              int steps) {
  Body run(body, settings);
  for (int i = 0; i < run.nodes(); ++i)
    for (int k = 0; k < 3; ++k) {
      run.motion.x[k][i] += amplitude * mode.shape[3 * i + k];
      run.motion.a[k][i] = -amplitude * mode.frequency * mode.frequency * mode.shape[3 * i + k];
    }
  std::vector<double> out;
  for (int s = 0; s < steps; ++s) {
    run.step();
    double sum = 0;
    for (int i = 0; i < run.nodes(); ++i)
      for (int k = 0; k < 3; ++k) sum += body.mass[i] * mode.shape[3 * i + k] * (run.motion.x[k][i] - body.rest[i][k]);
    out.push_back(sum / amplitude);
  }
  return out;
}

// One oscillator by generalised-alpha as Chung and Hulbert 1993 write it, equations (6) to (9).
std::vector<double> oscillator(double frequency, double damping, double h, double radius, int steps) {
  const double am = (2 * radius - 1) / (radius + 1), af = radius / (radius + 1);
  const double gamma = 0.5 - am + af, beta = 0.25 * (1 - am + af) * (1 - am + af), k = frequency * frequency;
  double d = 1, v = 0, a = -k;
  std::vector<double> out;
  for (int s = 0; s < steps; ++s) {
    const double d_free = d + h * v + h * h * (0.5 - beta) * a, v_free = v + h * (1 - gamma) * a;
    const double a_end = -(am * a + damping * ((1 - af) * v_free + af * v) + k * ((1 - af) * d_free + af * d)) /
                         (1 - am + damping * (1 - af) * gamma * h + k * (1 - af) * beta * h * h);
    d = d_free + h * h * beta * a_end;
    v = v_free + h * gamma * a_end;
    a = a_end;
    out.push_back(d);
  }
  return out;
}

TEST(Beam, ModeIsTheOscillatorOfChungAndHulbert) {
  for (double radius : {0.0, 0.2, 0.7, 1.0}) {
    ElasticBody body = cantilever();
    body.mass_damping = 1.5;
    body.stiffness_damping = 2e-4;
    const Mode mode = lowestMode(body);
    const double h = 1.0 / 60;
    const double amplitude = 2e-4 / mode.shape.cwiseAbs().maxCoeff();
    const std::vector<double> found = vibration(body, mode, exactSettings(h, radius), amplitude, 60);
    const double damping = body.mass_damping + body.stiffness_damping * mode.frequency * mode.frequency;
    const std::vector<double> rhs = oscillator(mode.frequency, damping, h, radius, 60);
    for (std::size_t s = 0; s < found.size(); ++s) ASSERT_NEAR(found[s], rhs[s], 5e-3) << radius << " step " << s;
  }
}

TEST(Beam, FrequencyAndDecayAreOfSecondOrder) {
  ElasticBody body = cantilever({4, 1, 1});
  body.mass_damping = 4;
  const Mode mode = lowestMode(body);
  const double amplitude = 1e-4 / mode.shape.cwiseAbs().maxCoeff();
  const double damped = std::sqrt(mode.frequency * mode.frequency - 4), time = 2 * 2 * M_PI / damped;
  double errors[2];
  for (int k = 0; k < 2; ++k) {
    const int steps = 48 << k;
    const double h = time / steps;
    const std::vector<double> found = vibration(body, mode, exactSettings(h, 0.2), amplitude, steps);
    double sum = 0;
    for (int s = 0; s < steps; ++s) {
      const double t = (s + 1) * h;
      const double exact = std::exp(-2 * t) * (std::cos(damped * t) + 2 / damped * std::sin(damped * t));
      sum += (found[s] - exact) * (found[s] - exact);
    }
    errors[k] = std::sqrt(sum / steps);
  }
  EXPECT_LT(errors[0], 0.08);
  EXPECT_GT(errors[0] / errors[1], 3.3) << "halving the step must quarter the error";
  EXPECT_LT(errors[0] / errors[1], 5);
}

// Stretches along and across of a block under nominal traction: the law differentiated by hand.
std::array<double, 2> stretchesUnder(double traction, double nu) {
  const double mu = kE / (2 * (1 + nu)), lambda = 2 * mu * nu / (1 - 2 * nu);
  double along = 1, across = 1;
  for (int i = 0; i < 100; ++i) {
    const double log_j = std::log(along * across * across);
    const Eigen::Vector2d residual(mu * (along - 1 / along) + lambda * log_j / along - traction,
                                   mu * (across - 1 / across) + lambda * log_j / across);
    Eigen::Matrix2d d;
    d << mu * (1 + 1 / (along * along)) + lambda * (1 - log_j) / (along * along), 2 * lambda / (along * across),
        lambda / (along * across), mu * (1 + 1 / (across * across)) + lambda * (2 - log_j) / (across * across);
    const Eigen::Vector2d move = d.lu().solve(residual);
    along -= move[0], across -= move[1];
  }
  return {along, across};
}

// A block of three by two by two cubes, pulled at its end; its other end is fixed or, where it must thin, only kept in
// its plane by conditions.
std::unique_ptr<Body> pulledBlock(double traction, double nu, bool fixed) {
  ElasticBody body = block({3, 2, 2}, neoHookean(nu));
  body.mass_damping = 30;
  body.load.assign(body.rest.size(), Eigen::Vector3d::Zero());
  for (const auto& e : std::static_pointer_cast<const LinearTetrahedra>(body.elements)->mesh().elements) {
    std::vector<int> on;
    for (int node : e)
      if (body.rest[node].x() > 3 * kSide - 1e-9) on.push_back(node);
    if (on.size() != 3) continue;
    for (int node : on) body.load[node].x() += traction * kSide * kSide / 2 / 3;
  }
  for (std::size_t i = 0; i < body.rest.size(); ++i) body.fixed[i] = fixed && body.rest[i].x() < 1e-9 ? 1 : 0;
  StepSettings settings;
  settings.iterations = 20;
  auto run = std::make_unique<Body>(body, settings);
  for (int i = 0; i < run->nodes() && !fixed; ++i)
    for (int k = 0; k < 3; ++k)
      if (body.rest[i][k] < 1e-9 && (k == 0 || body.rest[i].x() < 1e-9))
        run->loads.constraints.push_back({{i}, {Eigen::Vector3d::Unit(k)}, 0, 0});
  return run;
}

void expectStretches(const Body& run, const std::array<double, 2>& rhs, double tolerance) {
  const Eigen::Vector3d stretch(rhs[0], rhs[1], rhs[1]);
  for (int i = 0; i < run.nodes(); ++i)
    ASSERT_LT((run.position(i) - stretch.cwiseProduct(run.stepper.body().rest[i])).norm(), tolerance);
}

TEST(Settle, BlockUnderDeadLoadHasTheStretchOnPaper) {
  for (double traction : {-0.05 * kE, 0.01 * kE, 0.3 * kE, 0.8 * kE}) {
    SCOPED_TRACE(traction);
    const auto run = pulledBlock(traction, 0, true);
    ASSERT_TRUE(run->settle(1e-7).converged);
    expectStretches(*run, stretchesUnder(traction, 0), 2e-6);
  }
}

TEST(Conditions, LetABlockThinAsItsStretchOnPaper) {
  for (double traction : {-0.1 * kE, 0.3 * kE}) {
    SCOPED_TRACE(traction);
    const auto run = pulledBlock(traction, 0.45, false);
    for (int i = 0; i < 120; ++i) run->step();
    expectStretches(*run, stretchesUnder(traction, 0.45), 1e-5);
    double sum = 0;
    for (const LinearConstraint& constraint : run->loads.constraints)
      sum += constraint.coefficient[0].x() * constraint.force;
    EXPECT_NEAR(sum, -traction * 4 * kSide * kSide, 1e-3 * std::abs(traction) * 4 * kSide * kSide);
  }
}

TEST(Settle, IsWhereTheStepsEnd) {
  ElasticBody body = cantilever();
  body.gravity = {0, 0, -2};
  body.mass_damping = 15;
  Body settled(body), stepped(body);
  ASSERT_TRUE(settled.settle().converged);
  for (int i = 0; i < 240; ++i) stepped.step();
  const int tip = settled.nodes() - 1;
  EXPECT_LT(settled.position(tip).z(), body.rest[tip].z() - 1e-3);
  for (int i = 0; i < settled.nodes(); ++i) EXPECT_LT((settled.position(i) - stepped.position(i)).norm(), 1e-5);
}

}  // namespace
}  // namespace vibe::implicit_stepper_test

// Contacts with friction as a small dense problem: conditions of Coulomb and Signorini, many and redundant contacts.
#include "solver/contact_problem.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>

namespace vibe::contact_problem_test {
namespace {

constexpr double kLength = 1e-9;  // tolerance of the solver [m]

struct Problem {
  /// Contacts on random directions of a body with `freedoms`, whose compliance is about 1e-3 m/N.
  Problem(int contacts, int one_sided, int freedoms, double friction_wanted, unsigned seed)
      : contact_count(contacts),
        per_contact(friction_wanted > 0 ? 3 : 1),
        rows(per_contact * contacts + one_sided),
        friction(friction_wanted) {
    std::mt19937 generator(seed);
    std::normal_distribution<double> normal;
    const auto draw = [&] { return normal(generator); };
    const Eigen::MatrixXd j = Eigen::MatrixXd::NullaryExpr(rows, freedoms, draw);
    compliance = 1e-3 / freedoms * j * j.transpose();
    lack = 1e-3 * Eigen::VectorXd::NullaryExpr(rows, draw);
    force.setZero(rows);
    problem.begin(rows);
    for (int c = 0; c < contacts; ++c) problem.addContact(per_contact * c, friction);
    for (int a = 0; a < rows; ++a)
      for (int b = 0; b < rows; ++b) problem.compliance(a, b) = compliance(a, b);
    problem.finish();
  }
  double solve() { return problem.solve(lack.data(), force.data()); }
  Eigen::VectorXd left() const { return lack - compliance * force; }

  /// The largest violation of the conditions, lengths and forces times compliances [m].
  double violation(double softness = 1e-6) const {
    const Eigen::VectorXd rest = left();
    double max = 0;
    const int contacts_end = per_contact * contact_count;
    for (int row = 0; row < rows; row += row < contacts_end ? per_contact : 1) {
      const double give = softness * compliance(row, row) * force[row], scale = compliance(row, row);
      max = std::max({max, -force[row] * scale, rest[row] - give});
      if (force[row] * scale > kLength) max = std::max(max, std::abs(rest[row]) - give);
      if (row >= contacts_end || per_contact == 1) continue;
      const Eigen::Vector2d drag = force.segment<2>(row + 1), slip = rest.segment<2>(row + 1);
      const double limit = friction * force[row];
      max = std::max(max, (drag.norm() - limit) * scale);
      if (drag.norm() < limit * (1 - 1e-6)) max = std::max(max, slip.norm() - 2 * give);
      if (slip.norm() > 1e-7) max = std::max(max, (drag - limit * slip.normalized()).norm() * scale);
    }
    return max;
  }

  int contact_count, per_contact, rows;
  double friction;
  Eigen::MatrixXd compliance;
  Eigen::VectorXd lack, force;
  ContactProblem problem;
};

TEST(ContactProblem, ConditionsHoldForAnyFrictionAndNumber) {
  for (const double friction : {0.0, 0.1, 0.5, 1.0})
    for (const int contacts : {1, 3, 10, 40}) {
      for (unsigned seed = 1; seed <= 5; ++seed) {
        Problem world(contacts, contacts / 2, 8 * contacts + 8, friction, seed);
        EXPECT_LE(world.solve(), kLength) << contacts << " contacts, friction " << friction << ", seed " << seed;
        EXPECT_LE(world.violation(), 10 * kLength) << "scaled by another compliance than in the solver";
        EXPECT_LE(world.problem.factorizations(), 8);
      }
    }
}

TEST(ContactProblem, WithoutASolutionTheCheckFails) {
  Problem world(10, 0, 100, 0.3, 1);
  EXPECT_GT(world.violation(), 1e-4) << "no forces";
  world.solve();
  world.force[0] += 1e-3;
  EXPECT_GT(world.violation(), 1e-7) << "one force is wrong";
}

TEST(ContactProblem, MoreContactsThanTheBodyHasFreedomsShareTheirForces) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    // twice the same contacts
    Problem once(6, 0, 60, 0.2, seed), twice(12, 0, 60, 0.2, seed);
    twice.compliance << once.compliance, once.compliance, once.compliance, once.compliance;
    twice.lack << once.lack, once.lack;
    twice.problem.begin(36);
    for (int c = 0; c < 12; ++c) twice.problem.addContact(3 * c, 0.2);
    for (int a = 0; a < 36; ++a)
      for (int b = 0; b < 36; ++b) twice.problem.compliance(a, b) = twice.compliance(a, b);
    twice.problem.finish();
    once.solve();
    EXPECT_LE(twice.solve(), 1e-8);
    EXPECT_LT((twice.force.head<18>() + twice.force.tail<18>() - once.force).norm(), 1e-3 * once.force.norm());
  }
}

TEST(ContactProblem, ASolutionThatChangesLittleNeedsNoNewFactor) {
  Problem world(20, 5, 200, 0.3, 3);
  world.solve();
  const int before = world.problem.factorizations();
  world.lack *= 1.0001;
  EXPECT_LE(world.solve(), kLength);
  EXPECT_LE(world.problem.factorizations(), before + 1);
  EXPECT_LE(world.violation(), 10 * kLength) << "scaled by another compliance than in the solver";
}

TEST(ContactProblem, TheStartDoesNotMatterWithoutFriction) {
  Problem cold(20, 5, 200, 0, 4), warm(20, 5, 200, 0, 4);
  cold.solve();
  warm.force.setConstant(0.7);
  warm.solve();
  EXPECT_LT((cold.force - warm.force).norm(), 1e-5 * cold.force.norm());
}

TEST(ContactProblem, TellsWhichRowsHold) {
  Problem world(10, 10, 150, 0.2, 5);
  world.solve();
  int open = 0, slipping = 0;
  for (int row = 0; row < world.rows; ++row) {
    EXPECT_NEAR(world.problem.left(row), world.left()[row], 1e-8);
    if (world.problem.holds(row)) {
      EXPECT_NEAR(world.left()[row], 0, 1e-8);
      continue;
    }
    (world.force[row] == 0 ? open : slipping)++;
  }
  EXPECT_GT(open, 3);
  EXPECT_GT(slipping, 3);
}

}  // namespace
}  // namespace vibe::contact_problem_test

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <array>
#include <string>

#include "solver/thread_problems.hpp"
#include "suture/capstan.hpp"
#include "suture/thread_reference.hpp"

namespace vibe::capstan_reference_test {
namespace {

using Eigen::Vector3d;
using namespace test;

TEST(CapstanReference, HoldsTheHangingMassOfTheReference) {
  const auto value = [](const char* q) { return test::referenceValue("9e_thread_two_eyelets", q); };
  const Vector3d a(0, 0, 0), b(value("B_x_m"), value("B_y_m"), value("B_z_m")),
      c(value("C_x_m"), value("C_y_m"), value("C_z_m")), tip = c - Vector3d(0, 0, 0.05);
  Problem p = even(3, capstanFactor(0, turningAngle(a, b, c)), 1e-4);
  hangWeight(p, 2, 0.01 * 9.81, 1e9);
  const ThreadSlide r = solve(p);
  ASSERT_TRUE(r.converged);
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(r.tension[k] / value("tension_N"), 1, 1e-9);
  const Vector3d on_b = r.tension[0] * (a - b).normalized() + r.tension[1] * (c - b).normalized();
  const Vector3d on_c = r.tension[1] * (b - c).normalized() + r.tension[2] * (tip - c).normalized();
  EXPECT_LT((on_b - Vector3d(value("force_on_B_x_N"), value("force_on_B_y_N"), value("force_on_B_z_N"))).norm(), 2e-9);
  EXPECT_LT((on_c - Vector3d(value("force_on_C_x_N"), value("force_on_C_y_N"), value("force_on_C_z_N"))).norm(), 2e-9);
}

/// Two eyelets on plane springs, see the README of the reference: Newton's method on the positions around the slides,
/// as a tissue would.
struct SprungEyelets {
  static constexpr double kStiffness = 25;
  Eigen::Vector4d rest{0.02, 0.015, 0.06, 0.015}, at = rest;
  VectorXd tension = VectorXd::Zero(3), material;

  std::array<Eigen::Vector2d, 4> points() const {
    return {Eigen::Vector2d(0, 0), at.head<2>(), at.tail<2>(), Eigen::Vector2d(0.08, 0)};
  }
  VectorXd lengths() const {
    const auto p = points();
    return Vector3d((p[1] - p[0]).norm(), (p[2] - p[1]).norm(), (p[3] - p[2]).norm());
  }
  ThreadSlide relax(double friction) {
    ThreadSlide r;
    VectorXd moved = material;
    for (int i = 0; i < 60; ++i) {
      const auto p = points();
      Eigen::Matrix<double, 8, 3> slope = Eigen::Matrix<double, 8, 3>::Zero();
      Eigen::Matrix<double, 8, 8> stiffness = Eigen::Matrix<double, 8, 8>::Zero();
      for (int k = 0; k < 3; ++k) {
        const Eigen::Vector2d d = (p[k + 1] - p[k]).normalized();
        slope.block<2, 1>(2 * k, k) = -d;
        slope.block<2, 1>(2 * k + 2, k) = d;
        Eigen::Matrix<double, 2, 8> difference = Eigen::Matrix<double, 2, 8>::Zero();
        difference.middleCols<2>(2 * k) = -Eigen::Matrix2d::Identity();
        difference.middleCols<2>(2 * k + 2) = Eigen::Matrix2d::Identity();
        const Eigen::Matrix2d across =
            tension[k] / (p[k + 1] - p[k]).norm() * (Eigen::Matrix2d::Identity() - d * d.transpose());
        stiffness += difference.transpose() * across * difference;
      }
      const Eigen::Matrix<double, 4, 3> g = slope.middleRows<4>(2);
      const Eigen::Matrix4d k = kStiffness * Eigen::Matrix4d::Identity() + stiffness.block<4, 4>(2, 2);
      const Eigen::Matrix<double, 4, 3> give = k.ldlt().solve(g);
      const Eigen::Vector4d back = k.ldlt().solve(kStiffness * (at - rest));
      VectorXd factor(2);
      for (int e = 0; e < 2; ++e) {
        const auto lift = [&](int n) { return Vector3d(p[n].x(), p[n].y(), 0); };
        factor[e] = capstanFactor(friction, turningAngle(lift(e), lift(e + 1), lift(e + 2)));
      }
      r = solve({lengths() - g.transpose() * back - material, g.transpose() * give, factor});
      EXPECT_TRUE(r.converged);
      at -= back + give * r.tension;
      tension = r.tension;
    }
    moved -= VectorXd(Vector3d(r.slide[0], r.slide[1] - r.slide[0], -r.slide[1]));
    material = moved;
    return r;
  }
};

TEST(CapstanReference, DrawsSprungEyeletsAsTheReference) {
  SprungEyelets thread;
  thread.material = thread.lengths();
  for (int step = 1; step <= 16; ++step) {
    thread.material[2] -= 0.5e-3;
    const ThreadSlide r = thread.relax(0);
    if (step != 4 && step != 8 && step != 16) continue;
    const std::string name = "9f_thread_two_sprung_eyelets_dL" + std::to_string(step / 2) + "mm";
    const auto value = [&](const char* q) { return test::referenceValue(name, q); };
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(r.tension[k] / value("tension_N"), 1, 1e-6) << name;
    EXPECT_NEAR(thread.at[0] / value("P1x_m"), 1, 1e-6);
    EXPECT_NEAR(thread.at[1] / value("P1y_m"), 1, 1e-6);
    EXPECT_NEAR(thread.at[2] / value("P2x_m"), 1, 1e-6);
    EXPECT_NEAR(thread.at[3] / value("P2y_m"), 1, 1e-6);
    EXPECT_NEAR(thread.lengths().sum() / value("thread_length_m"), 1, 1e-9);
  }
}

TEST(CapstanReference, FrictionKeepsTheFarEyeletOfTheReferenceBack) {
  // Negative control: with friction the tensions are not the reference's, and fall away from the pulled end.
  SprungEyelets thread;
  thread.material = thread.lengths();
  ThreadSlide r;
  for (int step = 1; step <= 8; ++step) {
    thread.material[2] -= 0.5e-3;
    r = thread.relax(0.15);
  }
  EXPECT_GT(r.tension[2], 1.02 * r.tension[1]);
  EXPECT_GT(r.tension[1], 1.02 * r.tension[0]);
  EXPECT_GT(std::abs(r.tension[2] / test::referenceValue("9f_thread_two_sprung_eyelets_dL4mm", "tension_N") - 1), 0.01);
}

}  // namespace
}  // namespace vibe::capstan_reference_test

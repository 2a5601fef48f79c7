#include "self_contact/self_contact.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "self_contact/self_contact_worlds.hpp"

namespace vibe::self_contact_test {
namespace {

using namespace test;

TEST(SelfContact, GradientIsDerivativeOfEnergy) {
  PressedPlates world;
  ASSERT_GT(world.contact.pairs().size(), 60U);
  ASSERT_GT(world.evaluate(), 0);
  const std::vector<float> gradient = world.gradient;
  const double largest = *std::max_element(gradient.begin(), gradient.end());
  ASSERT_GT(largest, 1e-3);
  for (std::size_t i = 0; i < world.at.size(); ++i) {
    if (i % 4 == 3) continue;
    const double kept = world.at[i], step = 1e-8;
    world.at[i] = kept + step;
    const double above = world.evaluate();
    world.at[i] = kept - step;
    const double below = world.evaluate();
    world.at[i] = kept;
    EXPECT_NEAR(gradient[i], (above - below) / (2 * step), 2e-5 * largest) << "component " << i;
  }
}

TEST(SelfContact, NormalForcesArePartsOfTheGradient) {
  PressedPlates world;
  world.evaluate();  // nothing has slid since detect()
  std::vector<double> sum(world.at.size(), 0);
  for (const SelfContact::Pair& pair : world.contact.pairs())
    for (std::size_t k = 0; k < 4; ++k)
      for (Eigen::Index c = 0; c < 3 && pair.node[k] >= 0; ++c)
        sum[4 * static_cast<std::size_t>(pair.node[k]) + static_cast<std::size_t>(c)] -=
            pair.weight[k] * world.contact.normalForce(pair) * pair.normal[c];
  const double largest = *std::max_element(sum.begin(), sum.end());
  ASSERT_GT(largest, 1e-3);
  for (std::size_t i = 0; i < sum.size(); ++i) EXPECT_NEAR(world.gradient[i], sum[i], 1e-5 * largest);
}

/// A valley along y whose sides rise by `slope`, and above it a roof turned over, with its point down.
SurfaceMesh valley(double slope, double x, double z) {
  constexpr double kHalf = 10e-3;
  SurfaceMesh mesh;
  mesh.vertices = {{0, -kHalf, 0}, {0, kHalf, 0}, {-kHalf, 0, slope * kHalf}, {kHalf, 0, slope * kHalf}};
  mesh.triangles = {{0, 1, 2}, {1, 0, 3}};
  for (int k = 0; k < 4; ++k) {
    const double angle = M_PI / 2 * k;
    mesh.vertices.push_back({x + kHalf * std::cos(angle), kHalf * std::sin(angle), z + kHalf});
    mesh.triangles.push_back({4 + k, 8, 4 + (k + 1) % 4});
  }
  mesh.vertices.push_back({x, 0, z});
  return mesh;
}

// A vertex that crosses a valley at a constant height; its force does not jump where the other side becomes nearer.
TEST(SelfContact, ForceIsContinuousAcrossAValley) {
  for (const double slope : {0.05, 0.3, 0.8, 1.0, 1.5}) {
    ContactWorld world(valley(slope, 0, 50e-3));
    Eigen::Vector3d before = Eigen::Vector3d::Zero();
    double largest = 0, jump = 0;
    for (int k = -600; k <= 600; ++k) {
      const SurfaceMesh now = valley(slope, 1e-6 * k, 0.6 * kWallThickness);
      for (std::size_t i = 0; i < world.count(); ++i) world.set(i, now.vertices[i]);
      world.detect(0.5e-3);
      ASSERT_GT(world.evaluate(), 0);
      const Eigen::Vector3d force = world.force(8);
      if (k > -600) jump = std::max(jump, (force - before).norm());
      largest = std::max(largest, force.norm());
      before = force;
    }
    EXPECT_LT(jump, 0.03 * largest) << "slope " << slope;
    EXPECT_LT(before.x(), 0) << "on the right side, to the left";
  }
}

// Though its nearest point is inside the other side, that no longer acts: the near one is nearer in its direction.
TEST(SelfContact, APlaceFarBehindAnotherDoesNotAct) {
  const auto places = [](double x) {
    ContactWorld world(valley(0.8, 0, 50e-3));
    const SurfaceMesh now = valley(0.8, x, 0.6 * kWallThickness);
    for (std::size_t i = 0; i < world.count(); ++i) world.set(i, now.vertices[i]);
    world.detect(0.5e-3);
    return std::count_if(world.contact.pairs().begin(), world.contact.pairs().end(), [](const SelfContact::Pair& pair) {
      return pair.node[0] == 8 && pair.straight_below > 0.19;  // not the bars at places that are close
    });
  };
  EXPECT_EQ(places(0.8e-3), 2);
  EXPECT_EQ(places(1.3e-3), 1);
}

/// A trough along y with a floor and two sides, which rise by `angle` [rad], and above it the turned roof of valley(),
/// whose point is as far from the floor as from sides of 45 degrees.
SurfaceMesh trough(double angle, double z) {
  constexpr double kLong = 20e-3, kHigh = 10e-3;
  const double floor = (std::sqrt(2.0) - 1) * 0.6 * kWallThickness;  // half its width
  SurfaceMesh mesh = valley(0, 0, z);
  mesh.vertices.erase(mesh.vertices.begin(), mesh.vertices.begin() + 4);
  mesh.triangles.erase(mesh.triangles.begin(), mesh.triangles.begin() + 2);
  for (auto& t : mesh.triangles)
    for (int& v : t) v -= 4;
  const double x[4] = {-floor - kHigh * std::cos(angle), -floor, floor, floor + kHigh * std::cos(angle)};
  for (int i = 0; i < 4; ++i)
    for (const double y : {-kLong, 0.7 * kLong})  // no diagonal is below the point
      mesh.vertices.push_back({x[i], y, i == 0 || i == 3 ? kHigh * std::sin(angle) : 0});
  for (int strip = 0; strip < 3; ++strip) {
    const int first = 5 + 2 * strip;
    mesh.triangles.push_back({first, first + 2, first + 3});
    mesh.triangles.push_back({first, first + 3, first + 1});
  }
  return mesh;
}

// Of three places the outer ones are at a right angle at 45 degrees; they share with the middle one, but not with each
// other, and each of them acts once. A force that jumps there never lets walls come to rest.
TEST(SelfContact, ForceIsContinuousWhereSidesPassARightAngle) {
  constexpr double kHeight = 0.6 * kWallThickness, kDegree = M_PI / 180;
  ContactWorld world(trough(45 * kDegree, 50e-3));
  Eigen::Vector3d before = Eigen::Vector3d::Zero();
  double largest = 0, jump = 0;
  for (int k = -200; k <= 200; ++k) {
    const SurfaceMesh now = trough((45 + 0.01 * k) * kDegree, kHeight);
    for (std::size_t i = 0; i < world.count(); ++i) world.set(i, now.vertices[i]);
    world.detect(0.5e-3);
    world.evaluate();
    std::set<int> places;
    for (const SelfContact::Pair& pair : world.contact.pairs()) {
      const bool acts = pair.node[0] == 4 && pair.stiffness > 0;
      EXPECT_TRUE(!acts || places.insert(pair.node[1]).second) << "acts twice";
    }
    EXPECT_EQ(places.size(), 3U);
    const Eigen::Vector3d force = world.force(4);
    if (k > -200) jump = std::max(jump, (force - before).norm());
    largest = std::max(largest, force.norm());
    before = force;
  }
  EXPECT_GT(largest, 0);
  EXPECT_LT(jump, 0.01 * largest);
}

// x . K x of the couplings.
double quadratic(const std::vector<StiffnessCoupling>& couplings, const std::vector<double>& x) {
  double sum = 0;
  for (const StiffnessCoupling& c : couplings) {
    Eigen::Vector3d u = Eigen::Vector3d::Zero();
    for (std::size_t k = 0; k < 4; ++k)
      if (c.node[k] >= 0)
        u += c.weight[k] * Eigen::Vector3d(x[4 * static_cast<std::size_t>(c.node[k])],
                                           x[4 * static_cast<std::size_t>(c.node[k]) + 1],
                                           x[4 * static_cast<std::size_t>(c.node[k]) + 2]);
    Eigen::Matrix3d stiffness;
    stiffness << c.stiffness[0], c.stiffness[1], c.stiffness[2], c.stiffness[1], c.stiffness[3], c.stiffness[4],
        c.stiffness[2], c.stiffness[4], c.stiffness[5];
    sum += u.dot(stiffness * u);
  }
  return sum;
}

TEST(SelfContact, StiffnessIsSecondDerivativeOfEnergy) {
  PressedPlates world;
  std::vector<StiffnessCoupling> couplings;
  world.contact.addStiffness(world.at.data(), couplings);
  ASSERT_GT(couplings.size(), 60U);
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  for (int trial = 0; trial < 5; ++trial) {
    std::vector<double> way(world.at.size());
    for (double& value : way) value = normal(random);
    const double step = 2e-8, middle = world.evaluate();
    const std::vector<double> at = world.at;
    for (std::size_t i = 0; i < at.size(); ++i) world.at[i] = at[i] + step * way[i];
    const double above = world.evaluate();
    for (std::size_t i = 0; i < at.size(); ++i) world.at[i] = at[i] - step * way[i];
    const double below = world.evaluate();
    world.at = at;
    const double second = (above - 2 * middle + below) / (step * step);
    EXPECT_NEAR(quadratic(couplings, way), second, 1e-3 * second);
  }
}

TEST(SelfContact, MomentumAndMomentAreConserved) {
  PressedPlates world;
  world.evaluate();
  Eigen::Vector3d force = Eigen::Vector3d::Zero(), moment = Eigen::Vector3d::Zero();
  double sum = 0;
  for (std::size_t i = 0; i < world.count(); ++i) {
    force += world.force(i);
    moment += world.get(i).cross(world.force(i));
    sum += world.force(i).norm();
  }
  ASSERT_GT(sum, 0.1);
  EXPECT_LT(force.norm(), 1e-6 * sum);
  EXPECT_LT(moment.norm(), 1e-6 * sum * 0.02);
}

// Strain of a plate that a larger one carries under a load, by bisection.
double strainUnder(double load) {
  ContactWorld world(plates(46, 40));
  const int first = plateSize(46);
  double low = 0.2 * kWallThickness, high = 1.1 * kWallThickness;
  for (int i = 0; i < 20; ++i) {
    const double gap = 0.5 * (low + high);
    world.bring(first, gap);
    world.detect(1e-3);
    world.evaluate();
    (world.totalForce(first, world.count()).z() > load ? low : high) = gap;
  }
  return 1 - low / kWallThickness;
}

TEST(SelfContact, PlateOnPlateCarriesTheForceOfTheSqueezedWall) {
  const double area = std::pow(40 * 2.5e-3, 2), modulus = 0.1 * kModulus;
  for (const double stress : {0.5, 1.0, 1.5}) {
    const double s = 1 - strainUnder(stress * modulus * area);
    EXPECT_NEAR(-std::log(s) / s, stress, 0.04 * stress);  // Hencky; the rim takes a little more than its area
  }
}

TEST(SelfContact, ForceIsZeroBeyondOnsetGrowsWithoutJumpAndStaysFinite) {
  ContactWorld world(plates(8, 6));
  double last = 0, largest_change = 0;
  for (double s = 1.4; s > 0.3; s -= 1e-3) {
    world.bring(plateSize(8), s * kWallThickness);
    world.detect(1e-3);
    const double energy = world.evaluate();
    const double force = world.totalForce(plateSize(8), world.count()).z();
    if (s > 1.251) {
      ASSERT_EQ(energy, 0);
    }
    ASSERT_GE(force, last);
    largest_change = std::max(largest_change, (force - last) / std::max(force, kModulus * 1e-5));
    last = force;
  }
  EXPECT_LT(largest_change, 0.05);
  world.detect(1e-3);
  world.bring(plateSize(8), -0.4 * kWallThickness);  // through: pushed back to the side where it was
  EXPECT_TRUE(std::isfinite(world.evaluate()));
  EXPECT_GT(world.totalForce(plateSize(8), world.count()).z(), last);
}

TEST(SelfContact, BothSidesAreTreatedAlike) {
  PressedPlates world;
  SurfaceMesh inside_out = world.rest;
  for (auto& t : inside_out.triangles) std::swap(t[1], t[2]);
  ContactWorld other(inside_out);
  other.at = world.at;
  other.detect(1e-3);
  const double energy = world.evaluate();
  EXPECT_NEAR(other.evaluate(), energy, 1e-9 * energy);
  for (std::size_t i = 0; i < world.count(); ++i)
    EXPECT_LT((world.force(i) - other.force(i)).norm(), 1e-5 * (1e-3 + world.force(i).norm()));
}

TEST(SelfContact, WallsNearAtRestTouchThere) {
  SurfaceMesh mesh = plates(8, 6);
  for (int i = plateSize(8); i < static_cast<int>(mesh.vertices.size()); ++i)
    mesh.vertices[i].z() = 0.5 * kWallThickness;
  ContactWorld world(mesh);
  world.detect(1e-3);
  ASSERT_FALSE(world.contact.pairs().empty());
  EXPECT_LT(world.evaluate(), 1e-30);
  for (int i = plateSize(8); i < static_cast<int>(mesh.vertices.size()); ++i) world.at[4 * i + 2] *= 0.8;
  EXPECT_GT(world.evaluate(), 0);
}

/// Tangential over normal force on a plate that slides over a larger one; without its edge, where pairs are oblique.
double frictionOver(double way, double lead) {
  ContactWorld world(plates(46, 40));
  const int first = plateSize(46);
  world.bring(first, 0.6 * kWallThickness);
  world.detect(1e-3, lead);
  for (std::size_t i = first; i < world.count(); ++i) world.at[4 * i] += way;
  world.evaluate();
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  for (std::size_t i = first; i < world.count(); ++i)
    if (world.rest.vertices[i].head<2>().cwiseAbs().maxCoeff() < 0.04) force += world.force(i);
  return -force.x() / force.z();
}

TEST(SelfContact, SlidingMeetsCoulombFriction) {
  EXPECT_NEAR(frictionOver(0.3e-3, kStep), 0.05, 0.002);
  EXPECT_NEAR(frictionOver(-0.3e-3, kStep), -0.05, 0.002);
  EXPECT_NEAR(frictionOver(0.6e-3, kStep), 0.05, 0.002);  // however far
}

// At half of the speed from which it is that of Coulomb, friction is f_1(1/2) = 3/4 of it, for steps of any length.
TEST(SelfContact, SlowSlidingIsViscousWhateverTheStep) {
  for (const double lead : {kStep, 0.1 * kStep})
    EXPECT_NEAR(frictionOver(2.5e-3 * lead, lead), 0.75 * 0.05, 0.002) << lead;
}

}  // namespace
}  // namespace vibe::self_contact_test

// Active strain of the shell: kernel against reference and finite differences, and a tube against its closed form.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>

#include <Eigen/Geometry>

#include "vibe_core/solver/body_loads.hpp"
#include "vibe_core/solver/implicit_stepper.hpp"
#include "vibe_core/tissue/shell.hpp"
#include "vibe_testing/worlds.hpp"

namespace vibe::wall_muscle_test {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kRadius = 0.02, kWall = 1.5e-3;

Material wall() {
  return {Law::Yeoh, 110e3, 0.45, 2};
}

// Muscle around the z axis.
void addMuscle(ShellMesh& mesh) {
  mesh.thickness.assign(mesh.triangles.size(), kWall);
  mesh.materials = {wall()};
  for (const auto& t : mesh.triangles) {
    const Eigen::Vector3d middle = mesh.nodes[t[0]] + mesh.nodes[t[1]] + mesh.nodes[t[2]];
    mesh.muscle.push_back(Eigen::Vector3d(-middle.y(), middle.x(), 0).normalized());
  }
}

ShellMesh ball() {
  const SurfaceMesh sphere = test::icosphere(kRadius, 2);
  ShellMesh mesh;
  mesh.nodes.assign(sphere.vertices.begin(), sphere.vertices.end());
  for (const auto& t : sphere.triangles) mesh.triangles.push_back({t[0], t[1], t[2]});
  addMuscle(mesh);
  return mesh;
}

// A tube along z; its ends, which have no muscle, are closed by a node each: the gas of an open one would push it away.
ShellMesh tube(int around, int rings) {
  ShellMesh mesh;
  const double rise = 2 * kPi * kRadius / around * std::sqrt(0.75);
  for (int j = 0; j < rings; ++j)
    for (int i = 0; i < around; ++i) {
      const double angle = 2 * kPi * (i + 0.5 * (j % 2)) / around;
      mesh.nodes.emplace_back(kRadius * std::cos(angle), kRadius * std::sin(angle), j * rise);
    }
  const auto at = [&](int i, int j) { return j * around + i % around; };
  for (int j = 0; j + 1 < rings; ++j)
    for (int i = 0; i < around; ++i) {
      const int shift = j % 2;
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + shift, j + 1)});
      mesh.triangles.push_back({at(i + 1 - shift, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  const std::size_t walls = mesh.triangles.size();
  const int bottom = static_cast<int>(mesh.nodes.size()), top = bottom + 1;
  mesh.nodes.emplace_back(0, 0, 0);
  mesh.nodes.emplace_back(0, 0, (rings - 1) * rise);
  for (int i = 0; i < around; ++i) {
    mesh.triangles.push_back({bottom, at(i + 1, 0), at(i, 0)});
    mesh.triangles.push_back({top, at(i, rings - 1), at(i + 1, rings - 1)});
  }
  addMuscle(mesh);
  std::fill(mesh.muscle.begin() + static_cast<std::ptrdiff_t>(walls), mesh.muscle.end(), Eigen::Vector3d::Zero());
  return mesh;
}

struct Draw {
  std::vector<double> displacement;
  std::vector<float> contraction, displacement4;
};

Draw draw(std::size_t nodes, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> move(-1e-3, 1e-3), shorter(0, 1);
  Draw drawn{std::vector<double>(3 * nodes), std::vector<float>(nodes), std::vector<float>(4 * nodes)};
  for (std::size_t i = 0; i < nodes; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      drawn.displacement4[4 * i + k] = static_cast<float>(move(random));
      drawn.displacement[3 * i + k] = drawn.displacement4[4 * i + k];
    }
    drawn.displacement4[4 * i + 3] = drawn.contraction[i] = static_cast<float>(shorter(random));
  }
  return drawn;
}

TEST(WallMuscle, theKernelHasTheEnergyAndForcesOfTheReference) {
  const ShellElements shell(ball());
  const std::size_t nodes = static_cast<std::size_t>(shell.nodeCount());
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const Draw drawn = draw(nodes, seed);
    std::vector<double> exact(3 * nodes), again(3 * nodes);
    std::vector<float> found(4 * nodes, 0.0F);
    const std::vector<float> relaxed(nodes, 0.0F);
    const double energy = shell.evaluate(drawn.displacement.data(), drawn.contraction.data(), exact.data());
    double sum = 0;
    for (int piece = 0; piece < shell.pieceCount(); ++piece)
      sum += shell.evaluate(piece, drawn.displacement4.data(), found.data());
    EXPECT_NEAR(sum, energy, 1e-5 * energy);
    const double without = shell.evaluate(drawn.displacement.data(), again.data());
    EXPECT_NE(energy, without);  // control
    EXPECT_NEAR(shell.muscleWork(drawn.displacement4.data(), relaxed.data()), without - energy, 1e-5 * energy);
    double largest = 0, off = 0;
    for (std::size_t i = 0; i < nodes; ++i)
      for (std::size_t k = 0; k < 3; ++k) {
        largest = std::max(largest, std::abs(exact[3 * i + k]));
        off = std::max(off, std::abs(exact[3 * i + k] - static_cast<double>(found[4 * i + k])));
      }
    EXPECT_LT(off, 1e-4 * largest);
  }
}

TEST(WallMuscle, forcesAreTheSlopeOfTheEnergy) {
  const ShellElements shell(ball());
  const std::size_t nodes = static_cast<std::size_t>(shell.nodeCount());
  Draw drawn = draw(nodes, 1);
  std::vector<double> force(3 * nodes), unused(3 * nodes);
  shell.evaluate(drawn.displacement.data(), drawn.contraction.data(), force.data());
  for (std::size_t i = 0; i < force.size(); i += 37) {
    const double step = 1e-7, kept = drawn.displacement[i];
    drawn.displacement[i] = kept + step;
    const double more = shell.evaluate(drawn.displacement.data(), drawn.contraction.data(), unused.data());
    drawn.displacement[i] = kept - step;
    const double less = shell.evaluate(drawn.displacement.data(), drawn.contraction.data(), unused.data());
    drawn.displacement[i] = kept;
    EXPECT_NEAR((more - less) / (2 * step), force[i], 1e-5 * std::abs(force[i]) + 1e-6);
  }
}

// Energy per volume of a tube whose muscle has shortened to `active`, at stretches around and along it; the wall is as
// thick as costs the least.
double energyAt(double around, double along, double active) {
  const MaterialEnergy law(wall());
  const double a = around / active;
  const auto at = [&](double across) {
    const double first = a * a + along * along + across * across - 3, volume = a * along * across - 1;
    return law.at(first, volume, first - 2 * volume).energy;
  };
  double low = 0.2, high = 4;
  for (int k = 0; k < 100; ++k)
    (at(low + (high - low) / 3) < at(high - (high - low) / 3) ? high -= (high - low) / 3 : low += (high - low) / 3);
  return at((low + high) / 2);
}

// Radius over that at rest of a closed tube: its energy and p V are stationary in both stretches, where the rest area
// A of its side has the energy A kWall W and the volume A kRadius around^2 along / 2.
double closedForm(double active, double pressure) {
  const double h = 1e-4;
  const auto slopes = [&](double around, double along) {
    return std::pair{(energyAt(around + h, along, active) - energyAt(around - h, along, active)) / (2 * h),
                     (energyAt(around, along + h, active) - energyAt(around, along - h, active)) / (2 * h)};
  };
  const auto pressureAt = [&](double around) {
    double low = 0.5, high = 2;
    for (int k = 0; k < 40; ++k) {
      const double along = (low + high) / 2;
      const auto [first, second] = slopes(around, along);
      (second < first * around / (2 * along) ? low : high) = along;
    }
    return kWall * slopes(around, low).first / (kRadius * around * low);
  };
  double low = 0.4, high = 1.6;
  for (int k = 0; k < 30; ++k) (pressureAt((low + high) / 2) < pressure ? low : high) = (low + high) / 2;
  return (low + high) / 2;
}

// The same of a tube of triangles, in its middle.
double simulated(int around, double active, double pressure) {
  const int rings = around;
  const auto shell = std::make_shared<const ShellElements>(tube(around, rings));
  ElasticBody body;
  body.elements = shell, body.shell = shell.get();
  body.rest = shell->mesh().nodes;
  body.mass = shell->lumpedMass(1050);
  body.fixed.assign(body.rest.size(), 0);
  body.foundation.assign(body.rest.size(), 1e-3);  // holds it where it is
  const ImplicitStepper stepper(body, {});
  const auto scratch = stepper.makeWorkspace();
  BodyMotion motion(body);
  const std::vector<float> contraction(body.rest.size(), static_cast<float>(1 / active - 1));
  BodyLoads loads;
  loads.gas.control = GasLoad::Control::Pressure;
  loads.gas.pressure = pressure;
  loads.contraction = &contraction;
  EXPECT_TRUE(stepper.settle(motion.view(), loads, *scratch, 1e-5, 100).converged);
  double sum = 0;
  for (int i = 0; i < around; ++i) {
    const std::size_t node = static_cast<std::size_t>(rings / 2 * around + i);
    sum += std::hypot(motion.x[0][node], motion.x[1][node]) / (kRadius * around);
  }
  return sum;
}

TEST(WallMuscle, aTubeHasTheRadiusOfTheClosedForm) {
  for (const auto& [active, pressure] :
       {std::pair{0.8, 0.0}, {0.6, 1333.0}, {0.8, 1333.0}, {0.9, 1333.0}, {0.95, 1333.0}, {1.0, 1333.0}}) {
    const double exact = closedForm(active, pressure);
    EXPECT_NEAR(simulated(24, active, pressure), exact, 0.005 * exact) << active << " " << pressure;
  }
  EXPECT_NEAR(closedForm(0.8, 0), 0.8, 1e-3);
  EXPECT_GT(closedForm(0.8, 1333), 0.85);  // control: the pressure counts
}

}  // namespace
}  // namespace vibe::wall_muscle_test

#include "vibe_core/tissue/shell.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "tissue/material_law.hpp"
#include "tissue/shell_part.hpp"
#include "tissue/shell_worlds.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe::shell_test {
namespace {

using namespace test;

TEST(Shell, GradientIsThatOfTheEnergy) {
  forAllShells([](const ShellElements& elements) {
    for (const double amount : {0.1, 0.4}) {  // the larger one also reaches the limit of the thinning
      Eigen::VectorXd u = randomDisplacement(elements.nodeCount(), amount * kSide);
      const Eigen::VectorXd gradient = inDouble(elements, u).gradient;
      const double h = 1e-6 * kSide;
      for (Eigen::Index i = 0; i < u.size(); ++i) {
        const double at = u[i];
        u[i] = at + h;
        const double above = inDouble(elements, u).energy;
        u[i] = at - h;
        const double below = inDouble(elements, u).energy;
        u[i] = at;
        EXPECT_NEAR(gradient[i], (above - below) / (2 * h), 2e-6 * gradient.lpNorm<Eigen::Infinity>()) << amount;
      }
    }
  });
}

TEST(Shell, RigidMotionGivesNoForce) {
  forAllShells([](const ShellElements& elements) {
    const bool clamped = !elements.mesh().fixed.empty();  // what is held cannot turn
    const Eigen::Matrix3d turn = clamped ? Eigen::Matrix3d::Identity() : someRotation();
    const Eigen::VectorXd u = displaced(elements.mesh(), [&](const Eigen::Vector3d& x) -> Eigen::Vector3d {
      return turn * x + Eigen::Vector3d(0.01, 0, -0.02);
    });
    const double scale = kE * kSide * kThickness;  // a strain of 1 across a triangle
    EXPECT_LT(inDouble(elements, u).gradient.lpNorm<Eigen::Infinity>(), 1e-12 * scale);
    EXPECT_LT(inSingle(elements, u).gradient.lpNorm<Eigen::Infinity>(), 3e-5 * scale);
    EXPECT_EQ(inSingle(elements, Eigen::VectorXd::Zero(u.size())).gradient.norm(), 0);
    EXPECT_EQ(inSingle(elements, Eigen::VectorXd::Zero(u.size())).energy, 0);
  });
}

TEST(Shell, FreeSheetTurnsWithoutForce) {
  ShellMesh mesh = patchwork(Law::NeoHookean);
  mesh.fixed.clear();
  const ShellElements elements(mesh);
  const Eigen::VectorXd u = affine(mesh, someRotation());
  EXPECT_LT(inDouble(elements, u).gradient.lpNorm<Eigen::Infinity>(), 1e-12 * kE * kSide * kThickness);
}

// Energy per area of a stretch in the plane, the stretch across found by bisection of dW/d(across).
double planeStressEnergy(const Material& m, double first, double second) {
  const LawTerms<double> terms(lawConstants(m));
  const auto law = [&](double across) {
    const double i = first * first + second * second + across * across - 3, j = first * second * across - 1;
    return withLaw(m.law, [&](auto tag) { return lawAt<decltype(tag)::value>(terms, i, j, i - 2 * j); });
  };
  double low = 0.05, high = 5;
  for (int step = 0; step < 100; ++step) {
    const double across = (low + high) / 2;
    const auto w = law(across);
    (2 * w.by_i * across + w.by_j * first * second > 0 ? high : low) = across;
  }
  return law(low).energy * kThickness;
}

TEST(Shell, FlatSheetFollowsPlaneStress) {
  for (const Law law : kLaws) {
    const ShellElements elements(shaken(sheet(4, 4, law), 0.15 * kSide, true));
    double area = 0;
    for (const double mass : elements.lumpedMass(1 / kThickness)) area += mass;
    const double stretches[][2] = {{0.7, 1.2}, {0.8, 0.8}, {1.001, 1}, {1.3, 0.9}, {1.5, 1.5}, {2, 1.2}, {1.9, 1.7}};
    for (const auto& [first, second] : stretches) {
      const Eigen::Matrix3d f = someRotation() * Eigen::Vector3d(first, second, 1).asDiagonal();
      const double expected = planeStressEnergy(material(law), first, second) * area;
      const Eigen::VectorXd u = affine(elements.mesh(), f);
      EXPECT_NEAR(inDouble(elements, u).energy, expected, 1e-7 * expected) << static_cast<int>(law) << ' ' << first;
      EXPECT_NEAR(inSingle(elements, u).energy, expected, 1e-4 * expected) << static_cast<int>(law) << ' ' << first;
    }
  }
}

// Nodes within get no force: the patch test. The force across a cut is the derivative of the energy by the stretch.
TEST(Shell, UniformStretchIsInEquilibrium) {
  for (const Law law : kLaws) {
    const ShellMesh mesh = sheet(6, 6, law);
    const ShellElements elements(mesh);
    const double length = 6 * kSide, h = 1e-5;
    for (const double stretch : {0.8, 1.3, 1.8}) {
      const auto gradient =
          inSingle(elements, affine(mesh, Eigen::Vector3d(stretch, 1.1, 1).asDiagonal())).gradient.eval();
      double within = 0, force = 0;
      for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
        const Eigen::Vector3d& x = mesh.nodes[i];
        const Eigen::Vector3d f = gradient.segment<3>(3 * static_cast<Eigen::Index>(i));
        const auto inside = [&](double v) { return v > 1.5 * kSide && v < length - 1.5 * kSide; };
        if (inside(x.x()) && inside(x.y())) within = std::max(within, f.norm());
        if (x.x() > length / 2) force += f.x();
      }
      const double expected =
          (planeStressEnergy(material(law), stretch + h, 1.1) - planeStressEnergy(material(law), stretch - h, 1.1)) /
          (2 * h) * length;
      EXPECT_NEAR(force, expected, 1e-4 * std::abs(expected)) << static_cast<int>(law) << ' ' << stretch;
      EXPECT_LT(within, 1e-5 * std::abs(expected));
    }
  }
}

// Energy of a sheet that is stretched and bent to a cylinder along its length, as far as it goes with the third power
// of the thickness.
double bendingEnergy(int along, int across, double radius, double nu, double first = 1, double second = 1) {
  const auto energy = [&](double thickness) {
    ShellMesh mesh = sheet(along, across, Law::NeoHookean, false);
    mesh.materials = {{Law::NeoHookean, kE, nu, 0}};
    mesh.thickness.assign(mesh.triangles.size(), thickness);
    const auto place = [&](const Eigen::Vector3d& x) {
      const double angle = first * x.x() / radius;
      return Eigen::Vector3d(radius * std::sin(angle), second * x.y(), radius * (1 - std::cos(angle)));
    };
    return inDouble(ShellElements(mesh), displaced(mesh, place)).energy;
  };
  return (energy(kThickness) - 2 * energy(kThickness / 2)) / 0.75;
}

// The second difference by length and width leaves what is away from the free sides.
double bendingPerArea(double radius, double nu, double first = 1, double second = 1) {
  const auto energy = [&](int along, int across) { return bendingEnergy(along, across, radius, nu, first, second); };
  return (energy(12, 12) - energy(12, 6) - energy(6, 12) + energy(6, 6)) / (36 * kSide * kSide);
}

// D/2 kappa^2 per area.
TEST(Shell, SheetBentToACylinderHasTheEnergyOfAPlate) {
  for (const double nu : {0.0, 0.45}) {
    const double radius = 10 * kSide;
    const double stiffness = kE * std::pow(kThickness, 3) / 12 / (1 - nu * nu);
    const double expected = stiffness / 2 / (radius * radius);
    EXPECT_NEAR(bendingPerArea(radius, nu), expected, 0.02 * expected) << nu;
  }
}

// The metric C11 at the distance z is that of the middle less 2 z b: W'' / 2 (2 b)^2 t^3 / 12 per area.
TEST(Shell, StretchedSheetBendsByTheTangentOfItsLaw) {
  const double radius = 20 * kSide, stretches[][2] = {{0.8, 1}, {1.2, 1}, {1, 1.3}, {0.9, 1.25}, {1.3, 1.2}};
  for (const auto& [first, second] : stretches) {
    const Material m{Law::NeoHookean, kE, kNu, 0};
    const double c = first * first, h = 1e-3, b = c / radius;
    const auto energy = [&](double metric) { return planeStressEnergy(m, std::sqrt(metric), second) / kThickness; };
    const double curve = (energy(c + h) - 2 * energy(c) + energy(c - h)) / (h * h);
    const double expected = curve * b * b * std::pow(kThickness, 3) / 6;
    EXPECT_NEAR(bendingPerArea(radius, kNu, first, second), expected, 0.03 * expected) << first << ' ' << second;
  }
  // the control: the stiffness changes by more than the tolerance
  EXPECT_GT(bendingPerArea(radius, kNu, 0.8), 2 * bendingPerArea(radius, kNu) * 0.8 * 0.8 * 0.8 * 0.8);
}

// A sphere blown up a little: membrane energy of two equal strains, E t / (1 - nu) strain^2 per area.
TEST(Shell, InflatedSphereFollowsMembraneTheory) {
  const double radius = 0.04, strain = 1e-3;
  ShellMesh mesh = sphere(3, radius);
  const ShellElements elements(mesh);
  double area = 0;
  for (const double mass : elements.lumpedMass(1 / kThickness)) area += mass;
  EXPECT_NEAR(area, 4 * M_PI * radius * radius, 0.01 * area);
  const Evaluation e = inSingle(elements, affine(mesh, (1 + strain) * Eigen::Matrix3d::Identity()));
  const double expected = kE * kThickness / (1 - kNu) * strain * strain * area;
  EXPECT_NEAR(e.energy, expected, 0.01 * expected);
  // the pressure that holds it: p dV = dW, p = 2 E t strain / (1 - nu) / radius
  const double outward =
      e.gradient.dot(displaced(mesh, [](const Eigen::Vector3d& x) -> Eigen::Vector3d { return 2 * x; }));
  const double by_volume =
      e.volume_gradient.dot(displaced(mesh, [](const Eigen::Vector3d& x) -> Eigen::Vector3d { return 2 * x; }));
  EXPECT_NEAR(outward / by_volume, 2 * kE * kThickness * strain / (1 - kNu) / radius, 0.01 * outward / by_volume);
}

TEST(Shell, VolumeAndItsGradientAreThoseOfTheSurface) {
  const double radius = 0.04;
  const ShellElements elements(sphere(3, radius), {0.01, -0.02, 0.005});
  EXPECT_NEAR(inSingle(elements, Eigen::VectorXd::Zero(3 * elements.nodeCount())).volume,
              4.0 / 3 * M_PI * std::pow(radius, 3), 0.05 * std::pow(radius, 3));
  Eigen::VectorXd u = randomDisplacement(elements.nodeCount(), 0.1 * radius);
  const Evaluation d = inDouble(elements, u), f = inSingle(elements, u);
  EXPECT_NEAR(f.volume, d.volume, 1e-6 * d.volume);
  EXPECT_LT((f.volume_gradient - d.volume_gradient).norm(), 1e-6 * d.volume_gradient.norm());
  const double h = 1e-4 * radius;
  for (Eigen::Index i = 0; i < 60; ++i) {
    const double at = u[i];
    u[i] = at + h;
    const double above = inDouble(elements, u).volume;
    u[i] = at - h;
    const double below = inDouble(elements, u).volume;
    u[i] = at;
    EXPECT_NEAR(d.volume_gradient[i], (above - below) / (2 * h), 1e-9 * radius * radius);
  }
}

TEST(Shell, EnergyIsTheSameWithAndWithoutTheVolume) {
  const ShellElements elements(patchwork(Law::NeoHookean));
  const std::vector<float> u = fourFloats(randomDisplacement(elements.nodeCount(), 0.1 * kSide));
  std::vector<float> with(u.size(), 0.0f), without(u.size(), 0.0f), area(u.size(), 0.0f);
  double volume = 0;
  EXPECT_EQ(elements.evaluate(0, u.data(), with.data(), area.data(), volume),
            elements.evaluate(0, u.data(), without.data()));
  EXPECT_EQ(with, without);
}

TEST(Shell, PartsGiveTheBitsOfPiecesInTurn) {
  const ShellElements elements(sphere(4, 0.05));
  const std::vector<float> u = fourFloats(randomDisplacement(elements.nodeCount(), 0.1 * kSide));
  std::vector<float> gradient(u.size(), 0.0f), area = gradient;
  std::vector<double> energies;
  double volume = 0;
  for (int p = 0; p < elements.pieceCount(); ++p)
    energies.push_back(elements.evaluate(p, u.data(), gradient.data(), area.data(), volume));
  for (const int count : {2, 3, 8}) {
    const std::vector<ShellPart> parts = elements.partsOf(count);
    ASSERT_EQ(parts.size() + 1, static_cast<std::size_t>(count));
    std::vector<float> sum(u.size(), 0.0f), sum_area = sum;
    double ignored = 0;
    for (int p = 0; p < parts.front().first_piece; ++p)
      EXPECT_EQ(elements.evaluate(p, u.data(), sum.data(), sum_area.data(), ignored), energies[p]);
    for (const ShellPart& part : parts) {
      EXPECT_FALSE(part.copies.empty()) << "parts that share nothing test nothing";
      std::vector<float> own_u, own(part.size(), 0.0f), own_area = own;
      for (const auto* nodes : {&part.own, &part.copies})
        for (const int node : *nodes) own_u.insert(own_u.end(), &u[4 * node], &u[4 * node] + 4);
      for (int p = part.first_piece; p < part.last_piece; ++p)
        EXPECT_EQ(elements.evaluate(part, p, own_u.data(), own.data(), own_area.data(), ignored), energies[p]);
      for (std::size_t i = 0; i < part.size(); ++i) {
        const bool is_own = i / 4 < part.own.size();
        const std::size_t node = is_own ? part.own[i / 4] : part.copies[i / 4 - part.own.size()];
        sum[4 * node + i % 4] += own[i], sum_area[4 * node + i % 4] += own_area[i];
      }
    }
    EXPECT_EQ(sum, gradient);
    EXPECT_EQ(sum_area, area);
  }
}

TEST(Shell, HingeAndClampChangeBendingOnly) {
  ShellMesh mesh = sheet(4, 3);
  const auto bent = [](const ShellMesh& m) {
    const Eigen::VectorXd u = displaced(m, [](const Eigen::Vector3d& x) {
      return Eigen::Vector3d(x.x(), x.y(), x.x() > 1.5 * kSide ? 0.2 * (x.x() - 1.5 * kSide) : 0);
    });
    return inDouble(ShellElements(m), u).energy;
  };
  // folded along the nodes 8 to 11: a hinge there takes the bending away
  const auto folded = [&](const std::vector<std::array<int, 2>>& hinged) {
    ShellMesh m = mesh;
    m.hinged = hinged;
    const Eigen::VectorXd u = displaced(m, [](const Eigen::Vector3d& x) -> Eigen::Vector3d {
      if (x.x() < 2.5 * kSide) return x;
      return Eigen::Vector3d(2 * kSide + std::cos(0.3) * (x.x() - 2 * kSide), x.y(),
                             std::sin(0.3) * (x.x() - 2 * kSide));
    });
    return inDouble(ShellElements(m), u).energy;
  };
  const double stiff = folded({});
  EXPECT_GT(stiff, 0);
  EXPECT_LT(folded({{8, 9}, {9, 10}, {10, 11}}), 1e-12 * stiff);
  // a sheet held at the nodes 0 to 3 and turned about them: free it goes along, clamped it bends
  const auto turned = [&](bool fixed) {
    ShellMesh m = mesh;
    m.fixed.assign(m.nodes.size(), 0);
    for (std::size_t i = 0; i < 4; ++i) m.fixed[i] = fixed ? 1 : 0;
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitY()).toRotationMatrix();
    return inDouble(ShellElements(m), affine(m, turn)).energy;
  };
  EXPECT_LT(turned(false), 1e-12 * stiff);
  EXPECT_GT(turned(true), 0.1 * stiff);
  EXPECT_GT(bent(mesh), 0);
}

// A sheet whose first three columns of nodes are held: triangles that cannot move take no part in the strain of others,
// as if they were not there, and the others are clamped to them.
TEST(Shell, HeldTrianglesAreLikeAClampedRim) {
  ShellMesh whole = sheet(6, 3), cut = whole;
  whole.fixed.assign(whole.nodes.size(), 0);
  for (std::size_t i = 0; i < 12; ++i) whole.fixed[i] = 1;
  cut.fixed = whole.fixed;
  const auto held = [](const std::array<int, 3>& t) { return *std::max_element(t.begin(), t.end()) < 12; };
  cut.triangles.erase(std::remove_if(cut.triangles.begin(), cut.triangles.end(), held), cut.triangles.end());
  cut.thickness.resize(cut.triangles.size());
  EXPECT_EQ(cut.triangles.size() + 12, whole.triangles.size());
  Eigen::VectorXd u = randomDisplacement(static_cast<int>(whole.nodes.size()), 0.1 * kSide);
  u.head(36).setZero();
  const Evaluation one = inDouble(ShellElements(whole), u), other = inDouble(ShellElements(cut), u);
  EXPECT_NEAR(one.energy, other.energy, 1e-12 * other.energy);
  EXPECT_LT((one.gradient - other.gradient).norm(), 1e-12 * other.gradient.norm());
  whole.fixed.clear();
  EXPECT_GT(std::abs(inDouble(ShellElements(whole), u).energy - other.energy), 0.01 * other.energy);  // the control
}

TEST(Shell, MassAndStrainAreThoseOfTheTriangles) {
  ShellMesh mesh = sphere(1, 0.03);
  const ShellElements elements(mesh);
  double mass = 0, area = 0;
  for (const double m : elements.lumpedMass(1050)) mass += m;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Eigen::Vector3d& x = mesh.nodes[static_cast<std::size_t>(a)];
    area += (mesh.nodes[static_cast<std::size_t>(b)] - x).cross(mesh.nodes[static_cast<std::size_t>(c)] - x).norm() / 2;
  }
  EXPECT_NEAR(mass, 1050 * kThickness * area, 1e-12 * mass);
  std::vector<float> strain(mesh.nodes.size(), -1);
  elements.strain(affine(mesh, 1.3 * someRotation()).data(), strain.data());
  for (const float value : strain) EXPECT_NEAR(value, 0.3, 1e-6);
}

void expectError(ShellMesh mesh, const std::string& part) {
  try {
    const ShellElements elements(std::move(mesh));
    FAIL() << "accepted, expected to hear of " << part;
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
  }
}

TEST(Shell, BadMeshIsAnErrorThatNamesTheTriangle) {
  const ShellMesh good = sheet(3, 3);
  ShellMesh bad = good;
  std::swap(bad.triangles[7][0], bad.triangles[7][1]);
  expectError(bad, "triangle 7 ");
  bad = good;
  bad.nodes.emplace_back(kSide, kSide, kSide);
  bad.triangles.push_back({bad.triangles[0][0], bad.triangles[0][1], 16});
  bad.thickness.push_back(kThickness);
  expectError(bad, "triangle 18 ");
  bad = good;
  bad.triangles[5][2] = bad.triangles[5][1];
  expectError(bad, "triangle 5 ");
  bad = good;
  bad.triangles[3][1] = 99;
  expectError(bad, "node 99");
  bad = good;
  bad.thickness[4] = 0;
  expectError(bad, "triangle 4 ");
  bad = good;
  bad.thickness.pop_back();
  expectError(bad, "thickness");
  bad = good;
  bad.material.assign(bad.triangles.size(), 0);
  bad.material[9] = 1;
  expectError(bad, "triangle 9 ");
  bad = good;
  bad.materials[0].poisson_ratio = 0.5;
  expectError(bad, "Poisson");
  bad = good;
  bad.hinged = {{0, 11}};
  expectError(bad, "nodes 0 and 11");
  bad = good;
  bad.fixed = {1};
  expectError(bad, "fixed");
  bad = good;
  bad.nodes[5].x() = std::numeric_limits<double>::quiet_NaN();
  expectError(bad, "no area");
  bad = sheet(1, 1);
  bad.nodes[1] = bad.nodes[2];
  expectError(bad, "folded");
}

}  // namespace
}  // namespace vibe::shell_test

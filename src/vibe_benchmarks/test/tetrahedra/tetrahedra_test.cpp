#include "tetrahedra/tetrahedra.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <map>

#include "tetrahedra/tetrahedra_worlds.hpp"
#include "vibe_testing/expect_error.hpp"

namespace vibe::benchmarks::tetrahedra_test {
namespace {

using namespace test;

struct Uniaxial {
  double lateral, nominal_stress;
};

// The stretch across which leaves the sides free, by bisection of dW/d(lateral).
Uniaxial uniaxial(const Material& m, double stretch) {
  const MaterialEnergy energy(m);
  const auto law = [&](double across) {
    const double i = stretch * stretch + 2 * across * across - 3, j = stretch * across * across - 1;
    return energy.at(i, j, i - 2 * j);
  };
  double low = 0.3, high = 3;
  for (int step = 0; step < 100; ++step) {
    const double across = (low + high) / 2;
    const auto w = law(across);
    (2 * w.by_i + w.by_j * stretch > 0 ? high : low) = across;
  }
  const auto w = law(low);
  return {low, 2 * w.by_i * stretch + w.by_j * low * low};
}

// Forces on a block of 40 x 20 x 20 mm, E 30 kPa, nu 0.45: roots of the published formulas of the three laws, [N].
TEST(Tetrahedra, UniaxialClosedFormHasTheKnownForces) {
  const double stretch[] = {0.5, 0.75, 1.25, 1.5, 2.0};
  const double forces[3][5] = {{-13.033, -4.0189, 2.4696, 4.3034, 7.1856},
                               {-13.312, -4.0361, 2.5115, 4.5051, 8.0061},
                               {-12.828, -4.0077, 2.4712, 4.3065, 7.1897}};
  for (std::size_t law = 0; law < 3; ++law)
    for (std::size_t k = 0; k < 5; ++k)
      EXPECT_NEAR(uniaxial(material(kLaws[law]), stretch[k]).nominal_stress * 4e-4, forces[law][k],
                  1e-4 * std::abs(forces[law][k]));
}

// Nodes in the planes through the origin slide in them, those at the far end are moved; the rest finds its place.
template <int Nodes>
struct SlidingBlock {
  TetElements<Nodes> elements;
  double length;
  std::vector<Eigen::Index> free;

  explicit SlidingBlock(TetMesh<Nodes> mesh) : elements(std::move(mesh)), length(0) {
    const auto& nodes = elements.mesh().nodes;
    for (const auto& x : nodes) length = std::max(length, x.x());
    for (std::size_t i = 0; i < nodes.size(); ++i)
      for (int c = 0; c < 3; ++c) {
        const bool held = nodes[i][c] < 1e-9 || (c == 0 && nodes[i].x() > length - 1e-9);
        if (!held) free.push_back(static_cast<Eigen::Index>(3 * i) + c);
      }
  }

  // Newton's method with halved steps.
  Eigen::VectorXd solve(Eigen::VectorXd u) const {
    for (int step = 0; step < 60; ++step) {
      const TetEvaluation now = inDouble(elements, u);
      const Eigen::VectorXd residual = now.gradient(free);
      if (residual.norm() < 1e-12) break;
      const Eigen::VectorXd change = denseStiffness(elements, u)(free, free).ldlt().solve(-residual);
      double scale = 1;
      Eigen::VectorXd trial = u;
      do {
        trial = u;
        trial(free) += scale * change;
        scale /= 2;
      } while (scale > 1e-6 && inDouble(elements, trial).energy > now.energy);
      u = trial;
    }
    return u;
  }
};

template <int Nodes>
void expectUniaxial(const TetMesh<4>& block, const std::function<TetMesh<Nodes>(const TetMesh<4>&)>& convert) {
  const SlidingBlock<Nodes> world(convert(block));
  const auto& nodes = world.elements.mesh().nodes;
  for (const double stretch : {0.5, 0.75, 1.25, 1.5, 2.0}) {
    Eigen::VectorXd start = affine(world.elements.mesh(), Eigen::Vector3d(stretch, 1, 1).asDiagonal());
    const Eigen::VectorXd u = world.solve(start);
    const Uniaxial expected = uniaxial(block.materials[0], stretch);
    for (std::size_t i = 0; i < nodes.size(); ++i)
      ASSERT_NEAR(u[3 * static_cast<Eigen::Index>(i) + 1], (expected.lateral - 1) * nodes[i].y(), 1e-4 * kSide);
    for (const bool single : {false, true}) {
      const Eigen::VectorXd gradient =
          single ? inSingle(world.elements, u).gradient : inDouble(world.elements, u).gradient;
      double force = 0;
      for (std::size_t i = 0; i < nodes.size(); ++i)
        if (nodes[i].x() > world.length - 1e-9) force += gradient[3 * static_cast<Eigen::Index>(i)];
      const double exact = expected.nominal_stress * kSide * kSide;
      EXPECT_NEAR(force, exact, (single ? 1e-4 : 1e-8) * std::abs(exact)) << stretch;
    }
  }
}

TEST(Tetrahedra, BlockFindsTheUniaxialClosedForm) {
  for (const Law law : kLaws) {
    SCOPED_TRACE(static_cast<int>(law));
    expectUniaxial<4>(tetBox({2, 1, 1}, kSide, material(law)), [](const TetMesh<4>& m) { return m; });
    expectUniaxial<10>(tetBox({2, 1, 1}, kSide, material(law)),
                       [](const TetMesh<4>& m) { return quadraticMesh(m).mesh; });
  }
}

TEST(Tetrahedra, SmallStrainHasYoungAndPoisson) {
  const double strain = 1e-6;
  for (const Law law : kLaws) {
    const Uniaxial u = uniaxial(material(law), 1 + strain);
    EXPECT_NEAR(u.nominal_stress, kE * strain, 1e-5 * kE * strain);
    EXPECT_NEAR(u.lateral - 1, -kNu * strain, 1e-5 * strain);
    const TetElements<10> block(quadraticMesh(tetBox({2, 1, 1}, kSide, material(law))).mesh);
    const Eigen::Matrix3d f = Eigen::Vector3d(1 + strain, 1 - kNu * strain, 1 - kNu * strain).asDiagonal();
    const double expected = 0.5 * kE * strain * strain * block.volume();
    EXPECT_NEAR(inSingle(block, affine(block.mesh(), f)).energy, expected, 1e-4 * expected);
  }
}

TEST(Tetrahedra, RigidMotionGivesNoForce) {
  forAllElements([](const ElasticElements& elements, const std::vector<Eigen::Vector3d>& nodes) {
    Eigen::VectorXd u(3 * elements.nodeCount());
    for (std::size_t i = 0; i < nodes.size(); ++i)
      u.segment<3>(3 * static_cast<Eigen::Index>(i)) =
          someRotation() * nodes[i] - nodes[i] + Eigen::Vector3d(0.01, 0, -0.02);
    const double scale = kE * kSide * kSide;  // a strain of 1 across a face
    EXPECT_LT(inDouble(elements, u).gradient.lpNorm<Eigen::Infinity>(), 1e-13 * scale);
    EXPECT_LT(inSingle(elements, u).gradient.lpNorm<Eigen::Infinity>(), 3e-6 * scale);
    EXPECT_EQ(inSingle(elements, Eigen::VectorXd::Zero(u.size())).gradient.norm(), 0);
  });
}

// Nodes of the faces that belong to one element only.
std::vector<bool> onSurface(const TetMesh<10>& mesh) {
  const std::array<std::array<std::size_t, 6>, 4> faces = {
      {{0, 1, 2, 4, 5, 6}, {0, 1, 3, 4, 8, 7}, {1, 2, 3, 5, 9, 8}, {2, 0, 3, 6, 7, 9}}};
  std::map<std::array<int, 6>, int> uses;
  for (const auto& element : mesh.elements)
    for (const auto& face : faces) {
      std::array<int, 6> nodes;
      std::transform(face.begin(), face.end(), nodes.begin(), [&](std::size_t a) { return element[a]; });
      std::sort(nodes.begin(), nodes.end());
      ++uses[nodes];
    }
  std::vector<bool> out(mesh.nodes.size(), false);
  for (const auto& [nodes, count] : uses)
    if (count == 1)
      for (const int node : nodes) out[static_cast<std::size_t>(node)] = true;
  return out;
}

TEST(Tetrahedra, QuadraticPatchTestPasses) {
  const TetElements<10> elements(straightMesh(Law::NeoHookean, {2, 2, 2}));
  Eigen::Matrix3d f;
  f << 1.2, 0.1, -0.05, 0.02, 0.9, 0.1, 0, -0.15, 1.1;
  const Eigen::VectorXd gradient = inDouble(elements, affine(elements.mesh(), f)).gradient;
  const std::vector<bool> surface = onSurface(elements.mesh());
  int inside = 0;
  double inner = 0, outer = 0;
  for (std::size_t i = 0; i < surface.size(); ++i) {
    const double force = gradient.segment<3>(3 * static_cast<Eigen::Index>(i)).norm();
    (surface[i] ? outer : inner) = std::max(surface[i] ? outer : inner, force);
    inside += !surface[i];
  }
  EXPECT_EQ(inside, 27);  // 5 x 5 x 5 nodes less those of the surface
  EXPECT_LT(inner, 1e-13 * outer);
}

// Bent to a small curvature k without change of width: energy E k^2/2 times the integral of z^2. Linear elements lock.
template <int Nodes>
double bendingEnergyRatio(TetMesh<Nodes> mesh) {
  mesh.materials = {{Law::NeoHookean, kE, 0, 0}};
  const TetElements<Nodes> elements(std::move(mesh));
  const double k = 1e-4;
  Eigen::VectorXd u(3 * elements.nodeCount());
  for (int i = 0; i < elements.nodeCount(); ++i) {
    const Eigen::Vector3d x = elements.mesh().nodes[static_cast<std::size_t>(i)] - Eigen::Vector3d(0, 0, kSide / 2);
    u.segment<3>(3 * i) << -k * x.x() * x.z(), 0, k * x.x() * x.x() / 2;
  }
  const double z2 = 2 * kSide * kSide * kSide * kSide * kSide / 12;  // of 2 x 1 x 1 cubes
  return inDouble(elements, u).energy / (kE / 2 * k * k * z2);
}

TEST(Tetrahedra, QuadraticElementsBendAndLinearOnesLock) {
  const TetMesh<4> block = tetBox({2, 1, 1}, kSide, material(Law::NeoHookean));
  EXPECT_NEAR(bendingEnergyRatio(quadraticMesh(block).mesh), 1, 1e-5);
  EXPECT_GT(bendingEnergyRatio(block), 1.5);
}

TEST(Tetrahedra, MassIsThatOfTheVolume) {
  const TetElements<4> linear(tetBox({2, 1, 1}, kSide, material(Law::NeoHookean)));
  const TetElements<10> quadratic(quadraticMesh(linear.mesh()).mesh), curved(curvedMesh(Law::NeoHookean));
  EXPECT_NEAR(linear.volume(), 2e-6, 1e-18);
  for (const ElasticElements* elements :
       {static_cast<const ElasticElements*>(&linear), static_cast<const ElasticElements*>(&quadratic)}) {
    const std::vector<double> mass = elements->lumpedMass(1050);
    const auto total = Eigen::Map<const Eigen::VectorXd>(mass.data(), static_cast<Eigen::Index>(mass.size()));
    EXPECT_NEAR(total.sum(), 1050 * 2e-6, 1e-15);
    EXPECT_GT(total.minCoeff(), 0);
  }
  double sum = 0;
  for (const double mass : curved.lumpedMass(1)) sum += mass;
  EXPECT_NEAR(sum, curved.volume(), 1e-12 * sum);
  EXPECT_NE(curved.volume(), TetElements<10>(straightMesh(Law::NeoHookean)).volume());
}

TEST(Tetrahedra, StrainOfAUniformStretch) {
  const TetElements<10> elements(curvedMesh(Law::NeoHookean));
  const Eigen::VectorXd u = affine(elements.mesh(), 1.3 * someRotation());
  std::vector<float> strain(elements.mesh().nodes.size(), -1);
  elements.strain(u.data(), strain.data());
  for (const float value : strain) EXPECT_NEAR(value, 0.3, 1e-6);
}

TEST(Tetrahedra, QuadraticMeshHasOneNodePerEdge) {
  const TetMesh<4> linear = tetBox({1, 1, 1}, kSide, material(Law::NeoHookean));
  const QuadraticMesh quadratic = quadraticMesh(linear);
  EXPECT_EQ(quadratic.edges.size(), 19u);  // of a cube: 12, 6 diagonals of faces, 1 in space
  ASSERT_EQ(quadratic.mesh.nodes.size(), 27u);
  for (std::size_t k = 0; k < quadratic.edges.size(); ++k) {
    const auto [a, b] = quadratic.edges[k];
    EXPECT_LT(a, b);
    const Eigen::Vector3d middle =
        (linear.nodes[static_cast<std::size_t>(a)] + linear.nodes[static_cast<std::size_t>(b)]) / 2;
    EXPECT_EQ(quadratic.mesh.nodes[8 + k], middle);
  }
}

void expectError(TetMesh<4> mesh, const std::string& part) {
  EXPECT_ERROR(TetElements<4>(std::move(mesh)), part);
}

TEST(Tetrahedra, BadMeshIsAnErrorThatNamesTheElement) {
  const TetMesh<4> good = tetBox({2, 1, 1}, kSide, material(Law::NeoHookean));
  TetMesh<4> bad = good;
  std::swap(bad.elements[7][0], bad.elements[7][1]);
  expectError(bad, "tetrahedron 7 ");
  bad = good;
  bad.elements[5][2] = bad.elements[5][1];
  expectError(bad, "tetrahedron 5 ");
  bad = good;
  bad.elements[3][1] = 99;
  expectError(bad, "node 99");
  EXPECT_THROW(quadraticMesh(bad), Error);
  bad = good;
  bad.nodes[0].x() = std::numeric_limits<double>::quiet_NaN();
  expectError(bad, "tetrahedron 0 ");
  bad = good;
  bad.material.assign(bad.elements.size(), 0);
  bad.material[9] = 1;
  expectError(bad, "tetrahedron 9 ");
  bad = good;
  bad.materials.clear();
  expectError(bad, "0 materials");
  bad = good;
  bad.materials[0].poisson_ratio = 0.5;
  expectError(bad, "Poisson");
  TetMesh<10> folded = quadraticMesh(good).mesh;
  folded.nodes[static_cast<std::size_t>(folded.elements[4][4])] =
      folded.nodes[static_cast<std::size_t>(folded.elements[4][2])];
  EXPECT_THROW(TetElements<10>{folded}, Error);
}

}  // namespace
}  // namespace vibe::benchmarks::tetrahedra_test

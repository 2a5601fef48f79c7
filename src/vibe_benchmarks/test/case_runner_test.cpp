#include "fem/case_runner.hpp"

#include <algorithm>
#include <chrono>
#include <sstream>

#include "case_file.hpp"

namespace vibe::benchmarks::case_runner_test {
namespace {

std::vector<ResultRow> run(const std::string& text, std::string* log = nullptr) {
  const CaseFile file(text);
  std::ostringstream out;
  std::vector<CaseValue> values;
  const auto rows = runCase(readCase(file.path()), out, values);
  if (log != nullptr) *log = out.str();
  return rows;
}

std::string stretch(const std::string& reference) {
  return blockCase(stretchLoads(),
                   "static: {levels: [0.5, 1], substeps: 4, tolerance: 1.0e-8 m}\n"
                   "sample: [{name: force, kind: reaction, set: x_max, direction: [1, 0, 0], reference: " +
                       reference + "}]\n");
}

// Nominal stress times rest cross-section: closed form of uniaxial tension for W = mu/2 (I-3) - mu ln J + lambda/2 ln^2
// J.
double uniaxialForce(double stretch) {
  const double mu = 30e3 / (2 * 1.45), lambda = 30e3 * 0.45 / (1.45 * 0.1);
  double low = 0.3, high = 2;  // lateral stretch s: mu (s^2 - 1) + lambda ln(stretch s^2) = 0
  for (int i = 0; i < 200; ++i) {
    const double s = 0.5 * (low + high);
    (mu * (s * s - 1) + lambda * std::log(stretch * s * s) > 0 ? high : low) = s;
  }
  const double s = 0.5 * (low + high);
  return 4e-4 * (mu * (stretch - 1 / stretch) + lambda * std::log(stretch * s * s) / stretch);
}

TEST(CaseRunner, stretchesABlockAsTheClosedFormSays) {
  std::ostringstream reference;
  reference.precision(12);
  reference << "[" << uniaxialForce(1.25) << ", " << uniaxialForce(1.5) << "]";
  EXPECT_NEAR(uniaxialForce(1.5), 4.3033722, 1e-6);  // as tabulated with the case
  std::string log;
  const auto begin = std::chrono::steady_clock::now();
  const auto rows = run(stretch(reference.str()), &log);
  const std::chrono::duration<double, std::milli> whole = std::chrono::steady_clock::now() - begin;
  ASSERT_EQ(rows.size(), 1U);
  EXPECT_LT(rows[0].reference_error, 1e-4) << log;
  EXPECT_EQ(log.find("NOT CONVERGED"), std::string::npos) << log;
  EXPECT_EQ(rows[0].method, "linear_tet");
  // times of single steps: ordered, and none longer than the whole run
  EXPECT_GT(rows[0].ms_p50, 1e-3 * whole.count() / 8) << "8 steps share the run with its preparation";
  EXPECT_LE(rows[0].ms_p50, rows[0].ms_p99);
  EXPECT_LE(rows[0].ms_p99, rows[0].ms_max);
  EXPECT_LE(rows[0].ms_max, whole.count());
}

// A load with a ramp rests before it, is full behind it, and every value is kept with its level.
TEST(CaseRunner, rampsALoadBetweenTwoLevels) {
  std::string loads = stretchLoads();
  loads.insert(loads.rfind('}'), ", ramp: [1, 2]");
  const CaseFile file(blockCase(loads,
                                "static: {levels: [0.5, 1, 1.5, 2, 3], substeps: 2, tolerance: 1.0e-8 m}\n"
                                "sample: [{name: force, kind: reaction, set: x_max, direction: [1, 0, 0]}]\n"));
  std::ostringstream log;
  std::vector<CaseValue> values;
  runCase(readCase(file.path()), log, values);
  ASSERT_EQ(values.size(), 5U);
  const double expected[] = {0, 0, uniaxialForce(1.25), uniaxialForce(1.5), uniaxialForce(1.5)};
  for (std::size_t i = 0; i < 5; ++i) EXPECT_NEAR(values[i].value, expected[i], 1e-3) << i;
  EXPECT_EQ(values[2].at, 1.5);
  EXPECT_EQ(values[2].sample, "force");
}

// A block pressed to half of its length between sliding ends. Free to, it bows to a side long before; held along an
// edge at both ends, it stays on the branch of the closed form.
std::vector<ResultRow> pressed(const std::string& held_too, std::string& log) {
  return run(
      "name: block\n"
      "mesh:\n"
      "  box: {size: [40 mm, 20 mm, 20 mm], cells: [4, 2, 2], tets_per_cell: 6}\n"
      "  named: {corner: {nearest: [0, 0, 0]}, edge: {nearest: [0, 20 mm, 0]}, far: {nearest: [40 mm, 0, 0]}}\n"
      "element: linear_tet\n"
      "material: {law: neo_hookean, young_modulus: 30 kPa, poisson_ratio: 0.45}\n"
      "density: 1050 kg/m^3\n"
      "loads:\n"
      "  prescribed:\n"
      "    - {set: x_min, held: [x]}\n"
      "    - {set: corner, held: [y, z]}\n"
      "    - {set: edge, held: [z]}\n" +
          held_too +
          "    - {set: x_max, held: [x], translation: [20 mm, 0, 0]}\n"
          "static: {levels: [-0.5, -1], substeps: 5, tolerance: 1.0e-8 m}\n"
          "sample: [{name: force, kind: reaction, set: x_max, direction: [1, 0, 0], reference: [" +
          std::to_string(uniaxialForce(0.75)) + ", " + std::to_string(uniaxialForce(0.5)) + "]}]\n",
      &log);
}

TEST(CaseRunner, warnsOfABlockThatBucklesAndNotOfItsTwin) {
  std::string log;
  const auto twin = pressed("    - {set: far, held: [y, z]}\n", log);
  EXPECT_LT(twin[0].reference_error, 1e-3) << log;
  EXPECT_EQ(twin[0].branch, Branch::Same) << log;
  EXPECT_EQ(log.find("ANOTHER BRANCH"), std::string::npos) << log;
  const auto buckled = pressed("", log);
  EXPECT_GT(buckled[0].reference_error, 0.3) << log;
  EXPECT_EQ(buckled[0].branch, Branch::Other) << log;
  EXPECT_EQ(log.find("ANOTHER BRANCH at level -0.5:"), std::string::npos) << log;
  EXPECT_NE(log.find("ANOTHER BRANCH at level -1:"), std::string::npos) << log;
}

// What the load bends is no symmetry that has been lost, however far it bends.
TEST(CaseRunner, doesNotTakeBendingForBuckling) {
  std::string log;
  const std::string bar =
      "name: bar\n"
      "mesh: {box: {size: [120 mm, 20 mm, 20 mm], cells: [6, 2, 2]}}\n"
      "element: quadratic_tet\n"
      "material: {law: neo_hookean, young_modulus: 30 kPa, poisson_ratio: 0.4}\n"
      "density: 1050\n"
      "clamped: [x_min]\n"
      "loads: {gravity: [0, 0, -9.81]}\n"
      "static: {levels: [0.5, 1], substeps: 3, tolerance: 1.0e-7 m}\n"
      "sample: [{name: tip, kind: displacement, points: [[120 mm, 10 mm, 10 mm]], direction: [0, 0, 1], "
      "reference: [none, -0.04]}]\n";
  EXPECT_EQ(run(bar, &log)[0].branch, Branch::Same) << log;
}

// A plate pulled at a spot between nodes: what the spot does is the mean over the wall around its centre, whose place
// is exact on any mesh.
TEST(CaseRunner, spotsAreMeansOverTheWallAndNotOverNodes) {
  FemCase plate;
  plate.element = ElementKind::Shell;
  plate.thickness = 0.003;
  plate.material = {Law::NeoHookean, 30e3, 0.45, 0};
  for (int i = 0; i < 8; ++i)
    for (int k = 0; k < 8; ++k) plate.mesh.nodes.emplace_back(0.01 * i, 0.01 * k, 0);
  for (int i = 0; i < 7; ++i)
    for (int k = 0; k < 7; ++k) {
      const int a = 8 * i + k;
      plate.mesh.triangles.push_back({a, a + 8, a + 9});
      plate.mesh.triangles.push_back({a, a + 9, a + 1});
    }
  const Eigen::Vector3d centre(0.033, 0.0312, 0);
  plate.spots["spot"] = {centre, 0.009, Eigen::Vector3d::Zero()};
  const CaseModel model(plate, Hold::AsFixed);
  const NodeMean& mean = model.spot("spot");
  Eigen::Vector3d place = Eigen::Vector3d::Zero(), lumped = place;
  double sum = 0;
  for (std::size_t i = 0; i < mean.node.size(); ++i) place += mean.weight[i] * plate.mesh.nodes[mean.node[i]];
  for (const Eigen::Vector3d& x : plate.mesh.nodes) {
    const double part = std::max(0.0, 1 - (x - centre).squaredNorm() / (0.009 * 0.009));
    lumped += part * part * x, sum += part * part;
  }
  EXPECT_LT((place - centre).norm(), 1e-3 * 0.009);
  EXPECT_GT((lumped / sum - centre).norm(), 0.05 * 0.009);  // the control: the nodes alone
}

TEST(CaseRunner, reportsTheErrorAgainstAWrongReference) {
  const auto rows = run(stretch("[none, " + std::to_string(2 * uniaxialForce(1.5)) + "]"));
  EXPECT_NEAR(rows[0].reference_error, 0.5, 1e-3);
}

TEST(CaseRunner, findsTheBendingFrequencyOfABar) {
  // slender: Euler-Bernoulli, f = 1.8751^2 / (2 pi L^2) sqrt(E h^2 / (12 rho))
  const double wanted = 3.51602 / (2 * std::acos(-1.0) * 0.04) * std::sqrt(30e3 * 0.01 * 0.01 / (12 * 1050));
  const auto rows =
      run("name: bar\n"
          "mesh: {box: {size: [200 mm, 10 mm, 10 mm], cells: [20, 1, 1]}}\n"
          "element: quadratic_tet\n"
          "material: {law: neo_hookean, young_modulus: 30 kPa, poisson_ratio: 0}\n"
          "density: 1050\n"
          "clamped: [x_min]\n"
          "modes: {count: 2}\n"
          "sample: [{name: f1, kind: frequency, mode: 1, reference: " +
          std::to_string(wanted) + "}, {name: f2, kind: frequency, mode: 2, reference: " + std::to_string(2 * wanted) +
          "}]\n");
  EXPECT_LT(rows[0].reference_error, 0.01);
  EXPECT_NEAR(rows[1].reference_error, 0.5, 0.02);  // a square bar has the same stiffness in both directions
}

std::string releasedBar(const std::string& seconds, const std::string& amplitude) {
  return "name: bar\n"
         "mesh: {box: {size: [200 mm, 20 mm, 10 mm], cells: [10, 1, 1]}}\n"
         "element: quadratic_tet\n"
         "material: {law: neo_hookean, young_modulus: 30 kPa, poisson_ratio: 0}\n"
         "density: 1050\n"
         "clamped: [x_min]\n"
         "transient: {step: 10 ms, duration: " +
         seconds + " s, iterations: 40, tolerance: 1.0e-7, start: {mode: 1, amplitude: " + amplitude +
         " mm}}\n"
         "sample:\n"
         "  - {name: f, kind: frequency, points: [[200 mm, 0, 0]], direction: [0, 0, 1], reference: 0.2159}\n"
         "  - {name: kept, kind: kept, points: [[200 mm, 0, 0]], direction: [0, 0, 1], reference: 1}\n";
}

TEST(CaseRunner, keepsFrequencyAndAmplitudeOfAReleasedBar) {
  const auto rows = run(releasedBar("30", "0.5"));
  EXPECT_LT(rows[0].reference_error, 0.02);
  EXPECT_LT(rows[1].reference_error, 0.01);
  EXPECT_LT(std::abs(rows[0].energy_drift), 0.02);
}

TEST(CaseRunner, hashesTheLastState) {
  const std::uint64_t hash = run(releasedBar("10", "0.5"))[0].state_hash;
  EXPECT_EQ(run(releasedBar("10", "0.5"))[0].state_hash, hash) << "the same run";
  EXPECT_NE(run(releasedBar("10.01", "0.5"))[0].state_hash, hash) << "one step more";
  EXPECT_NE(run(releasedBar("10", "0.500001"))[0].state_hash, hash) << "another start";
}

}  // namespace
}  // namespace vibe::benchmarks::case_runner_test

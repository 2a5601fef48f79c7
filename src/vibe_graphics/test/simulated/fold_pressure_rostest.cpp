// Height of the folds of the simulated organ while it is filled to 10 mmHg and emptied again.
#include <gtest/gtest.h>
#include <ros/package.h>
#include <ros/ros.h>
#include <vibe_msgs/LoadScene.h>
#include <vibe_msgs/Snapshot.h>
#include <vibe_msgs/Step.h>
#include <vibe_msgs/StepResult.h>

#include <unistd.h>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <numeric>
#include <thread>
#include <tuple>

#include "vibe_graphics/geometry/mucosa_map.hpp"
#include "vibe_graphics/messages/tissue_messages.hpp"

namespace vibe::graphics {
namespace {

constexpr double kPascal = 133.322;                      // of 1 mmHg
constexpr double kPeriod = 1.0 / 60;                     // of a step [s]
constexpr int kSteps = 6;                                // from sample to sample
const std::vector<double> kLevels{0, 2, 4, 5.6, 8, 10};  // [mmHg]
enum Region : std::uint8_t { Fundus = 1, Body = 2, Antrum = 3 };

/// The simulator, paused, and what it has told.
class Simulator {
 public:
  Simulator() {
    topology_ = node_.subscribe("tissue/topology", 1, &Simulator::keepTopology, this);
    particles_ = node_.subscribe("tissue/particles", 1, &Simulator::keepParticles, this);
    result_ = node_.subscribe("step_result", 1, &Simulator::keepResult, this);
  }

  /// Whether it holds within a minute.
  template <class Condition>
  static bool waitFor(Condition holds) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    while (!holds()) {
      if (!ros::ok() || std::chrono::steady_clock::now() > end) return false;
      ros::spinOnce();
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return true;
  }

  template <class Service>
  bool call(const std::string& name, Service service) {
    if (!ros::service::waitForService(name, 60000) || !ros::service::call(name, service)) return false;
    EXPECT_TRUE(service.response.success) << service.response.message;
    return service.response.success;
  }

  /// Takes steps, after which particles and pressure are those of one moment.
  bool step(int count) {
    const ros::Time end = result.header.stamp + ros::Duration((count - 0.5) * kPeriod);
    vibe_msgs::Step service;
    service.request.n = static_cast<std::uint32_t>(count);
    if (!call("step", service)) return false;
    return waitFor([&] { return result.header.stamp > end && particles_stamp == result.header.stamp; });
  }

  /// Goes on in another scene from where this one stands.
  bool continueIn(const std::string& scene, const std::string& snapshot) {
    vibe_msgs::Snapshot state;
    state.request.file = snapshot;
    state.request.other_scene = true;
    vibe_msgs::LoadScene other;
    other.request.file = scene;
    return call("save_snapshot", state) && call("load_scene", other) && call("load_snapshot", state);
  }

  vibe_msgs::StepResult result;
  TissueMesh mesh;
  TissueFrame frame;
  ros::Time particles_stamp;

 private:
  void keepTopology(const vibe_msgs::TissueTopology& message) { EXPECT_EQ(readTopology(message, mesh), ""); }
  void keepParticles(const sensor_msgs::PointCloud2& message) {
    if (mesh.particle_count == 0) return;
    particles_stamp = readParticles(message, mesh, frame).empty() ? message.header.stamp : ros::Time();
  }
  void keepResult(const vibe_msgs::StepResult& message) { result = message; }

  ros::NodeHandle node_;
  ros::Subscriber topology_, particles_, result_;
};

/// Height of the folds in a region at one pressure [m], and the share of it that has none.
struct Folds {
  double median = 0, mean = 0, none = 0;
};

double medianOf(std::vector<float> values) {
  if (values.empty()) return 0;
  std::nth_element(values.begin(), values.begin() + static_cast<long>(values.size() / 2), values.end());
  return double(values[values.size() / 2]);
}

/// Particles of the regions, so that the render surface does not blur them.
class FoldMeter {
 public:
  /// @param shift  added to the stretch from which on the wall is smooth
  explicit FoldMeter(TissueMesh mesh, float shift = 0) : region_(mesh.region) {
    MucosaMap map = mapMucosa(mesh);
    for (float& smooth : map.smooth_stretch) smooth += shift;
    mesh.render_offsets.clear();
    folds_ = std::make_unique<FoldHeight>(mesh, map);
  }
  Folds of(Region region, const std::vector<float>& positions) {
    const std::vector<float>& all = folds_->update(positions);
    std::vector<float> heights;
    for (std::size_t i = 0; i < region_.size(); ++i)
      if (region_[i] == region) heights.push_back(all[i]);
    const auto none = std::count(heights.begin(), heights.end(), 0.0F);
    const double count = std::max(1.0, static_cast<double>(heights.size()));
    const double sum = std::accumulate(heights.begin(), heights.end(), 0.0);
    return {medianOf(heights), sum / count, static_cast<double>(none) / count};
  }

 private:
  std::vector<std::uint8_t> region_;
  std::unique_ptr<FoldHeight> folds_;
};

/// Positions of the particles when the pressure first passes each of the levels; steps until the last one has come.
/// @param rising  or falling, then the levels come from the last to the first
std::vector<std::vector<float>> positionsAt(Simulator& simulator, bool rising) {
  std::vector<double> levels = kLevels;
  if (!rising) std::reverse(levels.begin(), levels.end());
  std::vector<std::vector<float>> found;
  for (int sample = 0; sample < 400 && found.size() < levels.size(); ++sample) {
    if (!simulator.step(kSteps)) break;
    const double pressure = simulator.result.pressure / kPascal, wanted = levels[found.size()];
    if (rising ? pressure >= wanted - 0.05 : pressure <= wanted + 0.05) found.push_back(simulator.frame.positions);
  }
  if (!rising) std::reverse(found.begin(), found.end());
  return found;
}

/// At the pressure of the insufflator, when everything has come to rest.
std::vector<float> settled(Simulator& simulator) {
  EXPECT_TRUE(simulator.step(120));
  EXPECT_NEAR(simulator.result.pressure / kPascal, kLevels.back(), 0.02);
  return simulator.frame.positions;
}

TEST(FoldPressureTest, FoldsOfTheSimulatedOrganGoWithThePressureAndComeBack) {
  Simulator simulator;
  ASSERT_TRUE(Simulator::waitFor([&] { return simulator.mesh.particle_count > 0; })) << "no simulator";
  auto up = positionsAt(simulator, true);
  ASSERT_EQ(up.size(), kLevels.size());
  up.back() = settled(simulator);
  const TissueMesh mesh = simulator.mesh;
  char file[] = "/tmp/vibe_fold_pressure_XXXXXX";
  const int opened = mkstemp(file);
  ASSERT_GE(opened, 0);
  close(opened);
  const std::string folder = ros::package::getPath("vibe_graphics") + "/test/simulated/";
  const bool continued = simulator.continueIn(folder + "desufflated.yaml", file);
  std::remove(file);
  ASSERT_TRUE(continued);
  const auto down = positionsAt(simulator, false);
  ASSERT_EQ(down.size(), kLevels.size());

  FoldMeter meter(mesh), later(mesh, 0.05F);
  for (const auto& [region, name, rest, smooth] :
       {std::tuple(Body, "body", 3e-3, 0.95), std::tuple(Fundus, "fundus", 0.85 * 3e-3, 0.9)}) {
    Folds before{2 * rest, 2 * rest, 0};
    for (std::size_t k = 0; k < kLevels.size(); ++k) {
      const Folds filled = meter.of(region, up[k]), emptied = meter.of(region, down[k]);
      std::printf("%s at %.1f mmHg: %.2f mm, emptied %.2f mm; without folds %.1f %%, emptied %.1f %%\n", name,
                  kLevels[k], 1e3 * filled.median, 1e3 * emptied.median, 100 * filled.none, 100 * emptied.none);
      EXPECT_LE(filled.median, before.median) << kLevels[k];
      EXPECT_LT(filled.mean, 0.95 * before.mean) << kLevels[k];
      EXPECT_NEAR(emptied.median, filled.median, 0.1e-3) << kLevels[k];
      before = filled;
    }
    EXPECT_NEAR(meter.of(region, up.front()).median, rest, 0.1 * rest);
    EXPECT_GT(meter.of(region, up.back()).none, smooth);
    EXPECT_LT(later.of(region, up.back()).none, 0.7) << "control: folds that go at 5 % more stretch";
    EXPECT_LT(meter.of(region, up[3]).none, 0.3) << "control: at 5.6 mmHg there are folds";
  }
  EXPECT_LT(meter.of(Antrum, up.front()).median, 0.3 * meter.of(Body, up.front()).median) << "control: no rugae there";
}

}  // namespace
}  // namespace vibe::graphics

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "fold_pressure");
  return RUN_ALL_TESTS();
}

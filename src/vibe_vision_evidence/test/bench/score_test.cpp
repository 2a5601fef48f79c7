#include "bench/score.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace vibe::vision::evidence::score_test {
namespace {

/// Reports what it is told to.
class FakeMethod : public Method {
 public:
  std::string name() const override { return "fake"; }
  std::size_t instrument(const BenchScene&) const override { return 0; }
  bool statesCovariance() const override { return true; }
  MethodRun run(const BenchScene&, const std::vector<RenderedFrame>&) override { return {}; }
};

/// One instrument at 10,000 px/m whose truth is at 0.
struct Bed {
  BenchScene scene;
  std::vector<RenderedFrame> frames;
  MethodRun run;

  Bed() {
    scene.scene.instruments.resize(1);
    scene.scene.instruments[0].nominal.axis.pixels_per_metre = 1e4;
  }
  void add(double visible, bool found, double along = 0, double variance = 1) {
    RenderedFrame frame;
    frame.truth.resize(1);
    frame.truth[0].visible = visible;
    frames.push_back(frame);
    Estimate estimate;
    estimate.found = found;
    estimate.along = along;
    estimate.covariance(0, 0) = variance;
    run.estimates.push_back(estimate);
  }
  Score score(const std::vector<MarkerBound>& bounds = {}) const {
    const FakeMethod method;
    Scorer scorer(method, ScoreLimits());
    scorer.add(scene, frames, run, bounds);
    return scorer.score();
  }
};

TEST(Score, SeparatesPrecisionFromWrongReports) {
  Bed bed;
  bed.add(1, true, 0.3);
  bed.add(1, true, -0.1);
  bed.add(1, true, 80);  // 8 mm
  bed.add(1, false);
  const Score score = bed.score();
  EXPECT_DOUBLE_EQ(score.rms, std::sqrt((0.09 + 0.01) / 2));
  EXPECT_NEAR(score.bias, 0.1, 1e-12);
  EXPECT_EQ(score.visible, 4);
  EXPECT_EQ(score.tracked, 2);
  EXPECT_EQ(score.wrong, 1);
  EXPECT_EQ(score.reports, 3);
}

TEST(Score, CountsReportsOfHiddenMarkersAsPhantoms) {
  Bed bed;
  bed.add(0.1, true);
  bed.add(0.2, false);
  bed.add(0.4, true);
  const Score score = bed.score();
  EXPECT_EQ(score.hidden, 2);
  EXPECT_EQ(score.phantom, 1);
  EXPECT_EQ(score.visible, 0);
}

TEST(Score, ComparesWithTheBound) {
  Bed bed;
  bed.add(1, true, 0.02);
  EXPECT_NEAR(bed.score({{0.01, 0}}).boundRatio(), 2, 1e-12);
  EXPECT_TRUE(std::isnan(bed.score().boundRatio()));
}

TEST(Score, JudgesTheCovariance) {
  Bed honest, proud, modest;
  for (int i = 0; i < 200; ++i) {
    const double error = (i % 2 == 0 ? 1 : -1) * 0.5;
    honest.add(1, true, error, 0.25);
    proud.add(1, true, error, 0.1);
    modest.add(1, true, error, 0.6);
  }
  EXPECT_TRUE(honest.score().consistent());
  EXPECT_FALSE(proud.score().consistent());
  EXPECT_GT(proud.score().nees, proud.score().nees_high);
  EXPECT_FALSE(modest.score().consistent());
  EXPECT_LT(modest.score().nees, modest.score().nees_low);
}

}  // namespace
}  // namespace vibe::vision::evidence::score_test

// What the endoscope shows inside of a straight organ: properties of pictures, not pictures. Needs no display.
#include <OgreSceneManager.h>
#include <OgreSceneNode.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "vibe_graphics/graphics/offscreen_camera.hpp"
#include "vibe_graphics/graphics/tissue_visual.hpp"
#include "vibe_graphics/testing/graphics_scene.hpp"
#include "vibe_graphics/testing/tube_organ.hpp"

namespace vibe::graphics::mucosa_view_test {
namespace {

using test::Pixels;
constexpr int kSize = 200;  // [px]

class MucosaViewTest : public ::testing::Test {
 protected:
  void SetUp() override {
    RoundCamera round;
    round.width = round.height = kSize;
    camera_ = std::make_unique<OffscreenCamera>(test::graphicsScene(), round, 1);
    tissue_ = std::make_unique<TissueVisual>(*test::graphicsScene().getRootSceneNode());
  }
  void TearDown() override { tissue_.reset(), camera_.reset(); }

  void show(const test::TubeOrgan& organ, const std::vector<float>& places) {
    tissue_->setMesh(organ.mesh());
    TissueFrame frame;
    frame.revision = 1;
    frame.positions = places;
    tissue_->setFrame(frame);
  }

  /// Looks along the tube, or across it at its wall, from its middle.
  static Eigen::Isometry3d along() {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear() << 0, 0, 1, 1, 0, 0, 0, 1, 0;
    return pose;
  }
  static Eigen::Isometry3d across(double distance, const test::TubeOrgan& organ = {}) {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translate(Eigen::Vector3d(0, 0, organ.radius - distance));  // z of the camera is z of the organ
    return pose;
  }

  Pixels picture(const Eigen::Isometry3d& pose) {
    Pixels pixels;
    camera_->take(pose, time_ += 1, pixels);
    return pixels;
  }

  Pixels fixed(const Eigen::Isometry3d& pose) {
    Pixels pixels;
    camera_->take(pose, pixels);
    return pixels;
  }

  static double mean(const Pixels& pixels, int channel, double share = 0.9) {
    double sum = 0, count = 0;
    for (int y = 0; y < kSize; ++y)
      for (int x = 0; x < kSize; ++x) {
        if (std::hypot(x + 0.5 - kSize / 2, y + 0.5 - kSize / 2) > share * kSize / 2) continue;
        sum += pixels[static_cast<std::size_t>(3 * (y * kSize + x) + channel)], ++count;
      }
    return sum / count;
  }

  /// Root mean square difference of green to its mean on a circle of 60 % of the radius, which crosses the folds.
  static double contrast(const Pixels& pixels) {
    double sum = 0, squares = 0;
    constexpr int kPoints = 720;
    for (int k = 0; k < kPoints; ++k) {
      const double angle = 2 * 3.14159265358979 * k / kPoints, r = 0.3 * kSize;
      const int x = static_cast<int>(kSize / 2 + r * std::cos(angle)),
                y = static_cast<int>(kSize / 2 + r * std::sin(angle));
      const double level = pixels[static_cast<std::size_t>(3 * (y * kSize + x) + 1)];
      sum += level, squares += level * level;
    }
    const double mean = sum / kPoints;
    return std::sqrt(squares / kPoints - mean * mean) / mean;
  }

  static double difference(const Pixels& a, const Pixels& b) {
    double sum = 0;
    for (std::size_t k = 0; k < a.size(); ++k) sum += std::abs(int{a[k]} - int{b[k]});
    return sum / static_cast<double>(a.size());
  }

  std::unique_ptr<OffscreenCamera> camera_;
  std::unique_ptr<TissueVisual> tissue_;
  double time_ = 0;
};

TEST_F(MucosaViewTest, FoldsLoseTheirContrastAsTheOrganIsFilled) {
  const test::TubeOrgan organ;
  double before = 1;
  for (const double wider : {1.0, 1.05, 1.09, 1.15}) {
    show(organ, organ.places(wider));
    const double now = contrast(picture(along()));
    std::printf("%.0f %% wider: contrast %.3f\n", 100 * (wider - 1), now);
    EXPECT_LT(now, 0.95 * before) << wider;
    before = now;
  }
  show(organ, organ.places());
  EXPECT_GT(contrast(picture(along())), 2 * before);  // and they come back
  test::TubeOrgan antrum;
  antrum.region = 3;
  show(antrum, antrum.places());
  EXPECT_LT(contrast(picture(along())), 1.5 * before);  // control: a region without folds
}

TEST_F(MucosaViewTest, NearFoldsHaveNoSpeckles) {
  const test::TubeOrgan organ;
  show(organ, organ.places(0.9));
  Eigen::Isometry3d pose = across(0.008);
  pose.rotate(Eigen::AngleAxisd(0.6, Eigen::Vector3d::UnitY()));  // at a slant, as a wall beside the tip is seen
  const Pixels pixels = picture(pose);
  const auto level = [&](int x, int y) { return int{pixels[static_cast<std::size_t>(3 * (y * kSize + x) + 1)]}; };
  int dots = 0;
  for (int y = kSize / 4; y < 3 * kSize / 4; ++y)
    for (int x = kSize / 4; x < 3 * kSize / 4; ++x) {
      int darkest = 255;  // of the neighbours
      for (int k = 0; k < 9; ++k)
        if (k != 4) darkest = std::min(darkest, level(x + k % 3 - 1, y + k / 3 - 1));
      dots += level(x, y) < darkest - 8 ? 1 : 0;
    }
  std::printf("%d single dark pixels of %d\n", dots, kSize * kSize / 4);
  EXPECT_LT(dots, kSize * kSize / 4 / 1000);
}

TEST_F(MucosaViewTest, PatternsBelongToTheTissue) {
  const test::TubeOrgan organ;
  show(organ, organ.places(1.03));
  const Pixels still = fixed(across(0.025));
  // tissue and camera moved together: the same picture, although every place is another one
  std::vector<float> moved = organ.places(1.03);
  for (std::size_t k = 0; k < moved.size(); k += 3) moved[k] += 0.017F, moved[k + 1] -= 0.006F;
  show(organ, moved);
  Eigen::Isometry3d pose = across(0.025);
  pose.pretranslate(Eigen::Vector3d(0.017, -0.006, 0));
  const double together = difference(fixed(pose), still);
  pose.pretranslate(Eigen::Vector3d(0.00015, 0, 0));  // control: as far as half a pixel is wide at the middle
  const double half_pixel = difference(fixed(pose), still);
  const double alone = difference(fixed(across(0.025)), still);  // control: only the tissue has moved
  std::printf("moved together %.2f, half a pixel %.2f, tissue alone %.2f levels\n", together, half_pixel, alone);
  EXPECT_LT(together, 0.2 * half_pixel);
  EXPECT_GT(alone, 5 * together);
}

TEST_F(MucosaViewTest, ExposureBringsThePictureToItsLevelFromNearAndFar) {
  const test::TubeOrgan organ;
  show(organ, organ.places(1.15));
  const auto level = [this](const Pixels& pixels) {
    return (0.299 * mean(pixels, 0) + 0.587 * mean(pixels, 1) + 0.114 * mean(pixels, 2)) / 255;
  };
  double constant[2], automatic[2];
  int k = 0;
  for (const double distance : {0.01, 0.06}) {
    constant[k] = level(fixed(across(distance)));
    automatic[k++] = level(picture(across(distance)));
  }
  std::printf("level near %.2f, far %.2f; with a fixed exposure %.2f, %.2f\n", automatic[0], automatic[1], constant[0],
              constant[1]);
  for (const double value : automatic) EXPECT_NEAR(value, AutoExposure::kTarget, 0.07);  // it weights the centre
  EXPECT_GT(constant[0] - constant[1], 0.2);                                             // control
}

TEST_F(MucosaViewTest, SameStampsGiveTheSamePictures) {
  const test::TubeOrgan organ;
  show(organ, organ.places(1.02));
  const auto run = [&] {
    time_ = 0;
    OffscreenCamera other(test::graphicsScene(), RoundCamera{LensKind::Equidistant, 2.44, kSize, kSize}, 1);
    std::vector<Pixels> pictures;
    for (int k = 0; k < 4; ++k) {
      pictures.emplace_back();
      other.take(across(0.01 + 0.01 * k), 0.05 * k, pictures.back());
    }
    return pictures;
  };
  EXPECT_TRUE(run() == run());
}

TEST_F(MucosaViewTest, NothingIsLeftOutWhereThePlanePicturesMeet) {
  const test::TubeOrgan organ;
  show(organ, organ.places(1.15));
  const Pixels pixels = picture(across(0.035));
  std::vector<double> rings(kSize / 2), counts(kSize / 2);
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      const auto ring = static_cast<std::size_t>(std::hypot(x + 0.5 - kSize / 2, y + 0.5 - kSize / 2));
      if (ring >= rings.size()) continue;
      rings[ring] += pixels[static_cast<std::size_t>(3 * (y * kSize + x) + 1)], ++counts[ring];
    }
  for (std::size_t k = 10; k < rings.size() - 2; ++k)
    EXPECT_NEAR(rings[k] / counts[k], rings[k - 1] / counts[k - 1], 0.1 * rings[k - 1] / counts[k - 1]) << k;
}

TEST_F(MucosaViewTest, AntrumIsPalerThanTheBody) {
  double paleness[2];
  for (const int region : {2, 3}) {
    test::TubeOrgan organ;
    organ.region = static_cast<std::uint8_t>(region);
    show(organ, organ.places(1.15));
    const Pixels pixels = picture(along());
    paleness[region - 2] = mean(pixels, 1) / mean(pixels, 0);
  }
  std::printf("green to red: body %.3f, antrum %.3f\n", paleness[0], paleness[1]);
  EXPECT_GT(paleness[1], 1.05 * paleness[0]);
}

}  // namespace
}  // namespace vibe::graphics::mucosa_view_test

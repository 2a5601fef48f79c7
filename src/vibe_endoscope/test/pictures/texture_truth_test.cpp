// The texture of the mucosa follows the material points of a wall that is stretched, sheared and pulled: the second
// picture, led back by the flow of the truth, is the first one. Needs no display.
#include <OgreSceneNode.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "patch_shift.hpp"
#include "truth/truth_camera.hpp"
#include "vibe_graphics/graphics/offscreen_camera.hpp"
#include "vibe_graphics/graphics/tissue_visual.hpp"
#include "vibe_graphics/testing/graphics_scene.hpp"
#include "vibe_graphics/testing/tube_organ.hpp"

namespace vibe::endoscope::texture_truth_test {
namespace {

using graphics::test::Pixels;
using test::Levels;
constexpr int kSize = 240;                        // [px]
constexpr double kDistance = 0.035;               // of the wall from the lens [m]
constexpr double kRequired = 0.5;                 // [px]
constexpr double kSmooth = 1.25, kFolded = 1.08;  // stretch around the organ without folds, and as at 5 mmHg

/// What is done to a wall at z of the organ; x along it [m].
using Deformation = Eigen::Vector3d (*)(const Eigen::Vector3d&);

Eigen::Vector3d stretched(const Eigen::Vector3d& p) {
  return {1.12 * p.x() + 0.001, p.y(), p.z()};
}
Eigen::Vector3d sheared(const Eigen::Vector3d& p) {
  const double angle = 3 * p.x() + 0.03;  // twisted about the axis of the organ
  return {p.x(), std::cos(angle) * p.y() + std::sin(angle) * p.z(), std::cos(angle) * p.z() - std::sin(angle) * p.y()};
}
Eigen::Vector3d pulled(const Eigen::Vector3d& p) {
  const Eigen::Vector3d way = p - Eigen::Vector3d(0, 0, kSmooth * graphics::test::TubeOrgan().radius);
  const double share = std::exp(-way.squaredNorm() / (0.025 * 0.025));
  return p + share * Eigen::Vector3d(0.006, 0.001, -0.003);
}

std::vector<float> deformed(std::vector<float> places, Deformation deformation) {
  for (std::size_t k = 0; k < places.size(); k += 3) {
    Eigen::Map<Eigen::Vector3f> place(&places[k]);
    place = deformation(place.cast<double>()).cast<float>();
  }
  return places;
}

/// Light that a level stands for, in any unit: the inverse of what media/endoscope.frag does.
double radiance(std::uint8_t level) {
  return -std::log(1 - std::pow(std::clamp(int{level}, 1, 254) / 255.0, 1 / 0.6));
}

/// Green to red: the colour of the wall, whatever light falls on its relief.
double colour(const graphics::test::Pixels& pixels, std::size_t k) {
  return 255 * radiance(pixels[3 * k + 1]) / radiance(pixels[3 * k]);
}

/// Bilinear, not a number outside.
template <class Value>
double between(const Eigen::Vector2d& place, Value value) {
  const double x = std::floor(place.x()), y = std::floor(place.y());
  if (!(x >= 0 && y >= 0 && x + 1 < kSize && y + 1 < kSize)) return std::numeric_limits<double>::quiet_NaN();
  const double u = place.x() - x, v = place.y() - y;
  const auto k = static_cast<std::size_t>(y * kSize + x);
  return (1 - v) * ((1 - u) * value(k) + u * value(k + 1)) +
         v * ((1 - u) * value(k + kSize) + u * value(k + kSize + 1));
}

struct Residual {
  double median = 0, p90 = 0, p95 = 0;  ///< [px]
  double motion = 0;                    ///< median of what the flow tells at the same places [px]
  std::size_t patches = 0;
};

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

class TextureTruthTest : public ::testing::Test {
 protected:
  TextureTruthTest() : camera_(graphics::test::graphicsScene(), round_, 1), eye_(round_, 0.0006, 2) {
    pose_.translate(Eigen::Vector3d(0, 0, kSmooth * organ_.radius - kDistance));
  }

  /// @param mesh  its rest shape is where the patterns are evaluated
  graphics::test::Pixels draw(const graphics::TissueMesh& mesh, const std::vector<float>& places) {
    graphics::TissueVisual tissue(*graphics::test::graphicsScene().getRootSceneNode());
    graphics::TissueLook look;
    look.wetness = 0;  // highlights are images of the light and not of the wall
    tissue.setLook(look);
    tissue.setMesh(mesh);
    tissue.setFrame(frame(places));
    graphics::test::Pixels pixels;
    camera_.take(pose_, pixels);
    return pixels;
  }

  static graphics::TissueFrame frame(const std::vector<float>& places) {
    graphics::TissueFrame frame;
    frame.revision = 1;
    frame.positions = places;
    return frame;
  }

  TruthFlow flow(const std::vector<float>& before, const std::vector<float>& after) const {
    TruthScene scene;
    scene.setMesh(organ_.mesh());
    scene.setFrame(frame(before));
    scene.commit();
    TruthView view;
    eye_.look(scene, pose_, view);
    scene.setFrame(frame(after));
    scene.commit();
    return eye_.flow(view, scene, pose_);
  }

  /// How far the second picture, led back by a share of the flow, is from the first.
  Residual residual(const graphics::test::Pixels& before, const graphics::test::Pixels& after, const TruthFlow& flow,
                    double share = 1) const {
    const auto motionAt = [&](const Eigen::Vector2d& p) {
      return Eigen::Vector2d(between(p, [&](std::size_t k) { return double(flow.motion[2 * k]); }),
                             between(p, [&](std::size_t k) { return double(flow.motion[2 * k + 1]); }));
    };
    Levels first(kSize, kSize), led(kSize, kSize);
    for (int y = 0; y < kSize; ++y)
      for (int x = 0; x < kSize; ++x) {
        const Eigen::Vector2d here(x, y);
        first(y, x) = colour(before, static_cast<std::size_t>(y * kSize + x));
        led(y, x) = between(here + share * motionAt(here), [&](std::size_t k) { return colour(after, k); });
      }
    std::vector<double> shifts, motions;
    for (int y = 0; y < kSize; y += 12)
      for (int x = 0; x < kSize; x += 12) {
        const Eigen::Vector2d middle(x, y);
        if ((middle - round_.middle()).norm() > 0.7 * round_.radius()) continue;
        const auto shift = test::patchShift(first, led, x, y);
        if (shift) shifts.push_back(shift->norm()), motions.push_back(motionAt(middle).norm());
      }
    return {quantile(shifts, 0.5), quantile(shifts, 0.9), quantile(shifts, 0.95), quantile(motions, 0.5),
            shifts.size()};
  }

  static void print(const char* what, const Residual& r) {
    std::printf("%s: moved by %.1f px; residual median %.3f, 90 %% %.3f, 95 %% %.3f px in %zu patches\n", what,
                r.motion, r.median, r.p90, r.p95, r.patches);
  }

  graphics::test::TubeOrgan organ_;
  graphics::RoundCamera round_{graphics::LensKind::Equidistant, 2.443461, kSize, kSize};
  graphics::OffscreenCamera camera_;
  TruthCamera eye_;
  Eigen::Isometry3d pose_ = Eigen::Isometry3d::Identity();
};

const std::pair<const char*, Deformation> kDeformations[] = {
    {"stretched", stretched}, {"sheared", sheared}, {"pulled", pulled}};

TEST_F(TextureTruthTest, FollowsTheMaterialPointsWithinHalfAPixel) {
  for (const double wider : {kSmooth, kFolded})
    for (const auto& [name, deformation] : kDeformations) {
      SCOPED_TRACE(name);
      const std::vector<float> before = organ_.places(wider), after = deformed(before, deformation);
      const graphics::test::Pixels first = draw(organ_.mesh(), before), second = draw(organ_.mesh(), after);
      const TruthFlow motion = flow(before, after);
      const Residual found = residual(first, second, motion), half = residual(first, second, motion, 0.5);
      print(name, found);
      print("  control: half of the flow", half);
      EXPECT_GT(found.patches, 50u);
      EXPECT_GT(found.motion, 2.5) << "there is something to follow";
      EXPECT_LE(found.median, kRequired);
      EXPECT_LE(found.p95, kRequired);
      EXPECT_GT(half.median, 1);
    }
}

// Control of the test above: patterns in coordinates of the world, through which the tissue slides.
TEST_F(TextureTruthTest, PatternsOfTheWorldAreSeenNotToFollow) {
  for (const auto& [name, deformation] : kDeformations) {
    const std::vector<float> before = organ_.places(kSmooth), after = deformed(before, deformation);
    graphics::TissueMesh world_before = organ_.mesh(), world_after = organ_.mesh();
    world_before.rest = before;
    world_after.rest = after;
    const Residual found = residual(draw(world_before, before), draw(world_after, after), flow(before, after));
    print(name, found);
    EXPECT_GT(found.median, 1) << name;
  }
}

// The measure itself, on waves that are shifted by a known way and lit differently.
TEST(PatchShiftTest, FindsAKnownShiftToATenthOfAPixel) {
  const auto waves = [](double x, double y) {
    double sum = 0;
    for (int k = 0; k < 12; ++k)
      sum += 8 * std::sin((0.2 + 0.06 * k) * (std::cos(k * k) * x + std::sin(k * k) * y) + k);
    return sum;
  };
  Levels before(100, 100), now(100, 100);
  for (const Eigen::Vector2d& shift : {Eigen::Vector2d(0, 0), Eigen::Vector2d(0.3, -0.4), Eigen::Vector2d(-3.2, 1.6)}) {
    for (int y = 0; y < 100; ++y)
      for (int x = 0; x < 100; ++x) {
        before(y, x) = 100 + waves(x, y);
        now(y, x) = 60 + 0.5 * x - 0.3 * y + 0.7 * waves(x - shift.x(), y - shift.y());
      }
    const auto found = test::patchShift(before, now, 50, 60);
    ASSERT_TRUE(found.has_value());
    EXPECT_LT((*found - shift).norm(), 0.1);
  }
}

}  // namespace
}  // namespace vibe::endoscope::texture_truth_test

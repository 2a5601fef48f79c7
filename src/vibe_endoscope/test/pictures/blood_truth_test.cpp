// Bleeding in the image of the endoscope and in its truth: the picture is redder where blood has run, and the label
// says blood where the picture has changed. Needs no display.

#include <OgreSceneManager.h>
#include <OgreSceneNode.h>
#include <gtest/gtest.h>

#include "truth/truth_worlds.hpp"
#include "vibe_graphics/geometry/blood_shapes.hpp"
#include "vibe_graphics/graphics/offscreen_camera.hpp"
#include "vibe_graphics/graphics/suture_visual.hpp"
#include "vibe_graphics/graphics/tissue_visual.hpp"
#include "vibe_graphics/testing/graphics_scene.hpp"

namespace vibe::endoscope::blood_truth_test {
namespace {

using Eigen::Vector3d;
using graphics::test::Pixels;

const Vector3d kDown = -Vector3d::UnitZ();  // in the scene, and in the picture

/// Turns gravity, which is along -x of the frame of the sutures, to that of the scene.
Eigen::Isometry3d sutureFrame() {
  return Eigen::Isometry3d(Eigen::Quaterniond::FromTwoVectors(graphics::BloodStyle().down, kDown));
}

/// From one side of the ball to the other, so that its bottom is in view.
Eigen::Isometry3d camera() {
  Eigen::Isometry3d pose = test::eye();
  pose.translation() = Vector3d(-0.032, 0, 0);
  pose.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return pose;
}

/// A wound on the wall ahead, in the frame of the sutures.
graphics::SutureDrawing bleeding(bool brisk, double amount) {
  graphics::Wound wound;
  const Vector3d place = 0.05 * Vector3d(0.95, 0.1, 0.2).normalized();
  wound.place = sutureFrame().inverse() * place;
  wound.inward = -wound.place.normalized();
  wound.brisk = brisk;
  wound.rate = brisk ? 2.5e-7 : 1e-8;
  wound.amount = amount;
  wound.age = amount / wound.rate;
  graphics::SutureDrawing scene;
  scene.wounds = {wound};
  return scene;
}

class BloodTruthTest : public ::testing::Test {
 protected:
  BloodTruthTest() : mesh_(graphics::test::ballMesh(48, 96)) {
    frame_.revision = mesh_.revision;
    for (const float p : mesh_.rest) frame_.positions.push_back(0.05F * p);
  }

  graphics::test::Pixels draw(const graphics::SutureDrawing& sutures) {
    graphics::TissueVisual wall(*graphics::test::graphicsScene().getRootSceneNode());
    wall.setMesh(mesh_);
    wall.setFrame(frame_);
    Ogre::SceneNode& node = *graphics::test::graphicsScene().getRootSceneNode()->createChildSceneNode();
    const Eigen::Quaternionf turn(sutureFrame().linear().cast<float>());
    node.setOrientation(turn.w(), turn.x(), turn.y(), turn.z());
    graphics::test::Pixels pixels;
    {
      graphics::SutureVisual drawn(node);
      graphics::BleedingShape blood;
      blood.setMesh(&mesh_);
      blood.setWounds(sutures, graphics::BloodStyle());
      blood.update(wall.vertices(), sutureFrame().inverse());
      drawn.showBlood(blood.shape());
      graphics::OffscreenCamera eye(graphics::test::graphicsScene(), round_, 1);
      eye.take(camera(), pixels);
    }
    graphics::test::graphicsScene().destroySceneNode(&node);
    return pixels;
  }

  std::vector<std::uint8_t> labels(const graphics::SutureDrawing& sutures) const {
    TruthScene truth;
    truth.setMesh(mesh_);
    truth.setFrame(frame_);
    truth.setSutures(sutures, 0, sutureFrame());
    truth.commit();
    const TruthCamera eye(round_, test::kNear, test::kFar);
    TruthView view;
    eye.look(truth, camera(), view);
    return eye.labels(truth, view);
  }

  /// Green to red over some pixels.
  static double green(const graphics::test::Pixels& pixels, const std::vector<std::uint8_t>& labels) {
    double red = 0, sum = 0;
    for (std::size_t k = 0; k < labels.size(); ++k)
      if (labels[k] == kLabelBlood) red += pixels[3 * k], sum += pixels[3 * k + 1];
    return sum / red;
  }

  struct Agreement {
    double changed_of_blood = 0, blood_of_changed = 0;
  };
  /// Where the picture has changed and where the label is blood, `shift` pixels to the right of it.
  Agreement compare(const graphics::test::Pixels& before, const graphics::test::Pixels& after,
                    const std::vector<std::uint8_t>& labels, int shift = 0) const {
    double blood = 0, changed = 0, both = 0;
    for (int y = 0; y < round_.height; ++y)
      for (int x = 0; x + shift < round_.width; ++x) {
        const auto k = static_cast<std::size_t>(y * round_.width + x);
        int difference = 0;
        for (std::size_t c = 0; c < 3; ++c) difference += std::abs(int{before[3 * k + c]} - int{after[3 * k + c]});
        const bool is_changed = difference > 60, is_blood = labels[k + static_cast<std::size_t>(shift)] == kLabelBlood;
        changed += is_changed, blood += is_blood, both += is_changed && is_blood;
      }
    return {both / blood, both / changed};
  }

  graphics::RoundCamera round_ = test::smallCamera(graphics::LensKind::Equidistant, 320, 320);
  graphics::TissueMesh mesh_;
  graphics::TissueFrame frame_;
};

TEST_F(BloodTruthTest, PictureIsRedderWhereBloodHasRunAndTheLabelSaysSo) {
  for (const bool brisk : {false, true}) {
    const graphics::SutureDrawing wound = bleeding(brisk, brisk ? 3e-6 : 5e-7);
    const graphics::test::Pixels before = draw({}), after = draw(wound);
    const std::vector<std::uint8_t> seen = labels(wound);
    const auto pixels = std::count(seen.begin(), seen.end(), kLabelBlood);
    const double healthy = green(before, seen), bloody = green(after, seen);
    const Agreement found = compare(before, after, seen), control = compare(before, after, seen, 10);
    std::printf(
        "%s: %ld pixels; green to red %.2f, before %.2f; %.1f %% of the label changed, %.1f %% of the change "
        "labelled; shifted by 10 px %.1f %%, %.1f %%\n",
        brisk ? "brisk" : "mild", pixels, bloody, healthy, 100 * found.changed_of_blood, 100 * found.blood_of_changed,
        100 * control.changed_of_blood, 100 * control.blood_of_changed);
    EXPECT_GT(pixels, 500);
    EXPECT_LT(bloody, 0.6 * healthy);
    EXPECT_GT(found.changed_of_blood, 0.97);
    EXPECT_GT(found.blood_of_changed, 0.85);
    EXPECT_LT(control.changed_of_blood, 0.9);
    EXPECT_LT(control.blood_of_changed, 0.85);
  }
}

/// Blood is below its wound in the picture, as far as to the pool.
TEST_F(BloodTruthTest, BloodRunsDownInThePicture) {
  const std::vector<std::uint8_t> none = labels({}), seen = labels(bleeding(false, 5e-7));
  EXPECT_EQ(std::count(none.begin(), none.end(), kLabelBlood), 0);
  int first = round_.height, last = 0;
  for (int y = 0; y < round_.height; ++y)
    for (int x = 0; x < round_.width; ++x)
      if (seen[static_cast<std::size_t>(y * round_.width + x)] == kLabelBlood)
        first = std::min(first, y), last = std::max(last, y);
  EXPECT_GT(first, round_.height / 4);
  EXPECT_LT(first, round_.height / 2);
  EXPECT_GT(last, round_.height * 4 / 5);
}

}  // namespace
}  // namespace vibe::endoscope::blood_truth_test

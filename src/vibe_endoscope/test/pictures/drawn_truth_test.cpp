// The image that is drawn and the truth that is cast show the same geometry: silhouettes of bodies on black, and of a
// body before the wall, in the pixels of both. Needs no display.

#include <OgreSceneManager.h>
#include <OgreSceneNode.h>
#include <OgreTechnique.h>
#include <gtest/gtest.h>

#include "truth/truth_worlds.hpp"
#include "vibe_graphics/graphics/offscreen_camera.hpp"
#include "vibe_graphics/graphics/shape_visual.hpp"
#include "vibe_graphics/graphics/tissue_visual.hpp"
#include "vibe_graphics/testing/graphics_scene.hpp"

namespace vibe::endoscope::drawn_truth_test {
namespace {

using graphics::test::Pixels;

/// A body that shines by itself, so that every pixel of it is bright.
Ogre::MaterialPtr shining() {
  Ogre::MaterialPtr material = graphics::copyMaterial("vibe/solid");
  for (Ogre::Technique* technique : material->getTechniques())
    technique->getPass(0)->getFragmentProgramParameters()->setNamedConstant("glow", 1.0F);
  return material;
}

graphics::ColouredShape placed(graphics::ColouredShape shape, const Eigen::Isometry3d& pose,
                               graphics::PackedColour colour) {
  for (graphics::MovingVertex& vertex : shape.vertices) {
    Eigen::Map<Eigen::Vector3f> place(vertex.position);
    place = (pose * Eigen::Vector3d(place.cast<double>())).cast<float>();
  }
  std::fill(shape.colours.begin(), shape.colours.end(), colour);
  return shape;
}

struct Comparison {
  int pixels = 0;     ///< of the body in the truth
  int different = 0;  ///< drawn and cast disagree
  int beyond = 0;     ///< and the truth has no silhouette within one pixel
};

/// @param drawn  whether a pixel shows the body in the drawn image
Comparison compare(const std::vector<std::uint8_t>& labels, const std::vector<bool>& drawn,
                   const graphics::RoundCamera& round, int shift = 0) {
  Comparison result;
  const auto isBody = [&](int x, int y) {
    return labels[static_cast<std::size_t>(y * round.width + x)] >= kLabelInstrument;
  };
  for (int y = 1; y + 1 < round.height; ++y)
    for (int x = 1; x + 1 + shift < round.width; ++x) {
      const bool body = isBody(x, y);
      result.pixels += body;
      if (drawn[static_cast<std::size_t>(y * round.width + x + shift)] == body) continue;
      ++result.different;
      bool silhouette = false;
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) silhouette = silhouette || isBody(x + dx, y + dy) != body;
      result.beyond += silhouette ? 0 : 1;
    }
  return result;
}

class DrawnTruthTest : public ::testing::TestWithParam<graphics::LensKind> {
 protected:
  static void SetUpTestSuite() { graphics::test::graphicsScene(); }  // before any material is made

  graphics::test::Pixels draw() const {
    graphics::OffscreenCamera camera(graphics::test::graphicsScene(), round_, 1);
    graphics::test::Pixels pixels;
    camera.take(test::eye(), pixels);
    return pixels;
  }
  std::vector<std::uint8_t> labels(const TruthScene& scene) const {
    const TruthCamera camera(round_, test::kNear, test::kFar);
    TruthView view;
    camera.look(scene, test::eye(), view);
    return camera.labels(scene, view);
  }

  graphics::RoundCamera round_ = test::smallCamera(GetParam(), 320, 240);
};

TEST_P(DrawnTruthTest, SilhouettesOfBodiesAgreeWithinOnePixel) {
  graphics::ShapeView rod(*graphics::test::graphicsScene().getRootSceneNode(), shining()),
      box(*graphics::test::graphicsScene().getRootSceneNode(), shining());
  rod.show(placed(test::rodShape(), test::rodPose(0), graphics::packed(1, 1, 1)));
  box.show(placed(test::boxShape(), test::boxPose(0), graphics::packed(1, 1, 1)));
  TruthScene truth;
  truth.placePart(truth.addPart("rod", test::rodShape()), test::rodPose(0));
  truth.placePart(truth.addPart("box", test::boxShape()), test::boxPose(0));
  truth.commit();
  const graphics::test::Pixels pixels = draw();
  std::vector<bool> drawn;
  for (std::size_t k = 0; k < pixels.size(); k += 3) drawn.push_back(pixels[k] > 127);
  const std::vector<std::uint8_t> cast = labels(truth);
  const Comparison found = compare(cast, drawn, round_), control = compare(cast, drawn, round_, 3);
  std::printf("%d pixels, %d different, %d beyond one pixel; shifted by 3 px: %d\n", found.pixels, found.different,
              found.beyond, control.beyond);
  EXPECT_GT(found.pixels, 1000);
  EXPECT_LT(found.different, found.pixels / 25);
  EXPECT_EQ(found.beyond, 0);
  EXPECT_GT(control.beyond, 50);
}

TEST_P(DrawnTruthTest, BodyBehindTheFoldsOfTheWallIsHiddenInBoth) {
  test::FoldedWorld world(40, 80, false);
  world.show(0.3);
  graphics::ColouredShape ball;
  graphics::appendSphere(Eigen::Isometry3d::Identity(), 0.014, graphics::packed(1, 1, 1), ball);
  const Eigen::Isometry3d place(Eigen::Translation3d(0.036, 0.014, 0.006));  // half of it is outside of the organ
  world.scene.placePart(world.scene.addPart("ball", ball), place);
  world.scene.commit();
  graphics::TissueVisual wall(*graphics::test::graphicsScene().getRootSceneNode());
  wall.setMesh(world.mesh());
  wall.setFrame(world.frame);
  graphics::ShapeView shown(*graphics::test::graphicsScene().getRootSceneNode(), shining());
  shown.show(placed(ball, place, graphics::packed(0, 0, 1)));
  const graphics::test::Pixels pixels = draw();
  std::vector<bool> drawn;  // blue against red
  for (std::size_t k = 0; k < pixels.size(); k += 3) drawn.push_back(pixels[k + 2] > pixels[k] + 20);
  const std::vector<std::uint8_t> cast = labels(world.scene);
  const Comparison found = compare(cast, drawn, round_), control = compare(cast, drawn, round_, 3);
  std::printf("%d pixels, %d different, %d beyond one pixel; shifted by 3 px: %d\n", found.pixels, found.different,
              found.beyond, control.beyond);
  EXPECT_GT(found.pixels, 500);
  EXPECT_EQ(found.beyond, 0);
  EXPECT_GT(control.beyond, 50);
}

INSTANTIATE_TEST_SUITE_P(Lenses, DrawnTruthTest,
                         ::testing::Values(graphics::LensKind::Equidistant, graphics::LensKind::Rectilinear),
                         test::lensName);

}  // namespace
}  // namespace vibe::endoscope::drawn_truth_test

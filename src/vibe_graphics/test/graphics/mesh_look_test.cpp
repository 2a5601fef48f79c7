// Meshes of a robot under the light of the endoscope. Needs no display.

#include "vibe_graphics/graphics/resources.hpp"

#include <OgreEntity.h>
#include <OgreMaterialManager.h>
#include <OgreSceneManager.h>
#include <OgreSceneNode.h>
#include <OgreSubEntity.h>
#include <OgreTechnique.h>
#include <gtest/gtest.h>
#include <rviz/mesh_loader.h>

#include "vibe_graphics/graphics/offscreen_camera.hpp"
#include "vibe_graphics/testing/graphics_scene.hpp"

namespace vibe::graphics::mesh_look_test {
namespace {

const char* const kCap = "package://vibe_description/meshes/cap.obj";
constexpr int kSize = 120;

/// The cap of the suturing device 40 mm before a camera, which looks at its face.
class MeshLookTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    scene_ = &test::graphicsScene();
    const Ogre::MeshPtr mesh = rviz::loadMeshFromResource(kCap);
    ASSERT_TRUE(mesh);
    cap_ = scene_->createEntity(mesh);
    scene_->getRootSceneNode()->createChildSceneNode()->attachObject(cap_);
  }

  static std::vector<std::uint8_t> picture() {
    const RoundCamera round{LensKind::Rectilinear, 0.6, kSize, kSize};
    OffscreenCamera camera(*scene_, round, 1);
    Eigen::Isometry3d pose(Eigen::Translation3d(0.04, 0, 0));
    Eigen::Matrix3d turn;  // z against x, x along y, y down
    turn << 0, 0, -1, 1, 0, 0, 0, -1, 0;
    pose.linear() = turn;
    std::vector<std::uint8_t> pixels;
    camera.take(pose, pixels);
    return pixels;
  }

  /// The technique of the endoscope's scheme, null without one.
  static Ogre::Technique* techniqueOf(Ogre::Material& material) {
    for (Ogre::Technique* technique : material.getTechniques())
      if (technique->getSchemeName() == kEndoscopeScheme) return technique;
    return nullptr;
  }

  /// Mean of all pixels that are not black.
  static double brightness(const std::vector<std::uint8_t>& pixels) {
    double sum = 0, count = 0;
    for (const std::uint8_t value : pixels)
      if (value > 0) sum += value, ++count;
    return count > 0 ? sum / count : 0;
  }

  static inline Ogre::SceneManager* scene_ = nullptr;
  static inline Ogre::Entity* cap_ = nullptr;
};

TEST_F(MeshLookTest, MeshesGetTheLookWithTheColoursOfTheirFile) {
  const std::vector<std::uint8_t> pixels = picture();
  EXPECT_GT(brightness(pixels), 30);
  std::size_t metals = 0;
  for (Ogre::SubEntity* part : cap_->getSubEntities()) {
    Ogre::Material& material = *part->getMaterial();
    Ogre::Technique* technique = techniqueOf(material);
    ASSERT_NE(technique, nullptr) << material.getName();
    EXPECT_TRUE(technique->isSupported()) << material.getUnsupportedTechniquesExplanation();
    const auto& uniforms = *technique->getPass(0)->getFragmentProgramParameters();
    const float* shine = uniforms.getFloatPointer(uniforms.getConstantDefinition("shine").physicalIndex);
    EXPECT_NEAR(*shine, material.getTechnique(0)->getPass(0)->getSpecular().r, 1e-6);
    metals += *shine > 0.7F ? 1 : 0;
  }
  EXPECT_GE(metals, 1u) << "the ring of the cap is of steel";
}

TEST_F(MeshLookTest, PictureFollowsTheColour) {
  const double before = brightness(picture());
  for (Ogre::SubEntity* part : cap_->getSubEntities()) {
    auto& uniforms = *techniqueOf(*part->getMaterial())->getPass(0)->getFragmentProgramParameters();
    uniforms.setNamedConstant("colour", Ogre::Vector3(0.0F));
    uniforms.setNamedConstant("shine", 0.0F);
  }
  EXPECT_LT(brightness(picture()), 0.5 * before) << "control: black and dull parts are dark";
}

TEST_F(MeshLookTest, OtherMaterialsStayAsTheyAre) {
  auto& materials = Ogre::MaterialManager::getSingleton();
  const Ogre::MaterialPtr plain = materials.create("plain", kResourceGroup);
  plain->load();
  Ogre::Entity* ball = scene_->createEntity(Ogre::SceneManager::PT_SPHERE);
  ball->setMaterial(plain);
  Ogre::SceneNode* node = scene_->getRootSceneNode()->createChildSceneNode();
  node->setScale(1e-4F, 1e-4F, 1e-4F);
  node->attachObject(ball);
  picture();
  EXPECT_EQ(techniqueOf(*plain), nullptr);
  EXPECT_EQ(plain->getNumTechniques(), 1u);
  scene_->destroyEntity(ball);
}

}  // namespace
}  // namespace vibe::graphics::mesh_look_test

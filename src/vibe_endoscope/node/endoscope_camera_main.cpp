// endoscope_camera: what the endoscope sees, as images, without rviz and without a screen.

#include <OgreRoot.h>
#include <OgreSceneManager.h>
#include <ros/ros.h>
#include <rviz/ogre_helpers/render_system.h>

#include <cstdio>
#include <exception>

#include "camera_options.hpp"
#include "endoscope_camera.hpp"
#include "vibe_graphics/graphics/resources.hpp"
#include "vibe_graphics/graphics/virtual_display.hpp"
#include "vibe_ros_utils/startup.hpp"

namespace endoscope = vibe::endoscope;
namespace graphics = vibe::graphics;

namespace {

constexpr int kFailure = 1;
constexpr int kUsage = 2;
constexpr double kMasterPatience = 10;  // [s]

int fail(const std::exception& error, int status) {
  std::fprintf(stderr, "endoscope_camera: %s\n", error.what());
  return status;
}

void run(const endoscope::CameraOptions& options) {
  graphics::provideDisplay();
  rviz::RenderSystem::forceNoStereo();
  Ogre::SceneManager* scene = rviz::RenderSystem::get()->root()->createSceneManager();
  graphics::loadResources();
  ros::NodeHandle node;
  std::string description;
  node.getParam("robot_description", description);
  endoscope::EndoscopeCamera camera(node, options, *scene, description);
  ros::spin();
}

}  // namespace

int main(int argc, char** argv) {
  endoscope::CameraOptions options;
  try {
    vibe::ros_utils::init(argc, argv, "endoscope_camera");
    vibe::ros_utils::waitForMaster(kMasterPatience);
    options = endoscope::readCameraOptions(ros::NodeHandle("~"));
  } catch (const std::exception& error) {
    return fail(error, kUsage);
  }
  try {
    run(options);
  } catch (const std::exception& error) {
    return fail(error, kFailure);
  }
  return 0;
}

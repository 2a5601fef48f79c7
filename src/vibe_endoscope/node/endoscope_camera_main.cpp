// endoscope_camera: what the endoscope sees, as images, without rviz and without a screen.

#include <OgreRoot.h>
#include <OgreSceneManager.h>
#include <ros/ros.h>
#include <rviz/ogre_helpers/render_system.h>

#include <cstdio>
#include <exception>

#include "camera_options.hpp"
#include "endoscope_camera.hpp"
#include "vibe_render/graphics/resources.hpp"
#include "vibe_render/graphics/virtual_display.hpp"

namespace rviz_plugins = vibe::endoscope;

namespace {

constexpr int kFailure = 1;
constexpr int kUsage = 2;

int fail(const std::exception& error, int status) {
  std::fprintf(stderr, "endoscope_camera: %s\n", error.what());
  return status;
}

void run(const rviz_plugins::CameraOptions& options) {
  rviz_plugins::provideDisplay();
  rviz::RenderSystem::forceNoStereo();
  Ogre::SceneManager* scene = rviz::RenderSystem::get()->root()->createSceneManager();
  rviz_plugins::loadResources();
  ros::NodeHandle node;
  std::string description;
  node.getParam("robot_description", description);
  rviz_plugins::EndoscopeCamera camera(node, options, *scene, description);
  ros::spin();
}

}  // namespace

int main(int argc, char** argv) {
  ros::init(argc, argv, "endoscope_camera");
  rviz_plugins::CameraOptions options;
  try {
    options = rviz_plugins::readCameraOptions(ros::NodeHandle("~"));
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

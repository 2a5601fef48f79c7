#pragma once
#include <OgreQuaternion.h>
#include <OgreVector3.h>
#include <ros/time.h>

#include <string>

namespace rviz {
class DisplayContext;
}

namespace vibe::rviz_plugins {

/// Pose of a frame in the fixed frame of rviz.
struct FramePose {
  Ogre::Vector3 position = Ogre::Vector3::ZERO;  ///< [m]
  Ogre::Quaternion orientation = Ogre::Quaternion::IDENTITY;
};

/// Looks up where a frame is.
/// @param stamp  time of the pose; if nothing is known for it, and for time 0, the latest pose is used
/// @return empty, and the pose is set; otherwise one sentence that says what is missing
std::string lookUpFrame(rviz::DisplayContext& context, const std::string& frame, const ros::Time& stamp,
                        FramePose& pose);

}  // namespace vibe::rviz_plugins

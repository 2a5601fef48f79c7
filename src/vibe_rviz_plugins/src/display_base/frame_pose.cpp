#include "vibe_rviz_plugins/display_base/frame_pose.hpp"

#include <rviz/display_context.h>
#include <rviz/frame_manager.h>

namespace vibe::rviz_plugins {

std::string lookUpFrame(rviz::DisplayContext& context, const std::string& frame, const ros::Time& stamp,
                        FramePose& pose) {
  rviz::FrameManager& frames = *context.getFrameManager();
  if (!stamp.isZero() && frames.getTransform(frame, stamp, pose.position, pose.orientation)) return "";
  if (frames.getTransform(frame, ros::Time(), pose.position, pose.orientation)) return "";
  return "No transform from '" + frame + "' to '" + context.getFixedFrame().toStdString() +
         "'; choose another fixed frame or publish this transform.";
}

}  // namespace vibe::rviz_plugins

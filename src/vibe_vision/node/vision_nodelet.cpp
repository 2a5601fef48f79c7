// The vision node as a nodelet: images of a camera nodelet in the same manager are shared, not copied.

#include <nodelet/nodelet.h>

#include <memory>
#include <pluginlib/class_list_macros.hpp>

#include "vision_node.hpp"

namespace vibe::vision {

class VisionNodelet : public nodelet::Nodelet {
 private:
  std::unique_ptr<VisionNode> node_;

  void onInit() override {
    try {
      const VisionParameters parameters = readVisionParameters(getPrivateNodeHandle());
      node_ = std::make_unique<VisionNode>(getNodeHandle(), getPrivateNodeHandle(), getName(), parameters);
    } catch (const std::exception& error) {
      NODELET_FATAL_STREAM(error.what());
      throw;  // the manager reports that it was not loaded
    }
  }
};

}  // namespace vibe::vision

PLUGINLIB_EXPORT_CLASS(vibe::vision::VisionNodelet, nodelet::Nodelet)

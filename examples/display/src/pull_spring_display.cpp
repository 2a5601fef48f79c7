// A display of tissue/pull_state: the spring from the held patch of tissue to its target. It has no header, because
// only pluginlib makes objects of this class.

// [recipe]
#include <rviz/properties/float_property.h>
#include <vibe_msgs/TissuePullState.h>

#include <pluginlib/class_list_macros.hpp>
#include <vibe_graphics/geometry/tube.hpp>
#include <vibe_rviz_plugins/display_base/message_shape_display.hpp>

namespace vibe_example {

using namespace vibe::graphics;
using namespace vibe::rviz_plugins;

class PullSpringDisplay : public MessageShapeDisplay<vibe_msgs::TissuePullState> {
 public:
  PullSpringDisplay() : MessageShapeDisplay("tissue/pull_state") {
    diameter_ = new rviz::FloatProperty("Diameter", 0.002F, "Diameter of the spring in metres.", this, SLOT(redraw()));
    diameter_->setMin(1e-4F);
  }

  std::string makeShape(const vibe_msgs::TissuePullState& message, ColouredShape& shape) const override {
    if (message.particle < 0) return "";  // released: nothing to draw
    const Eigen::Vector3d from(message.position.x, message.position.y, message.position.z);
    const Eigen::Vector3d to(message.target.x, message.target.y, message.target.z);
    if (!from.allFinite() || !to.allFinite()) return "The position or the target of the pull spring is not finite.";
    appendTube({from, to}, 0.5 * diameter_->getFloat(), packed(1, 0.8, 0.2), 24, shape);
    return "";
  }

 private:
  rviz::FloatProperty* diameter_;
};

}  // namespace vibe_example

PLUGINLIB_EXPORT_CLASS(vibe_example::PullSpringDisplay, rviz::Display)
// [/recipe]

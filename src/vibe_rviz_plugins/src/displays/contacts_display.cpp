#include <rviz/properties/float_property.h>
#include <vibe_msgs/ToolContacts.h>

#include <pluginlib/class_list_macros.hpp>

#include "vibe_graphics/geometry/solid_bodies.hpp"
#include "vibe_rviz_plugins/display_base/message_shape_display.hpp"

namespace vibe::rviz_plugins {
namespace {

constexpr graphics::PackedColour kContact = graphics::packed(1, 0.8, 0.2), kGrip = graphics::packed(0.9, 0.3, 0.8);
constexpr int kSides = 16;

Eigen::Vector3d vectorOf(const geometry_msgs::Vector3& v) {
  return {v.x, v.y, v.z};
}

void appendArrow(const Eigen::Vector3d& from, const Eigen::Vector3d& way, double radius, graphics::PackedColour colour,
                 graphics::ColouredShape& shape) {
  const double length = way.norm(), neck = length - std::min(6 * radius, 0.5 * length);
  graphics::appendRevolved({{length, 0}, {neck, 2 * radius}, {neck, radius}, {0, radius}, {0, 0}}, from, way / length,
                           colour, kSides, shape);
}

}  // namespace

/// The forces of the tissue on the tool, an arrow for each contact and each claw of the grip.
class ContactsDisplay : public MessageShapeDisplay<vibe_msgs::ToolContacts> {
 public:
  ContactsDisplay() : MessageShapeDisplay("scope/contacts") {
    scale_ = new rviz::FloatProperty("Scale", 0.05F, "Length of the arrow of a force in metres per newton.", this,
                                     SLOT(redraw()));
    scale_->setMin(1e-4F);
    diameter_ = new rviz::FloatProperty("Diameter", 6e-4F, "Diameter of the arrows in metres.", this, SLOT(redraw()));
    diameter_->setMin(1e-5F);
  }

  std::string makeShape(const vibe_msgs::ToolContacts& message, graphics::ColouredShape& shape) const override {
    for (const vibe_msgs::ToolContact& contact : message.contacts) {
      const Eigen::Vector3d from(contact.position.x, contact.position.y, contact.position.z);
      const Eigen::Vector3d way = static_cast<double>(scale_->getFloat()) * vectorOf(contact.force);
      if (!from.allFinite() || !way.allFinite()) return "A position or force of the contacts is not finite.";
      if (way.isZero(0)) continue;
      appendArrow(from, way, 0.5 * diameter_->getFloat(),
                  contact.kind == vibe_msgs::ToolContact::GRIP ? kGrip : kContact, shape);
    }
    return "";
  }

 private:
  rviz::FloatProperty* scale_;
  rviz::FloatProperty* diameter_;
};

}  // namespace vibe::rviz_plugins

PLUGINLIB_EXPORT_CLASS(vibe::rviz_plugins::ContactsDisplay, rviz::Display)

#include "conversions/contact_message.hpp"

#include "conversions/conversions.hpp"

namespace vibe::sim {

namespace {

// The numbers on the wire are those of the library.
static_assert(same(ToolContact::Kind::Contact, vibe_msgs::ToolContact::CONTACT) &&
              same(ToolContact::Kind::Grip, vibe_msgs::ToolContact::GRIP));

vibe_msgs::ToolContact makeToolContact(const ToolModel& tool, const ToolContact& contact) {
  vibe_msgs::ToolContact message;
  message.kind = static_cast<std::uint8_t>(contact.kind);
  message.position = toMessage<geometry_msgs::Point>(contact.point);
  message.normal = toMessage<geometry_msgs::Vector3>(contact.normal);
  message.gap = contact.gap;
  message.force = toMessage<geometry_msgs::Vector3>(contact.force);
  message.normal_force = contact.normalForce();
  message.tangential_force = toMessage<geometry_msgs::Vector3>(contact.tangentialForce());
  message.link = tool.linkName(contact.link);
  message.shape = contact.shape;
  message.triangle = contact.triangle;
  const SurfacePoint& point = contact.surface;
  message.nodes.assign(point.node.begin(), point.node.begin() + point.count);
  message.weights.assign(point.weight.begin(), point.weight.begin() + point.count);
  message.region = static_cast<std::uint8_t>(contact.region);
  message.wall = static_cast<std::uint8_t>(contact.wall);
  return message;
}

}  // namespace

vibe_msgs::ToolContacts makeToolContacts(const TimedSimulation& simulation) {
  vibe_msgs::ToolContacts message;
  message.header.stamp = toRosTime(simulation.now());
  message.header.frame_id = kWorldFrame;
  for (const ToolContact& contact : simulation.simulation().contacts())
    message.contacts.push_back(makeToolContact(*simulation.model().tool, contact));
  return message;
}

}  // namespace vibe::sim

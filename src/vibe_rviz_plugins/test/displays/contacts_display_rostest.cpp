// Loads the display as rviz does, without a window. Displays are ROS nodes, so the test needs a master.
#include <gtest/gtest.h>
#include <ros/init.h>
#include <vibe_msgs/ToolContacts.h>

#include <limits>
#include <pluginlib/class_loader.hpp>

#include "vibe_rviz_plugins/display_base/message_shape_display.hpp"
#include "vibe_rviz_plugins/display_base/topic_display.hpp"

namespace vibe::rviz_plugins {
namespace {

class ContactsDisplayTest : public testing::Test {
 protected:
  ContactsDisplayTest()
      : loader_("rviz", "rviz::Display"),
        plugin_(loader_.createUniqueInstance("vibe_rviz_plugins/Contacts")),
        display_(dynamic_cast<MessageShapeDisplay<vibe_msgs::ToolContacts>*>(plugin_.get())) {}

  pluginlib::ClassLoader<rviz::Display> loader_;
  pluginlib::UniquePtr<rviz::Display> plugin_;
  MessageShapeDisplay<vibe_msgs::ToolContacts>* display_;
};

vibe_msgs::ToolContacts contactsOf(double force) {
  vibe_msgs::ToolContacts message;
  message.contacts.resize(1);
  message.contacts[0].position.x = 0.1;
  message.contacts[0].force.z = force;
  return message;
}

double topOf(const graphics::ColouredShape& shape) {
  double top = -1;
  for (const graphics::MovingVertex& vertex : shape.vertices) top = std::max<double>(top, vertex.position[2]);
  return top;
}

TEST_F(ContactsDisplayTest, AForceIsAnArrowOfItsLength) {
  ASSERT_NE(display_, nullptr);
  for (const double force : {0.01, 0.5, 2.0}) {
    graphics::ColouredShape shape;
    EXPECT_EQ(display_->makeShape(contactsOf(force), shape), "");
    EXPECT_EQ(graphics::problemOf(shape), "");
    EXPECT_NEAR(topOf(shape), 0.05 * force, 1e-6);
  }
}

TEST_F(ContactsDisplayTest, NothingIsDrawnOfNothing) {
  graphics::ColouredShape shape;
  EXPECT_EQ(display_->makeShape({}, shape), "");
  EXPECT_EQ(display_->makeShape(contactsOf(0), shape), "");
  EXPECT_TRUE(shape.vertices.empty());
}

TEST_F(ContactsDisplayTest, AForceThatIsNotFiniteIsReported) {
  graphics::ColouredShape shape;
  EXPECT_EQ(display_->makeShape(contactsOf(std::numeric_limits<double>::infinity()), shape),
            "A position or force of the contacts is not finite.");
}

TEST_F(ContactsDisplayTest, EveryPropertyHasHelp) {
  const PropertyHelp help = checkPropertyHelp(*plugin_, "Contacts");
  EXPECT_EQ(help.count, 3);  // topic, scale, diameter
  EXPECT_TRUE(help.missing.empty());
}

}  // namespace
}  // namespace vibe::rviz_plugins

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "contacts_display_test");
  return RUN_ALL_TESTS();
}

// Loads the display as rviz does, without a window. Displays are ROS nodes, so the test needs a master (rostest).
#include <gtest/gtest.h>
#include <ros/init.h>
#include <rviz/properties/property.h>
#include <vibe_msgs/TissuePullState.h>

#include <Eigen/Geometry>
#include <limits>
#include <pluginlib/class_loader.hpp>
#include <vibe_rviz_plugins/display_base/message_shape_display.hpp>
#include <vibe_rviz_plugins/display_base/topic_display.hpp>

namespace {

using vibe::graphics::ColouredShape;
using PullDisplay = vibe::rviz_plugins::MessageShapeDisplay<vibe_msgs::TissuePullState>;
constexpr double kPi = 3.14159265358979323846;

class PullSpringDisplayTest : public testing::Test {
 protected:
  PullSpringDisplayTest()
      : loader_("rviz", "rviz::Display"),
        plugin_(loader_.createUniqueInstance("vibe_example_display/PullSpring")),
        display_(dynamic_cast<PullDisplay*>(plugin_.get())) {}

  pluginlib::ClassLoader<rviz::Display> loader_;
  pluginlib::UniquePtr<rviz::Display> plugin_;
  PullDisplay* display_;
};

vibe_msgs::TissuePullState pullOf(double length) {
  vibe_msgs::TissuePullState message;
  message.particle = 7;
  message.position.x = 0.1;
  message.target.x = 0.1;
  message.target.z = length;
  return message;
}

Eigen::Vector3d cornerOf(const ColouredShape& shape, std::size_t k) {
  const float* p = shape.vertices[shape.triangles[k]].position;
  return {p[0], p[1], p[2]};
}

double areaOf(const ColouredShape& shape) {
  double area = 0;
  for (std::size_t k = 0; k + 2 < shape.triangles.size(); k += 3) {
    const Eigen::Vector3d a = cornerOf(shape, k);
    area += 0.5 * (cornerOf(shape, k + 1) - a).cross(cornerOf(shape, k + 2) - a).norm();
  }
  return area;
}

TEST_F(PullSpringDisplayTest, SpringIsATubeWithRoundEnds) {
  ASSERT_NE(display_, nullptr);
  const double radius = 0.001, length = 0.03;
  ColouredShape shape;
  EXPECT_EQ(display_->makeShape(pullOf(length), shape), "");
  EXPECT_EQ(vibe::graphics::problemOf(shape), "");
  const double area = 2 * kPi * radius * length + 4 * kPi * radius * radius;
  EXPECT_NEAR(areaOf(shape), area, 0.01 * area);  // a prism with 24 sides has 0.3 % less than the cylinder
  ColouredShape longer;
  display_->makeShape(pullOf(1.1 * length), longer);
  EXPECT_GT(areaOf(longer), 1.05 * area);  // control: the length is seen in the area
}

TEST_F(PullSpringDisplayTest, ReleasedSpringDrawsNothing) {
  vibe_msgs::TissuePullState message = pullOf(0.03);
  message.particle = -1;
  ColouredShape shape;
  EXPECT_EQ(display_->makeShape(message, shape), "");
  EXPECT_TRUE(shape.vertices.empty());
}

TEST_F(PullSpringDisplayTest, PositionThatIsNotFiniteIsReported) {
  vibe_msgs::TissuePullState message = pullOf(0.03);
  message.target.y = std::numeric_limits<double>::quiet_NaN();
  ColouredShape shape;
  EXPECT_EQ(display_->makeShape(message, shape), "The position or the target of the pull spring is not finite.");
}

TEST_F(PullSpringDisplayTest, EveryPropertyHasHelp) {
  const vibe::rviz_plugins::PropertyHelp help = vibe::rviz_plugins::checkPropertyHelp(*plugin_, "PullSpring");
  EXPECT_EQ(help.count, 2);  // topic and diameter
  EXPECT_TRUE(help.missing.empty());
  rviz::Property silent("Silent", 1, "", plugin_.get());
  EXPECT_EQ(vibe::rviz_plugins::checkPropertyHelp(*plugin_, "PullSpring").missing.size(), 1u);  // control
}

}  // namespace

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "pull_spring_display_test");
  return RUN_ALL_TESTS();
}

#include "dataset/joint_tree.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace vibe::endoscope::joint_tree_test {
namespace {

const char kArm[] = R"(<robot name="arm">
  <link name="base"/><link name="slide"/><link name="turn"/><link name="follower"/><link name="end"/>
  <joint name="push" type="prismatic"><parent link="base"/><child link="slide"/><origin xyz="0 0 1" rpy="0 0 0"/>
    <axis xyz="1 0 0"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint>
  <joint name="bend" type="revolute"><parent link="slide"/><child link="turn"/><origin xyz="0 0 0" rpy="0 0 0"/>
    <axis xyz="0 0 2"/><limit lower="-3" upper="3" effort="1" velocity="1"/></joint>
  <joint name="mimic" type="revolute"><parent link="turn"/><child link="follower"/><origin xyz="0.5 0 0" rpy="0 0 0"/>
    <axis xyz="0 0 1"/><limit lower="-3" upper="3" effort="1" velocity="1"/>
    <mimic joint="bend" multiplier="-0.5" offset="0.1"/></joint>
  <joint name="weld" type="fixed"><parent link="follower"/><child link="end"/><origin xyz="0 0 0" rpy="0 1.5707963 0"/>
  </joint></robot>)";

TEST(JointTree, PosesAreThoseOfTheChainOfJoints) {
  JointTree tree(kArm);
  tree.setFixed("base", "world", Eigen::Isometry3d(Eigen::Translation3d(0, 3, 0)));
  EXPECT_FALSE(tree.pose("end", "world"));  // no positions yet
  tree.setJoints({"push", "bend"}, {0.25, 1.2});
  const auto pose = tree.pose("end", "world");
  ASSERT_TRUE(pose);
  const Eigen::Vector3d place(0.25 + 0.5 * std::cos(1.2), 3 + 0.5 * std::sin(1.2), 1);
  EXPECT_LT((pose->translation() - place).norm(), 1e-9);
  const double angle = 1.2 - 0.6 + 0.1;  // z of the end is x of the follower
  EXPECT_LT((pose->linear().col(2) - Eigen::Vector3d(std::cos(angle), std::sin(angle), 0)).norm(), 1e-6);
  const auto back = tree.pose("world", "end");
  EXPECT_TRUE((*back * *pose).isApprox(Eigen::Isometry3d::Identity(), 1e-9));
}

// robot_state_publisher does the same: the suturing device of vibe_description needs it
TEST(JointTree, AJointThatMimicsFollowsItsOwnPositionWhereItHasOne) {
  JointTree tree(kArm);
  const auto angle = [&] {
    const Eigen::Vector3d across = tree.pose("follower", "turn")->linear().col(0);
    return std::atan2(across.y(), across.x());
  };
  tree.setJoints({"push", "bend"}, {0, 1.2});
  EXPECT_NEAR(angle(), -0.5, 1e-9) << "-0.5 x 1.2 + 0.1";
  tree.setJoints({"push", "bend", "mimic"}, {0, 1.2, 0.3});
  EXPECT_NEAR(angle(), 0.3, 1e-9);
}

TEST(JointTree, UnknownFramesAndBadDescriptionsAreTold) {
  JointTree tree(kArm);
  tree.setJoints({"push", "bend"}, {0, 0});
  EXPECT_FALSE(tree.pose("end", "elsewhere"));
  tree.setFixed("a", "b", Eigen::Isometry3d::Identity());
  tree.setFixed("b", "a", Eigen::Isometry3d::Identity());
  EXPECT_FALSE(tree.pose("a", "base"));  // a circle ends, too
  EXPECT_THROW(JointTree("<robot"), std::runtime_error);
}

}  // namespace
}  // namespace vibe::endoscope::joint_tree_test

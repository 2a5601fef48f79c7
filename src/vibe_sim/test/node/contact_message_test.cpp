#include "conversions/tool_message.hpp"

#include <gtest/gtest.h>

namespace vibe::sim::contact_message_test {
namespace {

const char kScene[] =
    "name: small\n"
    "geometry: {kind: stomach, particles: 400}\n"
    "foundation: {stiffness: 5 kPa/m}\n"
    "scope: {}\n";

/// A scope that is pressed against the wall.
class ContactMessage : public ::testing::Test {
 protected:
  void SetUp() override {
    StepInput input;
    input.joints[TipUpDown] = 0.4;
    for (int k = 0; k < 600 && simulation.state().tool_force.norm() < 0.2; ++k) {
      input.joints[Insertion] += 0.001;
      simulation.setInput(input);
      simulation.step();
    }
    ASSERT_GT(simulation.simulation().contacts().size(), 1U);
  }

  SceneModel made = modelOfText(kScene, "test");
  TimedSimulation simulation{made, 1, 5'000'000'000, 1};
};

TEST_F(ContactMessage, saysWhatTheStepSays) {
  const vibe_msgs::ToolContacts message = makeToolContacts(simulation);
  EXPECT_EQ(message.header.frame_id, "world");
  EXPECT_EQ(message.header.stamp.toNSec(), static_cast<std::uint64_t>(simulation.now()));
  const std::vector<ToolContact>& contacts = simulation.simulation().contacts();
  ASSERT_EQ(message.contacts.size(), contacts.size());
  for (std::size_t k = 0; k < contacts.size(); ++k) {
    const vibe_msgs::ToolContact& sent = message.contacts[k];
    const ToolContact& contact = contacts[k];
    EXPECT_EQ(sent.kind, vibe_msgs::ToolContact::CONTACT);
    EXPECT_EQ(sent.position.y, contact.point.y());
    EXPECT_EQ(sent.normal.z, contact.normal.z());
    EXPECT_EQ(sent.gap, contact.gap);
    EXPECT_EQ(sent.link, simulation.model().tool->linkName(contact.link));
    EXPECT_EQ(sent.shape, contact.shape);
    EXPECT_EQ(sent.triangle, contact.triangle);
    ASSERT_EQ(static_cast<int>(sent.nodes.size()), contact.surface.count);
    EXPECT_EQ(sent.nodes.back(), contact.surface.node[sent.nodes.size() - 1]);
    EXPECT_EQ(sent.weights.size(), sent.nodes.size());
    EXPECT_EQ(sent.region, static_cast<std::uint8_t>(contact.region));
    EXPECT_NEAR(sent.force.x, sent.tangential_force.x - sent.normal_force * sent.normal.x, 1e-12);
  }
}

TEST_F(ContactMessage, addsUpToTheWrench) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const vibe_msgs::ToolContact& contact : makeToolContacts(simulation).contacts)
    sum += Eigen::Vector3d(contact.force.x, contact.force.y, contact.force.z);
  const auto wrench = makeWrench(simulation.state(), simulation.now()).wrench.force;
  const double force = Eigen::Vector3d(wrench.x, wrench.y, wrench.z).norm();  // in the frame of the tip
  EXPECT_NEAR(sum.norm(), force, 1e-6 * force);
}

TEST_F(ContactMessage, isEmptyOnceTheStateIsAnother) {
  simulation.replaceState(simulation.state());
  EXPECT_TRUE(makeToolContacts(simulation).contacts.empty());
}

}  // namespace
}  // namespace vibe::sim::contact_message_test

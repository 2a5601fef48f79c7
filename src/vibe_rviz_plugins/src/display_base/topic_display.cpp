#include "vibe_rviz_plugins/display_base/topic_display.hpp"

#include <OgreSceneNode.h>
#include <ros/exceptions.h>
#include <rviz/display_context.h>
#include <rviz/frame_manager.h>
#include <rviz/properties/ros_topic_property.h>
#include <rviz/properties/status_property.h>

namespace vibe::rviz_plugins {

std::string lookUpFrame(rviz::DisplayContext& context, const std::string& frame, const ros::Time& stamp,
                        FramePose& pose) {
  rviz::FrameManager& frames = *context.getFrameManager();
  if (!stamp.isZero() && frames.getTransform(frame, stamp, pose.position, pose.orientation)) return "";
  if (frames.getTransform(frame, ros::Time(), pose.position, pose.orientation)) return "";
  return "No transform from '" + frame + "' to '" + context.getFixedFrame().toStdString() +
         "'; choose another fixed frame or publish this transform.";
}

namespace {

using rviz::StatusProperty;

const char* const kStatusTopic = "Topic";
const char* const kStatusMessage = "Message";
const char* const kStatusTransform = "Transform";

}  // namespace

TopicDisplay::TopicDisplay(const std::string& message_type, const QString& topic)
    : message_type_(QString::fromStdString(message_type)),
      topic_property_(new rviz::RosTopicProperty("Topic", topic, message_type_,
                                                 "Topic of type " + message_type_ + " that is drawn.", this,
                                                 SLOT(changeTopic()))) {}

TopicDisplay::~TopicDisplay() = default;

void TopicDisplay::onInitialize() {
  try {
    makeVisual();
    ready_ = true;
  } catch (const std::exception& error) {
    setStatusStd(StatusProperty::Error, "Resources", error.what());
  }
}

void TopicDisplay::onEnable() {
  subscribe();
}

void TopicDisplay::onDisable() {
  subscriber_.shutdown();
  reset();
}

void TopicDisplay::setTopic(const QString& topic, const QString&) {
  topic_property_->setString(topic);
}

void TopicDisplay::changeTopic() {
  reset();
}

void TopicDisplay::subscribe() {
  subscriber_.shutdown();
  if (!ready_) return;
  const std::string topic = topic_property_->getTopicStd();
  if (topic.empty()) {
    setStatus(StatusProperty::Error, kStatusTopic, "No topic is set; choose one of type " + message_type_ + ".");
    return;
  }
  try {
    subscriber_ = listenTo(topic);
    setStatusStd(StatusProperty::Warn, kStatusTopic, "No message on '" + topic + "' yet; is the simulator running?");
    waiting_ = true;
  } catch (const ros::Exception& error) {
    setStatusStd(StatusProperty::Error, kStatusTopic, std::string("Cannot subscribe: ") + error.what() + ".");
  }
}

void TopicDisplay::reset() {
  Display::reset();
  forget();
  if (ready_) clear();
  placed_.reset();
  report_.reset();
  if (isEnabled()) subscribe();
}

void TopicDisplay::messageArrived() {
  if (waiting_) setStatus(StatusProperty::Ok, kStatusTopic, "Messages arrive.");
  waiting_ = false;
}

void TopicDisplay::fixedFrameChanged() {
  placed_.reset();
}

void TopicDisplay::update(float, float) {
  if (!ready_) return;
  if (const std::optional<MessageReport> report = readLatest()) showStatus(*report);
  const std_msgs::Header* header = shownHeader();
  if (header == nullptr) return;
  place(*header);
  if (draw()) context_->queueRender();
}

void TopicDisplay::showStatus(const MessageReport& report) {
  if (report_ && report_->usable == report.usable && report_->text == report.text) return;
  setStatusStd(report.usable ? StatusProperty::Ok : StatusProperty::Error, kStatusMessage, report.text);
  report_ = report;
}

// Called for every picture: the frame of the message may move in the fixed frame while no message comes.
void TopicDisplay::place(const std_msgs::Header& header) {
  FramePose pose;
  const std::string wrong = lookUpFrame(*context_, header.frame_id, ros::Time(), pose);
  const bool known = wrong.empty();
  const bool news = !placed_ || *placed_ != known;
  placed_ = known;
  if (news) {
    setStatusStd(known ? StatusProperty::Ok : StatusProperty::Error, kStatusTransform, known ? "Known." : wrong);
    scene_node_->setVisible(known);
  }
  if (!known) return;
  scene_node_->setPosition(pose.position);
  scene_node_->setOrientation(pose.orientation);
}

PropertyHelp checkPropertyHelp(const rviz::Property& parent, const std::string& path) {
  PropertyHelp help;
  for (int i = 0; i < parent.numChildren(); ++i) {
    const rviz::Property& child = *parent.childAtUnchecked(i);
    if (dynamic_cast<const rviz::StatusProperty*>(&child) != nullptr) continue;
    const std::string name = path + "/" + child.getName().toStdString();
    ++help.count;
    if (child.getDescription().trimmed().isEmpty()) help.missing.push_back(name);
    const PropertyHelp below = checkPropertyHelp(child, name);
    help.count += below.count;
    help.missing.insert(help.missing.end(), below.missing.begin(), below.missing.end());
  }
  return help;
}

}  // namespace vibe::rviz_plugins

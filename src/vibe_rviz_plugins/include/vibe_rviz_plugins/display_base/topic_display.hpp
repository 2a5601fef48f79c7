#pragma once

#ifndef Q_MOC_RUN
#include <OgreQuaternion.h>
#include <OgreVector3.h>
#include <ros/subscriber.h>
#include <ros/time.h>
#include <rviz/display.h>
#include <std_msgs/Header.h>

#include <optional>
#include <string>
#include <vector>
#endif

namespace rviz {
class DisplayContext;
class Property;
class RosTopicProperty;
}  // namespace rviz

namespace vibe::rviz_plugins {

/// Pose of a frame in the fixed frame of rviz.
struct FramePose {
  Ogre::Vector3 position = Ogre::Vector3::ZERO;               ///< [m]
  Ogre::Quaternion orientation = Ogre::Quaternion::IDENTITY;  ///< of the frame's axes; unit quaternion
};

/// Looks up where a frame is.
/// @param stamp  time of the pose; if nothing is known for it, and for time 0, the latest pose is used
/// @return empty, and the pose is set; otherwise one sentence that says what is missing
std::string lookUpFrame(rviz::DisplayContext& context, const std::string& frame, const ros::Time& stamp,
                        FramePose& pose);

/// What a display says about a message.
struct MessageReport {
  std::string text;    ///< one sentence
  bool usable = true;  ///< false: the text says what is wrong, and the last usable message stays
};

/// What displays of one topic have in common, whatever the type of the message: the property Topic, the subscription,
/// the transform, and one status for each of the topic, the message and the transform. Derive from MessageDisplay or
/// MessageShapeDisplay. All functions run in the thread that renders.
class TopicDisplay : public rviz::Display {
  Q_OBJECT
 public:
  ~TopicDisplay() override;

  void update(float wall_dt, float ros_dt) override;
  /// Forgets all messages and listens again; a latched topic then sends its message again.
  void reset() override;
  void setTopic(const QString& topic, const QString& datatype) override;

 protected:
  /// @param message_type  such as vibe_msgs/SutureArray
  /// @param topic         listened to unless the user sets another; relative to the namespace of rviz
  TopicDisplay(const std::string& message_type, const QString& topic);

  void onInitialize() override;
  void onEnable() override;
  void onDisable() override;
  void fixedFrameChanged() override;

  /// For the subscription: another message has come.
  void messageArrived();

 protected Q_SLOTS:
  /// Slot for properties that change what is drawn.
  virtual void redraw() {}

 private Q_SLOTS:
  void changeTopic();

 private:
  void subscribe();
  void showStatus(const MessageReport& report);
  void place(const std_msgs::Header& header);

  /// Makes what draws, in `scene_node_`. What it throws becomes a status, and the display stays empty.
  virtual void makeVisual() = 0;
  /// Draws nothing until another message is read.
  virtual void clear() = 0;
  virtual ros::Subscriber listenTo(const std::string& topic) = 0;
  /// Reads the newest message; none: there is no unread one.
  virtual std::optional<MessageReport> readLatest() = 0;
  /// Header of the message that is shown; null: none.
  virtual const std_msgs::Header* shownHeader() const = 0;
  virtual void forget() = 0;
  /// Draws what has changed. @return whether anything has
  virtual bool draw() = 0;

  const QString message_type_;
  rviz::RosTopicProperty* topic_property_;
  ros::Subscriber subscriber_;
  bool ready_ = false;  // there is a visual
  bool waiting_ = true;
  std::optional<MessageReport> report_;  // last status of the message: setting a status costs more than drawing
  std::optional<bool> placed_;           // whether the transform was known; none: not looked up yet
};

/// Which properties explain themselves.
struct PropertyHelp {
  int count = 0;                     ///< properties found, statuses aside
  std::vector<std::string> missing;  ///< paths of those without a help sentence, such as "Sutures/Legend"
};

/// Checks all properties below `parent`, a display for example. Every property of this project has a help sentence,
/// and tests use this function to make sure.
/// @param path  name of the parent, which the paths begin with
PropertyHelp checkPropertyHelp(const rviz::Property& parent, const std::string& path);

}  // namespace vibe::rviz_plugins

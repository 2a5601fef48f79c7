#pragma once
#ifndef Q_MOC_RUN
#include <ros/subscriber.h>
#include <rviz/display.h>
#include <std_msgs/Header.h>

#include <optional>
#include <string>
#endif

namespace rviz {
class RosTopicProperty;
}

namespace vibe::rviz_plugins {

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
  void say(const MessageReport& report);
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
  std::optional<MessageReport> said_;  // last status of the message: setting a status costs more than drawing
  std::optional<bool> placed_;         // whether the transform was known; none: not looked up yet
};

}  // namespace vibe::rviz_plugins

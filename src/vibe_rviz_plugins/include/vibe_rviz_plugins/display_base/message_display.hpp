#pragma once
#include <ros/message_traits.h>

#include <optional>
#include <string>

#include "vibe_rviz_plugins/display_base/topic_display.hpp"

namespace vibe::rviz_plugins {

/// A display of the newest message of one topic; a flood of messages costs no drawing. Derived classes check a message
/// in read() and draw in draw(). Properties of derived classes may use the slot redraw().
/// @tparam Message  with a header, whose frame is the frame of all positions
template <class Message>
class MessageDisplay : public TopicDisplay {
 protected:
  /// @param topic  listened to unless the user sets another
  explicit MessageDisplay(const QString& topic) : TopicDisplay(ros::message_traits::datatype<Message>(), topic) {}

  /// The last usable message; null: none. Within read() still the message before.
  const Message* shown() const { return shown_.get(); }

 private:
  using Pointer = typename Message::ConstPtr;

  /// Checks a message and keeps what is to be drawn of it.
  virtual MessageReport read(const Message& message) = 0;

  ros::Subscriber listenTo(const std::string& topic) final {
    return update_nh_.subscribe(topic, 1, &MessageDisplay::receive, this);
  }

  void receive(const Pointer& message) {
    messageArrived();
    latest_ = message;
  }

  std::optional<MessageReport> readLatest() final {
    if (!latest_) return std::nullopt;
    const Pointer message = std::move(latest_);
    latest_.reset();
    MessageReport report = read(*message);
    if (report.usable) shown_ = message;
    return report;
  }

  const std_msgs::Header* shownHeader() const final { return shown_ ? &shown_->header : nullptr; }

  void forget() final {
    latest_.reset();
    shown_.reset();
  }

  Pointer shown_, latest_;  // latest_: not read yet
};

}  // namespace vibe::rviz_plugins

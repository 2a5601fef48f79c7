#pragma once
#include <ros/node_handle.h>
#include <sensor_msgs/Joy.h>

#include <string>

#include "vibe_operator/messages/button_bank.hpp"
#include "vibe_operator/messages/session_watch.hpp"

namespace vibe::operating {

/// Publishes scope/buttons while it has control: at every change and whenever tick() is called, which should be ten
/// times a second. Without control nothing is advertised, so that the simulator has no second publisher to ignore.
class ButtonSender {
 public:
  /// @param frame  frame_id of its messages: tells apart the parts of one program that press buttons
  explicit ButtonSender(std::string frame) : frame_(std::move(frame)) {}

  /// Starts again in this (valid) namespace, without control.
  void listen(const std::string& name_space);

  /// Taking control has no effect while another publisher has it; sentence() says which. Otherwise it first waits for
  /// the input of the last step, so that held tissue is not released; this takes one step, or a second if there is
  /// none.
  void setControl(bool on, double now);
  bool mayTakeControl(double now) const { return watch_.rival(now).empty(); }  ///< no other publisher has it
  bool inControl() const { return in_control_; }                               ///< its buttons are published
  bool isTakingControl() const { return static_cast<bool>(last_input_); }      ///< it waits for the last input

  /// Control was given back, and the publisher is about to shut down.
  bool closing() const { return !in_control_ && static_cast<bool>(publisher_); }

  void press(int button, const Moment& now);    ///< no effect without control
  void release(int button, const Moment& now);  ///< no effect without control

  void tick(const Moment& now);  ///< ten times a second

  /// Buttons pressed by the publisher in control.
  const std::array<std::int32_t, kCommandCount>& down() const { return bank_.down(); }
  /// Who is in control, in one sentence.
  std::string sentence(double now) const;

 private:
  std::string frame_;
  ros::NodeHandle handle_;
  ros::Publisher publisher_;
  ros::Subscriber subscriber_;
  ros::Subscriber last_input_;  // only while control is being taken, because the number of subscribers of this topic
                                // matters elsewhere
  ButtonBank bank_;
  ControlWatch watch_;
  std::string topic_;
  bool in_control_ = false;
  double taking_since_ = 0;   // [s]
  double closing_since_ = 0;  // the last message needs a moment before the publisher shuts down [s]

  void receive(const ros::MessageEvent<const sensor_msgs::Joy>& event);
  void beginControl();
  void endControl(double now);
  void publish();
};

}  // namespace vibe::operating

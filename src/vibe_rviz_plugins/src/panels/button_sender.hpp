#pragma once
#include <ros/node_handle.h>
#include <sensor_msgs/Joy.h>

#include <string>

#include "messages/button_bank.hpp"
#include "messages/session_watch.hpp"

namespace vibe {

/// Publishes scope/buttons while it has control: at every change and whenever tick() is called, which is to happen ten
/// times a second. Without control nothing is advertised, so that the simulator has no second publisher to refuse.
class ButtonSender {
 public:
  /// Begins anew in this namespace, which has been checked, without control.
  void listen(const std::string& name_space);

  /// Taking control has no effect while somebody else has it; sentence() says who. Else it first looks what the
  /// simulator's last step used, so that nothing is let go that is held: that takes a step, or a second without one.
  void setControl(bool on, double now);
  bool inControl() const { return in_control_; }
  bool isTakingControl() const { return static_cast<bool>(last_input_); }

  // Without control these do nothing.
  void press(int button, const Moment& now);
  void release(int button, const Moment& now);

  void tick(const Moment& now);

  /// What is pressed by whoever has control.
  const std::array<std::int32_t, kCommandCount>& down() const { return bank_.down(); }
  /// Who that is, in one sentence.
  std::string sentence(double now) const;

 private:
  ros::NodeHandle handle_;
  ros::Publisher publisher_;
  ros::Subscriber subscriber_;
  ros::Subscriber last_input_;  // while control is being taken; others may count who listens to that topic
  ButtonBank bank_;
  ControlWatch watch_;
  std::string topic_;
  bool in_control_ = false;
  double taking_since_ = 0;   // [s]
  double closing_since_ = 0;  // the last message needs a moment before the publisher may go [s]

  void hear(const ros::MessageEvent<const sensor_msgs::Joy>& event);
  void beginControl();
  void endControl(double now);
  void publish();
};

}  // namespace vibe

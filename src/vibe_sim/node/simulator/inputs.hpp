#pragma once

#include <cstdint>
#include <functional>
#include <list>
#include <map>
#include <memory>
#include <string>

#include <ros/callback_queue.h>
#include <ros/message_event.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>
#include <ros/subscriber.h>

#include "input/input_queue.hpp"
#include "input/input_sample.hpp"
#include "publishing/publishers.hpp"

namespace vibe::sim {

/// Every topic that the simulator listens to. Valid messages go to the queue; an invalid message is reported in one
/// sentence in the log and on procedure/events, of each kind at most once a second, and has no other effect.
class Inputs {
 public:
  /// @param now      the simulator's time, for the window [ns]
  /// @param arrived  called after something has been put into the queue
  /// Both are called from the thread of the inputs.
  Inputs(const ros::NodeHandle& handle, InputQueue& queue, Publishers& publishers, const InputWindow& window,
         std::function<std::int64_t()> now, std::function<void(InputChannel)> arrived);
  ~Inputs();

 private:
  /// A topic has one source at a time: two that disagree would make the scope jump between two positions.
  struct Topic {
    ros::Subscriber subscriber;
    const SampleSender* owner = nullptr;  // that is obeyed: the last one of which a message was taken
    double last_message = 0;              // of the owner, steady time [s]
  };

  ros::NodeHandle handle_;
  ros::CallbackQueue callbacks_;
  InputQueue& queue_;
  Publishers& publishers_;
  const InputWindow window_;
  std::function<std::int64_t()> now_;
  std::function<void(InputChannel)> arrived_;
  std::list<SampleSender> senders_;      // so far
  std::map<std::string, Topic> topics_;  // touched by the one thread of the spinner only, once it runs
  std::unique_ptr<ros::AsyncSpinner> spinner_;

  template <typename Message>
  void subscribe(const std::string& name, std::function<InputSample(const Message&)> read);
  void receive(const std::string& name, const std::string& publisher, const std::function<InputSample()>& read);
  bool obeys(const std::string& name, Topic& topic, const std::string& publisher);
  void take(const std::string& name, Topic& topic, const std::string& publisher, InputSample sample);
  const SampleSender* senderOf(const std::string& name, const Topic& topic, const std::string& publisher);
};

}  // namespace vibe::sim

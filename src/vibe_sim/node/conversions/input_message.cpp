#include "conversions/input_message.hpp"

#include "conversions/conversions.hpp"
#include "vibe_core/common/error.hpp"
#include "vibe_core/constraints/pull_patch.hpp"

namespace vibe::sim {

namespace {

template <typename Message>
void copyTo(const Eigen::Vector3d& from, Message& message) {
  message.x = from.x(), message.y = from.y(), message.z = from.z();
}

}  // namespace

InputSample readPull(const vibe_msgs::TissuePull& message) {
  InputSample sample;
  sample.channel = InputChannel::Pull;
  sample.stamp = fromRosTime(message.header.stamp);
  if (message.particle == -1) return sample;
  if (message.particle < -1)
    throw Error("its particle is " + std::to_string(message.particle) + "; give a number from 0 on, or -1 to let go.");
  const std::string& frame = message.header.frame_id;
  if (frame != kWorldFrame && frame != kTissueFrame)
    throw Error("its frame is '" + frame + "'; give the target in frame '" + kWorldFrame + "' or '" + kTissueFrame +
                "'.");
  sample.pull_particle = message.particle;
  sample.pull_target = {message.target.x, message.target.y, message.target.z};
  if (!sample.pull_target.allFinite())
    throw Error("its target has a value that is not a finite number; send finite numbers.");
  return sample;
}

vibe_msgs::TissuePullState makePullState(const State& state, std::int64_t stamp) {
  vibe_msgs::TissuePullState message;
  message.header.stamp = toRosTime(stamp);
  message.header.frame_id = kWorldFrame;
  message.particle = state.pull.particle;
  copyTo(heldPosition(state), message.position);
  copyTo(state.pull.target, message.target);
  copyTo(state.pull.force, message.force);
  return message;
}

}  // namespace vibe::sim

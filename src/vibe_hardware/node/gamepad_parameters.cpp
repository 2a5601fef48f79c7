#include "gamepad_parameters.hpp"

#include <memory>

#include "vibe_core/common/package_path.hpp"
#include "vibe_hardware/gamepad/pad_finder.hpp"
#include "vibe_hardware/gamepad/pad_recording.hpp"
#include "vibe_node/parameter_reader.hpp"

namespace vibe::hardware {

GamepadParameters readGamepadParameters(const ros::NodeHandle& private_handle) {
  node::ParameterReader reader(private_handle);
  GamepadParameters parameters;
  reader.read("mapping", parameters.mapping);
  reader.read("pad", parameters.pad);
  reader.read("replay", parameters.replay);
  reader.read("record", parameters.record);
  reader.read("rate", parameters.rate, 60, 100, "Hz");
  double diagnostic_period = 1;  // diagnostic_updater reads it itself
  reader.read("diagnostic_period", diagnostic_period, 0.1, 60, "s");
  reader.finish();
  return parameters;
}

ToolLimits toolLimitsOf(const ros::NodeHandle& handle) {
  std::string key, urdf;
  if (handle.searchParam("robot_description", key) && handle.getParam(key, urdf))
    return ToolModel::fromUrdf(urdf, "parameter " + key).limits();
  return loadToolLimits("package://vibe_description/urdf/scope.urdf");
}

PadLink makePadLink(const GamepadParameters& parameters) {
  if (parameters.replay.empty())
    return PadLink([wanted = parameters.pad](std::string& why) { return openPad(wanted, why); });
  const auto recording = std::make_shared<PadRecording>(loadPadRecording(resolveAddress(parameters.replay)));
  return PadLink([recording, played = false](std::string& why) mutable -> std::unique_ptr<PadSource> {
    why = "The recording of the gamepad has ended.";
    if (played) return nullptr;
    played = true;
    return playPadRecording(*recording);
  });
}

}  // namespace vibe::hardware

#include "session_info_message.hpp"

#include "conversions.hpp"
#include "vibe_core/common/machine_info.hpp"
#include "vibe_core/simulation/simulator.hpp"
#include "vibe_core/simulation/snapshot.hpp"
#include "vibe_core/state/state_fields.hpp"

namespace vibe::sim {

vibe_msgs::SessionInfo makeSessionInfo(const Session& session) {
  const Model& model = *session.model;
  const MachineInfo machine = machineInfo();
  vibe_msgs::SessionInfo message;
  message.header.stamp = toRosTime(session.now());
  message.run = session.run;
  message.revision = session.revision;
  message.version = machine.version;
  message.state_version = kStateVersion;
  message.compiler = machine.compiler;
  message.c_library = machine.c_library;
  message.os = machine.os;
  message.processor = machine.processor;
  message.cores = static_cast<std::uint32_t>(machine.cores);
  message.instruction_set = machine.instruction_set;
  message.arithmetic = machine.arithmetic;
  message.urdf = session.urdf;
  message.urdf_hash = hash(message.urdf);
  message.scene = makeSceneText(model.scene, session.seed).data;
  message.scene_hash = hash(message.scene);
  message.model_hash = modelFingerprint(model);
  return message;
}

vibe_msgs::StateSnapshot makeStateSnapshot(const Session& session) {
  vibe_msgs::StateSnapshot message;
  message.header.stamp = toRosTime(session.now());
  message.run = session.run;
  message.step = static_cast<std::uint64_t>(session.state.step);
  const std::string bytes = encodeSnapshot(*session.model, session.state);
  message.data.assign(bytes.begin(), bytes.end());
  return message;
}

}  // namespace vibe::sim

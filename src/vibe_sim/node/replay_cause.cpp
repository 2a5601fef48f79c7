#include "replay_cause.hpp"

#include "vibe_core/common/machine_info.hpp"
#include "vibe_core/simulation/simulator.hpp"

namespace vibe::sim {
namespace {

// "compiler (recorded: GCC 12.2, here: Clang 14)"; empty if they are equal.
std::string comparison(const std::string& name, const std::string& recorded, const std::string& here) {
  if (recorded == here) return "";
  return name + " (recorded: " + recorded + ", here: " + here + ")";
}

std::string differences(const vibe_msgs::SessionInfo& info) {
  const MachineInfo here = machineInfo();
  std::string all;
  for (const std::string& one :
       {comparison("version", info.version, here.version), comparison("arithmetic", info.arithmetic, here.arithmetic),
        comparison("compiler", info.compiler, here.compiler), comparison("C library", info.c_library, here.c_library),
        comparison("instruction set", info.instruction_set, here.instruction_set),
        comparison("processor", info.processor, here.processor)}) {
    if (!one.empty()) all += (all.empty() ? "" : ", ") + one;
  }
  return all;
}

}  // namespace

std::string findEdit(const vibe_msgs::SessionInfo& info) {
  if (hash(info.scene) != info.scene_hash) return "the scene is not the recorded one";
  if (hash(info.urdf) != info.urdf_hash) return "the URDF of the tool is not the recorded one";
  return "";
}

std::string causeOfModel(const vibe_msgs::SessionInfo& info) {
  const std::string all = differences(info);
  return "the surface file that the scene names has changed" +
         (all.empty() ? "" : ", or another build makes another model: " + all);
}

std::string causeOfState(const vibe_msgs::SessionInfo& info) {
  const std::string all = differences(info);
  if (!all.empty()) return "what differs: " + all;
  return "version and machine are those of the recording; the file was edited, or this is an error of the simulator: "
         "please report it";
}

}  // namespace vibe::sim

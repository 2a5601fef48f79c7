#include "vibe_ros_utils/former_names.hpp"

#include <ros/console.h>

#include <algorithm>
#include <cstdio>
#include <list>
#include <mutex>
#include <set>
#include <vector>

#include "vibe_core/program/error.hpp"

namespace vibe::ros_utils {
namespace {

struct Renamed {
  std::string former, present;
};
using Table = std::vector<Renamed>;

const Table& outputs() {
  static const Table table = {{"scope/simulated/measured_js", "scope/measured_js"},
                              {"overstitch/simulated/measured_js", "suturing_device/measured_js"},
                              {"overstitch/helix/measured_cp", "suturing_device/helix/measured_cp"},
                              {"overstitch/operating_state", "suturing_device/operating_state"},
                              {"overstitch/tracking", "suturing_device/tracking"},
                              {"overstitch/predicted_js", "suturing_device/predicted_js"}};
  return table;
}

const Table& inputs() {
  static const Table table = {{"scope/measured_js", "scope/input/joint_states"},
                              {"overstitch/measured_js", "suturing_device/input/joint_states"},
                              {"overstitch/servo_jp", "suturing_device/servo_jp"},
                              {"overstitch/move_jp", "suturing_device/move_jp"},
                              {"overstitch/state_command", "suturing_device/state_command"}};
  return table;
}

std::string formerIn(const Table& table, const std::string& present) {
  for (const Renamed& name : table)
    if (name.present == present) return name.former;
  return "";
}

std::string presentIn(const Table& table, const std::string& former) {
  for (const Renamed& name : table)
    if (name.former == former) return name.present;
  return former;
}

void warnOnce(const std::string& former, const std::string& sentence) {
  static std::mutex mutex;
  static std::set<std::string> told;
  const std::lock_guard<std::mutex> lock(mutex);
  if (told.insert(former).second) ROS_WARN_STREAM(sentence);
}

bool isIn(const std::string& whole, const std::string& name) {
  if (whole.size() < name.size() || whole.compare(whole.size() - name.size(), name.size(), name) != 0) return false;
  return whole.size() == name.size() || whole[whole.size() - name.size() - 1] == '/';
}

bool isRemapped(int argc, char** argv, const std::string& name) {
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    const std::size_t end = word.find(":=");
    if (end != std::string::npos && isIn(word.substr(0, end), name)) return true;
  }
  return false;
}

/// The remapping with the present name; the same if it has no former one.
std::string renamed(const std::string& word, int argc, char** argv) {
  const std::size_t end = word.find(":=");
  if (end == std::string::npos) return word;
  const std::string name = word.substr(0, end);
  for (const Table* table : {&outputs(), &inputs()})
    for (const auto& [former, present] : *table)
      if (isIn(name, former) && !isRemapped(argc, argv, present))
        return name.substr(0, name.size() - former.size()) + present + word.substr(end);
  return word;
}

}  // namespace

std::string formerOutput(const std::string& present) {
  return formerIn(outputs(), present);
}

std::string formerInput(const std::string& present) {
  return formerIn(inputs(), present);
}

std::string presentInput(const std::string& name) {
  return presentIn(inputs(), name);
}

std::string presentOutput(const std::string& name) {
  return presentIn(outputs(), name);
}

bool isFormerOutput(const std::string& whole) {
  return std::any_of(outputs().begin(), outputs().end(), [&](const Renamed& name) { return isIn(whole, name.former); });
}

void warnOfFormerInput(const std::string& node, const std::string& former) {
  warnOnce(former, node + " publishes " + former +
                       ", the former name of an input, which is read in this release for the last time; publish " +
                       presentInput(former) + ".");
}

void warnOfFormerOutput(const std::string& node, const std::string& former) {
  warnOnce(former, node + " listens to " + former +
                       ", a former name, which is sent in this release for the last time; "
                       "listen to " +
                       presentOutput(former) + ".");
}

void renameRemappings(int argc, char** argv) {
  static std::list<std::string> kept;  // argv points into it
  const std::vector<char*> given(argv, argv + argc);
  for (int i = 1; i < argc; ++i) {
    const std::string word = given[static_cast<std::size_t>(i)], present = renamed(word, argc, argv);
    if (present == word) continue;
    argv[i] = kept.emplace_back(present).data();
    const bool is_output_too = isIn(word.substr(0, word.find(":=")), "scope/measured_js");
    std::fprintf(stderr, "The remapping %s has a former name and is taken as %s; write that.%s\n", word.c_str(),
                 present.c_str(),
                 is_output_too ? " To move the joints of the tool, remap scope/input/joint_states as well." : "");
  }
}

void refuseFormerRemappings(const ros::NodeHandle& handle) {
  for (const Table* table : {&outputs(), &inputs()})
    for (const auto& [former, present] : *table)
      if (former != "scope/measured_js" && handle.resolveName(former) != handle.resolveName(former, false))
        throw Error("The remapping of " + former + " has a former name; remap " + present + ".");
}

}  // namespace vibe::ros_utils

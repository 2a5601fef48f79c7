#include "goal_message.hpp"

#include <yaml-cpp/emitter.h>

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

#include "vibe_core/common/error.hpp"
#include "vibe_core/geometry/anatomical_map.hpp"
#include "vibe_core/trainee/protocol.hpp"

namespace vibe {
namespace {

/// What the goals of a kind have.
struct Kind {
  const char* name;
  bool has_place;
  const char* time;   ///< key of the protocol for `time`; nullptr: none
  const char* needs;  ///< sections of the scene, separated by a space
};
constexpr std::array<Kind, 8> kKinds = {{{"insufflate", false, "patience", "gas"},
                                         {"inspect", true, "for", ""},
                                         {"mark", true, "for", "marking"},
                                         {"bite", true, nullptr, "helix suture"},
                                         {"suture_set", true, nullptr, "helix suture"},
                                         {"cinch", false, nullptr, "helix suture"},
                                         {"withdraw", false, nullptr, ""},
                                         {"wait", false, "for", ""}}};

const Kind* findKind(const std::string& name) {
  const auto found =
      std::find_if(kKinds.begin(), kKinds.end(), [&name](const Kind& kind) { return name == kind.name; });
  return found == kKinds.end() ? nullptr : &*found;
}

/// Writes keys whose value is not the one that stands for the default.
class Writer {
 public:
  explicit Writer(YAML::Emitter& out) : out_(out) {
    out_.SetDoublePrecision(std::numeric_limits<double>::max_digits10);
  }

  template <typename T>
  void add(const char* key, const T& value, const T& absent = T()) {
    if (value != absent) out_ << YAML::Key << key << YAML::Value << value;
  }

 private:
  YAML::Emitter& out_;
};

void addSet(const vibe_msgs::TraineeGoal& message, Writer& writer) {
  writer.add("pattern", message.pattern);
  writer.add("bites", message.bites);
  writer.add("length", message.length);
  writer.add("width", message.width);
  writer.add("mirrored", message.mirrored != 0);
  writer.add("cinched", message.leave_open == 0, true);
}

void addPlace(const vibe_msgs::TraineeGoal& message, YAML::Emitter& out) {
  out << YAML::Key << "along" << YAML::Value << message.along << YAML::Key << "around" << YAML::Value << message.around;
  out << YAML::Key << "distal" << YAML::Value << message.distal << YAML::Key << "anterior" << YAML::Value
      << message.anterior;
}

// The language of protocols has one reader, with its ranges, defaults and sentences.
std::string toProtocol(const vibe_msgs::TraineeGoal& message) {
  YAML::Emitter out;
  Writer writer(out);
  const Kind* kind = findKind(message.kind);
  out << YAML::Flow << YAML::BeginMap << YAML::Key << "name" << YAML::Value << "message" << YAML::Key << "goals"
      << YAML::Value << YAML::BeginSeq << YAML::BeginMap << YAML::Key << message.kind << YAML::Value << YAML::BeginMap;
  if (kind && kind->has_place) addPlace(message, out);
  if (kind && kind->time) writer.add(kind->time, message.time);
  if (message.kind == "suture_set") addSet(message, writer);
  if (message.kind == "inspect") writer.add("distance", message.distance);
  if (message.kind == "withdraw") writer.add("insertion", message.insertion);
  out << YAML::EndMap << YAML::EndMap << YAML::EndSeq << YAML::EndMap;
  return out.c_str();
}

// Without the place in a file that nobody has written.
std::string withoutPlace(const std::string& sentence) {
  const std::string place = "goals[0].";
  const std::size_t found = sentence.find(place);
  return found == std::string::npos ? sentence : sentence.substr(found + place.size());
}

bool hasSection(const Scene& scene, const std::string& section) {
  if (section == "gas") return scene.gas.has_value();
  if (section == "marking") return scene.marking.has_value();
  if (section == "helix") return scene.helix.has_value();
  return scene.suture.has_value();
}

}  // namespace

Goal readGoal(const vibe_msgs::TraineeGoal& message) {
  if (message.kind.empty()) throw Error("The goal has no kind; give one, such as 'bite'.");
  Protocol protocol;
  try {
    protocol = Protocol::parse(toProtocol(message), "goal");
  } catch (const Error& error) {
    throw Error(withoutPlace(error.what()));
  }
  if (protocol.goals.size() != 1 || !findKind(message.kind))
    throw Error("'" + message.kind + "' is a row of goals; send its goals one by one.");
  return protocol.goals.front();
}

std::string refusalIn(const Model& model, const vibe_msgs::TraineeGoal& message) {
  const Kind* kind = findKind(message.kind);
  if (!kind) return "";
  for (const char* section : {"gas", "marking", "helix", "suture"})
    if (std::string(kind->needs).find(section) != std::string::npos && !hasSection(model.scene, section))
      return "The scene '" + model.scene.name + "' has no section '" + section + "', which the goal '" + message.kind +
             "' needs.";
  if (!kind->has_place) return "";
  try {
    const AnatomicalMap map(model.organ, model.organ.surface.vertices);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

std::string patternOf(const Goal& goal) {
  const auto* set = std::get_if<SutureSetGoal>(&goal);
  return set ? toString(set->pattern) : "";
}

}  // namespace vibe

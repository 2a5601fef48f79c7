#include "conversions/goal_message.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <yaml-cpp/emitter.h>

#include "vibe_core/files/number_text.hpp"
#include "vibe_core/geometry/anatomical_map.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_core/trainee/protocol.hpp"

namespace vibe::sim {

namespace {

/// What the goals of a kind have.
struct GoalKind {
  const char* name;
  bool has_place;
  const char* time;   ///< key of the protocol for `time`; nullptr: none
  const char* needs;  ///< sections of the scene, separated by a space
};
constexpr std::array<GoalKind, 8> kKinds = {{{"insufflate", false, "patience", "gas"},
                                             {"inspect", true, "for", ""},
                                             {"mark", true, "for", "marking"},
                                             {"bite", true, nullptr, "helix suture"},
                                             {"suture_set", true, nullptr, "helix suture"},
                                             {"cinch", false, nullptr, "helix suture"},
                                             {"withdraw", false, nullptr, ""},
                                             {"wait", false, "for", ""}}};

const GoalKind* findKind(const std::string& name) {
  const auto found =
      std::find_if(kKinds.begin(), kKinds.end(), [&name](const GoalKind& kind) { return name == kind.name; });
  return found == kKinds.end() ? nullptr : &*found;
}

/// The shortest text that YAML reads back as the same number.
std::string textOf(double value) {
  if (std::isnan(value)) return ".nan";
  if (std::isinf(value)) return value > 0 ? ".inf" : "-.inf";
  return shortestText(value);
}

void add(const char* key, double value, YAML::Emitter& out) {
  out << YAML::Key << key << YAML::Value << textOf(value);
}

/// Where 0 stands for the default.
void addIfGiven(const char* key, double value, YAML::Emitter& out) {
  if (value != 0) add(key, value, out);
}

void addSet(const vibe_msgs::TraineeGoal& message, YAML::Emitter& out) {
  if (!message.pattern.empty()) out << YAML::Key << "pattern" << YAML::Value << message.pattern;
  addIfGiven("bites", message.bites, out);
  addIfGiven("length", message.length, out);
  addIfGiven("width", message.width, out);
  out << YAML::Key << "mirrored" << YAML::Value << (message.mirrored != 0);
  out << YAML::Key << "cinched" << YAML::Value << (message.leave_open == 0);
}

void addPlace(const vibe_msgs::TraineeGoal& message, YAML::Emitter& out) {
  add("along", message.along, out);
  if (!message.region.empty()) out << YAML::Key << "region" << YAML::Value << message.region;
  add("around", message.around, out);
  add("distal", message.distal, out);
  add("anterior", message.anterior, out);
}

void addSurvey(const vibe_msgs::TraineeGoal& message, YAML::Emitter& out) {
  add("coverage", message.coverage, out);
  if (!message.region.empty()) out << YAML::Key << "region" << YAML::Value << message.region;
  addIfGiven("patience", message.time, out);
}

// The language of protocols has one reader, with its ranges, defaults and sentences.
std::string toProtocol(const vibe_msgs::TraineeGoal& message) {
  YAML::Emitter out;
  const GoalKind* kind = findKind(message.kind);
  out << YAML::Flow << YAML::BeginMap << YAML::Key << "name" << YAML::Value << "message" << YAML::Key << "goals"
      << YAML::Value << YAML::BeginSeq << YAML::BeginMap << YAML::Key << message.kind << YAML::Value << YAML::BeginMap;
  const bool everywhere = message.kind == "inspect" && message.coverage != 0;
  if (everywhere) addSurvey(message, out);
  if (kind && kind->has_place && !everywhere) addPlace(message, out);
  if (kind && kind->time && !everywhere) addIfGiven(kind->time, message.time, out);
  if (message.kind == "suture_set") addSet(message, out);
  if (message.kind == "inspect") addIfGiven("distance", message.distance, out);
  if (message.kind == "withdraw") addIfGiven("insertion", message.insertion, out);
  out << YAML::EndMap << YAML::EndMap << YAML::EndSeq << YAML::EndMap;
  return out.c_str();
}

// Without the place in a file that nobody has written.
std::string withoutPlace(const std::string& sentence) {
  const std::string place = "goals[0].";
  const std::size_t found = sentence.find(place);
  return found == std::string::npos ? sentence : sentence.substr(found + place.size());
}

const Place* placeOf(const Goal& goal) {
  if (const auto* set = std::get_if<SutureSetGoal>(&goal)) return &set->centre;
  if (const auto* bite = std::get_if<BiteGoal>(&goal)) return &bite->place;
  if (const auto* mark = std::get_if<MarkGoal>(&goal)) return &mark->place;
  if (const auto* look = std::get_if<InspectGoal>(&goal)) return &look->place;
  return nullptr;
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

std::string refusalIn(const Model& model, const vibe_msgs::TraineeGoal& message, const Goal& goal) {
  const GoalKind* kind = findKind(message.kind);
  if (!kind) return "";
  for (const char* section : {"gas", "marking", "helix", "suture"})
    if (std::string(kind->needs).find(section) != std::string::npos && !hasSection(model.scene, section))
      return "The scene '" + model.scene.name + "' has no section '" + section + "', which the goal '" + message.kind +
             "' needs.";
  const Place* place = placeOf(goal);
  if (!place) return "";
  try {
    const AnatomicalMap map(model.organ, model.organ.surface.vertices);
    map.at(place->region ? map.alongIn(*place->region, place->along) : place->along, place->around);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

std::string patternOf(const Goal& goal) {
  const auto* set = std::get_if<SutureSetGoal>(&goal);
  return set ? toString(set->pattern) : "";
}

}  // namespace vibe::sim

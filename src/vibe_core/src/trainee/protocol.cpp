#include "vibe_core/trainee/protocol.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "trainee/protocol_reader.hpp"

namespace vibe {

namespace {

std::string at(const Place& place) {
  char text[120];
  std::snprintf(text, sizeof text, " at %.0f %% of the %s, %.0f deg", 100 * place.along,
                place.region ? toString(*place.region) : "axis", place.around * 180 / M_PI);
  return text;
}

struct Describer {
  std::string operator()(const InsufflateGoal&) const { return "insufflate"; }
  std::string operator()(const InspectGoal& goal) const { return "inspect" + at(goal.place); }
  std::string operator()(const MarkGoal& goal) const { return "mark" + at(goal.place); }
  std::string operator()(const BiteGoal& goal) const { return "bite" + at(goal.place); }
  std::string operator()(const SutureSetGoal& goal) const {
    return "suture set '" + std::string(toString(goal.pattern)) + "' of " + std::to_string(goal.bites) + " bites" +
           at(goal.centre);
  }
  std::string operator()(const CinchGoal&) const { return "T-tag and cinch"; }
  std::string operator()(const WithdrawGoal&) const { return "withdraw"; }
  std::string operator()(const WaitGoal&) const { return "wait"; }
};

}  // namespace

std::string describe(const Goal& goal) {
  return std::visit(Describer{}, goal);
}

namespace {

constexpr YamlLimits kLimits{16u << 20, 32};  // as of trainee scripts

}  // namespace

Protocol Protocol::load(const std::string& file) {
  const YamlSource source = YamlSource::load(file, kLimits);
  return ProtocolReader(source).read();
}

Protocol Protocol::parse(const std::string& yaml, const std::string& place) {
  const YamlSource source = YamlSource::parse(yaml, place, kLimits);
  return ProtocolReader(source).read();
}

bool isProtocol(const std::string& file) {
  const YamlSource source = YamlSource::load(file, kLimits);
  const std::vector<YamlField> fields = source.map(source.root());
  return std::any_of(fields.begin(), fields.end(), [](const YamlField& field) { return field.key == "goals"; });
}

}  // namespace vibe

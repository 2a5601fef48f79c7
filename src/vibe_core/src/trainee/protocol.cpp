#include "vibe_core/trainee/protocol.hpp"

#include <algorithm>

#include "trainee/protocol_reader.hpp"

namespace vibe {
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

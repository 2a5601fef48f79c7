#include "vibe_hardware/gamepad/pad_mapping.hpp"

#include "gamepad/pad_mapping_reader.hpp"
#include "vibe_core/common/package_path.hpp"

namespace vibe::hardware {
namespace {

constexpr YamlLimits kLimits{1 << 16, 8};

}  // namespace

ToolLimits loadToolLimits(const std::string& urdf_address) {
  const std::string file = resolveAddress(urdf_address);
  return ToolModel::fromUrdf(readTextFile(file, "URDF"), file).limits();
}

PadMapping loadPadMapping(const std::string& file, const ToolLimits& limits) {
  const YamlSource source = YamlSource::load(file, kLimits);
  return PadMappingReader(source, limits).read();
}

PadMapping parsePadMapping(const std::string& text, const std::string& place, const ToolLimits& limits) {
  const YamlSource source = YamlSource::parse(text, place, kLimits);
  return PadMappingReader(source, limits).read();
}

const char* jointUnit(int joint) {
  return joint == Insertion || joint == HelixAdvance || joint == NeedleDriver ? "m" : "rad";
}

}  // namespace vibe::hardware

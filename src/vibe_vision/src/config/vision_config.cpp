#include "vibe_vision/config/vision_config.hpp"

#include "config/config_reader.hpp"
#include "vibe_core/common/error.hpp"
#include "vibe_core/common/package_path.hpp"
#include "vibe_core/scene/nearest_key.hpp"

namespace vibe::vision {

VisionConfig VisionConfig::load(const std::string& address, AxisRule rule) {
  return ConfigReader(YamlSource::load(resolveAddress(address), {}), rule).read();
}

VisionConfig VisionConfig::parse(const std::string& yaml, const std::string& place, AxisRule rule) {
  return ConfigReader(YamlSource::parse(yaml, place, {}), rule).read();
}

std::size_t VisionConfig::indexOf(const std::string& instrument) const {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < instruments.size(); ++i) {
    if (instruments[i].name == instrument) return i;
    names.push_back(instruments[i].name);
  }
  throw Error("'" + instrument + "' is not an instrument of this configuration; " + suggestKey(instrument, names));
}

}  // namespace vibe::vision

#include "vibe_vision/calibrate/stop_list.hpp"

#include <filesystem>
#include <sstream>

#include "vibe_core/files/csv_row.hpp"
#include "vibe_core/files/files.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_core/scene/yaml_source.hpp"

namespace vibe::vision {
namespace {

constexpr double kLargestSlide = 1;  // [m]

}  // namespace

std::vector<StopImage> parseStopList(const std::string& text, const std::string& place) {
  const YamlSource quantities = YamlSource::parse("slide: 0\n", place, {});
  std::istringstream stream(text);
  std::vector<StopImage> stops;
  std::string line;
  bool header = false;
  for (int number = 1; std::getline(stream, line); ++number) {
    line = std::string(trimmed(line));
    if (line.empty() || line[0] == '#') continue;
    const std::size_t comma = line.rfind(',');
    const YamlField field{"slide", "slide", number,
                          YAML::Node(comma == std::string::npos ? "" : line.substr(comma + 1))};
    if (!header) {
      if (comma == std::string::npos || trimmed(line.substr(0, comma)) != "image" ||
          trimmed(line.substr(comma + 1)) != "slide")
        quantities.fail(field, "the list does not begin with the line 'image,slide'; write it above the first stop");
      header = true;
      continue;
    }
    const std::string image(comma == std::string::npos ? "" : trimmed(line.substr(0, comma)));
    if (image.empty()) quantities.fail(field, "is not an image and a slide; write for example stop_05.png,5 mm");
    const double slide = quantities.quantity(field, "m", -kLargestSlide, kLargestSlide);
    stops.push_back({(std::filesystem::path(place).parent_path() / image).string(), slide, number});
  }
  if (stops.empty()) throw Error(place + ": has no stops; write 'image,slide' and a line for each stop");
  return stops;
}

std::vector<StopImage> loadStopList(const std::string& file) {
  return parseStopList(readTextFile(file, "list of stops"), file);
}

}  // namespace vibe::vision

#include "config/config_reader.hpp"
#include "vibe_core/program/error.hpp"

// The part of ConfigReader that reads markers.

namespace vibe::vision {
namespace {

constexpr double kSmallest = 1e-5, kLargest = 0.2;  // of anything printed [m]

}  // namespace

MarkerDesign ConfigReader::readMarker(const YamlField& field) const {
  const std::vector<YamlField> fields = mapOf(field, {"ring", "sleeve", "apriltag", "aruco"}, {});
  if (fields.size() != 1) {
    source_.fail(field, "names " + std::to_string(fields.size()) +
                            " markers; write one of 'ring:', 'sleeve:', 'apriltag:' and 'aruco:'");
  }
  const YamlField& entry = fields.front();
  const MarkerDesign design = entry.key == "ring"     ? MarkerDesign(readRing(entry))
                              : entry.key == "sleeve" ? MarkerDesign(readSleeve(entry))
                                                      : MarkerDesign(readTag(entry));
  checkMarker(design, source_.place() + ":" + std::to_string(entry.line) + ": " + entry.path);
  return design;
}

RingDesign ConfigReader::readRing(const YamlField& field) const {
  RingDesign ring;
  for (const YamlField& entry : mapOf(field, {"outer_diameter", "inner_diameter", "side"}, {})) {
    const double value = source_.quantity(entry, "m", kSmallest, kLargest);
    if (entry.key == "outer_diameter") ring.outer_diameter = value;
    if (entry.key == "inner_diameter") ring.inner_diameter = value;
    if (entry.key == "side") ring.side = value;
  }
  return ring;
}

TagDesign ConfigReader::readTag(const YamlField& field) const {
  TagDesign tag;
  tag.family = field.key == "apriltag" ? TagFamily::AprilTag : TagFamily::Aruco;
  for (const YamlField& entry : mapOf(field, {"id", "side"}, {"id", "side"})) {
    if (entry.key == "id") tag.id = static_cast<int>(source_.integer(entry, 0, tagCount(tag.family) - 1));
    if (entry.key == "side") tag.side = source_.quantity(entry, "m", kSmallest, kLargest);
  }
  return tag;
}

SleeveDesign ConfigReader::readSleeve(const YamlField& field) const {
  SleeveDesign sleeve = defaultSleeve();
  for (const YamlField& entry : mapOf(field, {"diameter", "length", "bars", "helix"}, {})) {
    if (entry.key == "diameter") sleeve.diameter = source_.quantity(entry, "m", kSmallest, kLargest);
    if (entry.key == "length") sleeve.length = source_.quantity(entry, "m", kSmallest, kLargest);
    if (entry.key == "bars") sleeve.bars = readBars(entry);
    if (entry.key == "helix") readHelix(entry, sleeve);
  }
  return sleeve;
}

std::vector<Bar> ConfigReader::readBars(const YamlField& field) const {
  constexpr std::size_t kMaxBars = 100;
  const std::vector<YamlField> items = source_.list(field);
  if (items.size() > kMaxBars) source_.fail(field, "has more than 100 bars; a camera cannot tell so many apart");
  std::vector<Bar> bars;
  for (const YamlField& item : items) {
    const std::vector<double> ends = source_.quantities(item, 2, "m", -kLargest, kLargest);
    bars.push_back({ends[0], ends[1]});
  }
  return bars;
}

void ConfigReader::readHelix(const YamlField& field, SleeveDesign& sleeve) const {
  for (const YamlField& entry : mapOf(field, {"begin", "end", "pitch", "duty"}, {})) {
    if (entry.key == "begin") sleeve.helix_begin = source_.quantity(entry, "m", -kLargest, kLargest);
    if (entry.key == "end") sleeve.helix_end = source_.quantity(entry, "m", -kLargest, kLargest);
    if (entry.key == "pitch") sleeve.helix_pitch = source_.quantity(entry, "m", -kLargest, kLargest);
    if (entry.key == "duty") sleeve.helix_duty = source_.quantity(entry, "1", 0.01, 0.99);
  }
}

}  // namespace vibe::vision

#include "truth/label_table.hpp"

#include <algorithm>
#include <sstream>

#include "geometry/surface_colours.hpp"

namespace vibe::rviz_plugins {
namespace {

using Colour = std::array<std::uint8_t, 3>;

const char* const kRegionNames[kRegions] = {"cardia", "fundus", "body", "antrum", "pylorus"};
const char* const kWallNames[kWalls] = {"anterior", "greater curvature", "posterior", "lesser curvature"};
const char* const kHeatNames[kHeats] = {"none", "mark", "burn", "deep burn"};
constexpr Colour kHeatColours[kHeats] = {{0, 0, 0}, {245, 235, 205}, {110, 60, 30}, {25, 20, 20}};

LabelEntry entryOf(std::uint8_t number, const std::string& name, const Colour& colour) {
  LabelEntry entry;
  entry.number = number, entry.name = entry.object = name, entry.colour = colour;
  return entry;
}

/// The colour of the region, in four shades for the walls; heat covers it.
Colour wallColour(int region, int wall, int heat) {
  if (heat > 0) return kHeatColours[heat];
  const PackedColour packed = regionColours()[static_cast<std::size_t>(region)];
  Colour colour;
  for (std::size_t k = 0; k < 3; ++k)
    colour[k] = static_cast<std::uint8_t>(((packed >> (8 * k)) & 255U) * static_cast<unsigned>(10 - wall) / 10);
  return colour;
}

LabelEntry wallEntry(int region, int wall, int heat) {
  std::string name = std::string(kRegionNames[region]) + " " + kWallNames[wall];
  if (heat > 0) name += std::string(" ") + kHeatNames[heat];
  LabelEntry entry = entryOf(wallLabel(region, wall, heat), name, wallColour(region, wall, heat));
  entry.object = "wall";
  entry.region = kRegionNames[region], entry.wall = kWallNames[wall], entry.heat = kHeatNames[heat];
  return entry;
}

LabelEntry plainWallEntry(int heat) {
  const std::string name = heat == 0 ? "wall" : std::string("wall ") + kHeatNames[heat];
  LabelEntry entry = entryOf(wallLabel(-1, -1, heat), name, heat == 0 ? Colour{215, 120, 110} : kHeatColours[heat]);
  entry.object = "wall", entry.heat = kHeatNames[heat];
  return entry;
}

/// Greys and blues that differ from part to part.
LabelEntry partEntry(std::size_t k, const std::string& name) {
  const auto level = static_cast<std::uint8_t>(90 + 37 * k % 120);
  const auto blue = static_cast<std::uint8_t>(110 + 61 * k % 140);
  LabelEntry entry = entryOf(static_cast<std::uint8_t>(kLabelInstrument + k), name, {level, level, blue});
  entry.object = "instrument";
  return entry;
}

}  // namespace

std::uint8_t wallLabel(int region, int wall, int heat) {
  heat = std::clamp(heat, 0, kHeats - 1);
  if (region < 0 || region >= kRegions || wall < 0 || wall >= kWalls)
    return static_cast<std::uint8_t>(kLabelPlainWall + heat);
  return static_cast<std::uint8_t>(kLabelWall + kRegions * kWalls * heat + kWalls * region + wall);
}

std::vector<LabelEntry> labelTable(const std::vector<std::string>& parts) {
  std::vector<LabelEntry> table{entryOf(kLabelNothing, "nothing", {0, 0, 0})};
  for (int heat = 0; heat < kHeats; ++heat)
    for (int region = 0; region < kRegions; ++region)
      for (int wall = 0; wall < kWalls; ++wall) table.push_back(wallEntry(region, wall, heat));
  for (int heat = 0; heat < kHeats; ++heat) table.push_back(plainWallEntry(heat));
  table.push_back(entryOf(kLabelOuterWall, "outer wall", {150, 110, 120}));
  table.push_back(entryOf(kLabelThread, "thread", {40, 90, 255}));
  table.push_back(entryOf(kLabelTag, "t-tag", {0, 230, 230}));
  table.push_back(entryOf(kLabelCinch, "cinch", {255, 255, 0}));
  table.push_back(entryOf(kLabelBlood, "blood", {220, 0, 0}));
  for (std::size_t k = 0; k < parts.size(); ++k) table.push_back(partEntry(k, parts[k]));
  return table;
}

std::string labelText(const std::vector<LabelEntry>& table) {
  std::ostringstream text;
  text << "[\n";
  for (const LabelEntry& entry : table) {
    text << "{\"number\": " << int{entry.number} << ", \"name\": \"" << entry.name << "\", \"object\": \""
         << entry.object << "\", ";
    for (const auto& [key, value] : {std::pair("region", entry.region), {"wall", entry.wall}, {"heat", entry.heat}})
      if (!value.empty()) text << "\"" << key << "\": \"" << value << "\", ";
    text << "\"colour\": [" << int{entry.colour[0]} << ", " << int{entry.colour[1]} << ", " << int{entry.colour[2]}
         << "]}" << (&entry == &table.back() ? "\n" : ",\n");
  }
  text << "]\n";
  return text.str();
}

}  // namespace vibe::rviz_plugins

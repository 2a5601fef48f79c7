#include "truth/label_table.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "vibe_graphics/geometry/surface_colours.hpp"

namespace vibe::endoscope {

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
  const graphics::PackedColour packed = graphics::regionColours()[static_cast<std::size_t>(region)];
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

namespace {

/// Calls `use(particle, weight)` for the particles that carry a vertex.
template <class Use>
void forCarriers(const graphics::TissueMesh& mesh, std::size_t vertex, Use use) {
  if (!mesh.subdivided()) return use(static_cast<std::uint32_t>(vertex), 1.0F);
  for (std::uint32_t k = mesh.render_offsets[vertex]; k < mesh.render_offsets[vertex + 1]; ++k)
    use(mesh.render_particles[k], mesh.render_weights[k]);
}

/// The number with the largest share among the particles that carry a vertex; -1 if none is known.
std::int8_t prevailing(const graphics::TissueMesh& mesh, std::size_t vertex, const std::vector<std::uint8_t>& numbers,
                       int count) {
  std::array<float, kRegions> share{};
  if (numbers.empty()) return -1;
  forCarriers(mesh, vertex, [&](std::uint32_t particle, float weight) {
    if (numbers[particle] < count) share[numbers[particle]] += weight;
  });
  const auto largest = std::max_element(share.begin(), share.end());
  return *largest > 0 ? static_cast<std::int8_t>(largest - share.begin()) : std::int8_t{-1};
}

/// The label of a wall with heat, from that without.
std::uint8_t hotLabel(std::uint8_t cold, int heat) {
  const int step = cold >= kLabelPlainWall ? 1 : kRegions * kWalls;
  return static_cast<std::uint8_t>(cold + step * std::min(heat, kHeats - 1));
}

}  // namespace

void WallLabels::setMesh(const graphics::TissueMesh& mesh) {
  cold_.resize(mesh.vertex_count);
  for (std::size_t v = 0; v < mesh.vertex_count; ++v)
    cold_[v] = wallLabel(prevailing(mesh, v, mesh.region, kRegions), prevailing(mesh, v, mesh.wall, kWalls), 0);
  grade_.clear(), heat_.clear();
}

void WallLabels::setFrame(const graphics::TissueMesh& mesh, const graphics::TissueFrame& frame) {
  if (frame.grade == grade_) return;  // burns are rare
  grade_ = frame.grade;
  const bool cold = std::all_of(grade_.begin(), grade_.end(), [](std::uint8_t grade) { return grade == 0; });
  heat_.assign(cold ? 0 : mesh.vertex_count, 0.0F);
  for (std::size_t v = 0; v < heat_.size(); ++v)
    forCarriers(mesh, v, [&](std::uint32_t particle, float weight) {
      heat_[v] += weight * static_cast<float>(grade_[particle]);
    });
}

std::uint8_t WallLabels::at(const std::uint32_t* corner, const std::array<float, 3>& weight) const {
  std::size_t nearest = weight[1] > weight[0] ? 1 : 0;
  if (weight[2] > weight[nearest]) nearest = 2;
  const std::uint8_t cold = cold_[corner[nearest]];
  if (heat_.empty()) return cold;
  float heat = 0;
  for (std::size_t k = 0; k < 3; ++k) heat += weight[k] * heat_[corner[k]];
  return hotLabel(cold, static_cast<int>(std::lround(heat)));
}

}  // namespace vibe::endoscope

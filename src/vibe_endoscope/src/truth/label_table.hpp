#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "vibe_graphics/geometry/tissue_mesh.hpp"

namespace vibe::endoscope {

// Numbers of what a pixel shows. They are stable: a number is never given another meaning.
constexpr std::uint8_t kLabelNothing = 0;       ///< outside of the circle, or nothing is there
constexpr std::uint8_t kLabelWall = 1;          ///< first of 80: 1 + 20 * heat + 4 * region + wall
constexpr std::uint8_t kLabelPlainWall = 81;    ///< first of 4: 81 + heat, where the topology tells no anatomy
constexpr std::uint8_t kLabelOuterWall = 90;    ///< the wall seen from outside of the lumen
constexpr std::uint8_t kLabelThread = 100;      ///< thread of a suture
constexpr std::uint8_t kLabelTag = 101;         ///< T-tag
constexpr std::uint8_t kLabelCinch = 102;       ///< cinch
constexpr std::uint8_t kLabelBlood = 103;       ///< blood, fresh or clotted
constexpr std::uint8_t kLabelInstrument = 128;  ///< first part of the instrument; the others follow
constexpr std::uint8_t kLabelLast = 254;        ///< last number of a part of the instrument

constexpr int kHeats = 4, kRegions = 5, kWalls = 4;

/// Number of the inside of the wall. A region or wall that does not exist gives a wall without anatomy.
/// @param region, wall  REGION_* and WALL_* of vibe_msgs/TissueTopology; -1: unknown
/// @param heat          0 none, 1 mark, 2 burn scar, 3 muscularis at risk
std::uint8_t wallLabel(int region, int wall, int heat);

/// One row of the table of labels.
struct LabelEntry {
  std::uint8_t number = 0;
  std::string name;    ///< unique, "body posterior mark"
  std::string object;  ///< "nothing", "wall", "outer wall", "thread", "t-tag", "cinch", "blood", "instrument"
  std::string region, wall, heat;        ///< of the wall; empty elsewhere
  std::array<std::uint8_t, 3> colour{};  ///< for viewing: red, green, blue
};

/// All labels, by number.
/// @param parts  names of the parts of the instrument, in the order of their numbers from kLabelInstrument
std::vector<LabelEntry> labelTable(const std::vector<std::string>& parts);

/// The table as YAML, one row a line; it is JSON too.
std::string labelText(const std::vector<LabelEntry>& table);

/// Region, wall and heat of every point of the drawn surface of the organ.
///
/// A vertex has the region and the wall that have the largest share of the particles that carry it, and the mean of
/// their grades of heat. Within a triangle, region and wall are those of the nearest corner (the largest barycentric
/// coordinate), and the grade is interpolated and rounded: the colour is drawn from the same interpolated value.
class WallLabels {
 public:
  void setMesh(const graphics::TissueMesh& mesh);
  void setFrame(const graphics::TissueMesh& mesh, const graphics::TissueFrame& frame);
  /// @param corner  vertices of the triangle
  /// @param weight  barycentric coordinates of the point
  std::uint8_t at(const std::uint32_t* corner, const std::array<float, 3>& weight) const;

 private:
  std::vector<std::uint8_t> cold_;   // per vertex: its label without heat
  std::vector<std::uint8_t> grade_;  // per particle, of the last frame
  std::vector<float> heat_;          // per vertex; empty: no heat anywhere
};

}  // namespace vibe::endoscope

#pragma once

#include <map>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace vibe::web {

/// A robot as a page needs it, and the files that it asks for.
struct RobotText {
  nlohmann::json json;                         ///< {links: [...], visuals: [...]}, see readRobot()
  std::map<std::string, std::string> meshes;   ///< path below the server -> file on this machine
  std::map<std::string, std::size_t> folders;  ///< of the files, and their numbers in the paths
  std::vector<std::string> problems;           ///< one sentence for each part that is missing
};

/// Reads a URDF.
///   links: {name, parent, joint, type, place [x y z], turn [x y z w], axis, and mimic {joint, factor, offset} where a
///   joint follows another one};
///   visuals: {link, place, turn, scale, colour [r g b], and one of mesh (path), sphere [radius],
///   cylinder [radius, length], box [x y z]; of a mesh also capsules [x y z, x y z, radius], which
///   cast its shadow}.
/// Meshes are Wavefront OBJ, with their material files beside them.
/// @throws std::runtime_error  it cannot be read
RobotText readRobot(const std::string& description);

/// What else does not change: the lens and the exposure of the endoscope's picture (vibe_graphics), the keys of the
/// tool 'Drive scope', and how long a page that drives may be silent.
nlohmann::json constantText();

}  // namespace vibe::web

#pragma once
#include <cstdio>
#include <string>

#include "vibe_core/program/command_line.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_core/scene/yaml_source.hpp"
#include "vibe_vision/sheet/marker_sheet.hpp"

namespace vibe::vision {

/// "5 mm" or "0.005" as metres, up to what fits on a sheet: "5" is 5 m, a unit that was forgotten. @throws Error that
/// names the option
inline double lengthOption(const std::string& option, const std::string& text) {
  const YamlSource source = YamlSource::parse("value: 0\n", option, {});
  try {
    return source.quantity({"", "", 1, YAML::Node(text)}, "m", 0, 0.3);
  } catch (const Error& error) {
    throw Error(option + std::string(error.what()).substr(option.size() + 2));  // an option has no lines
  }
}

/// "9x6" and "5 mm". @throws Error
inline BoardSpec boardOption(const std::string& corners, const std::string& square) {
  BoardSpec board;
  char rest = 0;
  if (std::sscanf(corners.c_str(), "%dx%d%c", &board.columns, &board.rows, &rest) != 2) {
    throw Error("--board: '" + corners + "' is not a chessboard; give its inner corners, for example 9x6");
  }
  board.square = lengthOption("--square", square);
  return board;
}

}  // namespace vibe::vision

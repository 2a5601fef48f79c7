#pragma once
#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <functional>
#include <string>
#include <vector>

#include "vibe_core/common/error.hpp"
#include "vibe_core/scene/yaml_source.hpp"
#include "vibe_vision/sheet/marker_sheet.hpp"

namespace vibe::vision {

/// "5 mm" or "0.005" as metres. @throws Error that names the option
inline double lengthOption(const std::string& option, const std::string& text) {
  const YamlSource source = YamlSource::parse("value: 0\n", option, {});
  try {
    return source.quantity({"", "", 1, YAML::Node(text)}, "m", 0, 10);
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

/// Accepts numbers from min to max. CLI::Range accepts NaN.
inline CLI::Validator finiteIn(double min, double max) {
  const auto check = [min, max](const std::string& text) {
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    char limits[80];
    std::snprintf(limits, sizeof limits, "' is not a number from %g to %g", min, max);
    return !text.empty() && *end == 0 && value >= min && value <= max ? std::string() : "'" + text + limits;
  };
  return CLI::Validator(check, "");
}

/// What is wrong with a command line. Unknown words come first: one may be the misspelt name of a required option.
inline std::string describeWrongCall(const CLI::App& app, const CLI::ParseError& error) {
  const std::vector<std::string> unknown = app.remaining(true);
  if (unknown.empty()) return std::string(error.what()) + "; see --help.";
  const std::string& word = unknown.front();
  return word.compare(0, 1, "-") == 0 ? "Option '" + word + "' is unknown; see --help."
                                      : "'" + word + "' is not an option; see --help.";
}

/// Parses the command line and runs. Wrong options and errors end with status 2 and one sentence.
inline int runProgram(const char* name, CLI::App& app, int argc, char** argv, const std::function<int()>& run) {
  app.name(name);  // instead of the path of the program in the help text
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& help) {
    return app.exit(help);
  } catch (const CLI::ParseError& error) {
    std::fprintf(stderr, "%s: %s\n", name, describeWrongCall(app, error).c_str());
    return 2;
  }
  try {
    return run();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", name, error.what());
    return 2;
  }
}

}  // namespace vibe::vision

#include "vibe_core/common/command_line.hpp"

#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <string>

#include "vibe_core/common/error.hpp"

namespace vibe {

namespace {

constexpr std::size_t kColumn = 22;  // column where the description of an option begins

// unknown words come first: one may be the misspelt name of a required option
std::string sentenceFor(const CLI::App& app, const CLI::ParseError& error) {
  const std::vector<std::string> unknown = app.remaining();
  if (unknown.empty()) return std::string(error.what()) + "; see --help.";
  const std::string& word = unknown.front();
  return word.compare(0, 1, "-") == 0 ? "Option '" + word + "' is unknown; see --help."
                                      : "'" + word + "' is not an option; see --help.";
}

/// Whether to continue; false if only the help text was requested.
bool parse(CLI::App& app, int argc, const char* const* argv) {
  app.set_help_flag("--help", "print this text and end");
  app.get_formatter()->column_width(kColumn);
  try {
    app.parse(argc, argv);
    return true;
  } catch (const CLI::CallForHelp&) {
    std::cout << app.help();
    return false;
  } catch (const CLI::ParseError& error) {
    throw Error(sentenceFor(app, error));
  }
}

}  // namespace

int runProgram(CLI::App& app, int argc, const char* const* argv, const std::function<void()>& work) {
  try {
    if (parse(app, argc, argv)) work();
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", app.get_name().c_str(), error.what());
    return 2;
  }
}

CLI::Validator finiteFrom(double min) {
  const auto check = [min](const std::string& text) {
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    const bool accepted = !text.empty() && *end == '\0' && std::isfinite(value) && value >= min;
    return accepted ? std::string() : "'" + text + "' is not a number of at least " + CLI::detail::to_string(min);
  };
  return CLI::Validator(check, "");
}

CLI::Validator wholeFrom(long min, long max) {
  const auto check = [min, max](const std::string& text) {
    char* end = nullptr;
    errno = 0;
    const long value = std::strtol(text.c_str(), &end, 10);
    const bool accepted = !text.empty() && *end == '\0' && errno == 0 && value >= min && value <= max;
    return accepted ? std::string()
                    : "'" + text + "' is not a whole number from " + std::to_string(min) + " to " + std::to_string(max);
  };
  return CLI::Validator(check, "");
}

}  // namespace vibe

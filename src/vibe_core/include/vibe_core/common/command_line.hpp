#pragma once

#include <functional>

#include <CLI/CLI.hpp>

namespace vibe {

/// Main function of a command-line program: parses the options of `app` and calls `work`. With --help it prints the
/// help text instead. An error in the command line or in `work` is printed to standard error as one sentence after the
/// name of the program.
/// @param app  options and positional arguments bound to variables that `work` uses; its name is that of the program
/// @returns the exit status: 0, or 2 after an error
int runProgram(CLI::App& app, int argc, const char* const* argv, const std::function<void()>& work);

/// Accepts finite numbers of at least `min`.
CLI::Validator finiteFrom(double min);

/// Accepts whole numbers from `min` to `max`.
CLI::Validator wholeFrom(long min, long max);

}  // namespace vibe

#include "vibe_core/program/command_line.hpp"

#include <CLI/CLI.hpp>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <limits>
#include <optional>

namespace vibe {

namespace {

constexpr std::size_t kColumn = 22;  // column where the description of an option begins

/// As CLI11 checks and describes it.
OptionCheck checkOf(CLI::Validator validator) {
  std::string shown = validator.get_description();
  return {[validator = std::move(validator)](const std::string& text) { return validator(text); }, std::move(shown)};
}

/// A text that `read` accepts in all its length.
template <class Value, class Read, class Within>
OptionCheck numberCheck(Read read, Within within, std::string wanted) {
  return {[=](const std::string& text) -> std::string {
    char* end = nullptr;
    errno = 0;
    const Value value = read(text.c_str(), &end);
    const bool accepted = !text.empty() && *end == '\0' && errno != ERANGE && within(value);
    return accepted ? "" : "'" + text + "' is not a " + wanted;
  }};
}

OptionCheck finite(double min, double max, const std::string& wanted) {
  return numberCheck<double>([](const char* text, char** end) { return std::strtod(text, end); },
                             [=](double x) { return std::isfinite(x) && x >= min && x <= max; }, wanted);
}

/// "Option '--x' is unknown; see --help." if there is an unknown word, since that may be the misspelt name of a
/// required option; otherwise what the error says.
std::string sentenceOf(const CLI::ParseError& error, const std::vector<std::string>& unknown) {
  if (unknown.empty()) return std::string(error.what()) + "; see --help.";
  const std::string word = "'" + unknown.front() + "' is ";
  return (unknown.front()[0] == '-' ? "Option " + word + "unknown" : word + "not an option") + "; see --help.";
}

}  // namespace

OptionCheck finiteFrom(double min) {
  return finite(min, std::numeric_limits<double>::max(), "number of at least " + CLI::detail::to_string(min));
}

OptionCheck finiteIn(double min, double max) {
  char wanted[80];
  std::snprintf(wanted, sizeof wanted, "number from %g to %g", min, max);
  return finite(min, max, wanted);
}

OptionCheck wholeFrom(long min, long max) {
  return numberCheck<long>([](const char* text, char** end) { return std::strtol(text, end, 10); },
                           [=](long x) { return x >= min && x <= max; },
                           "whole number from " + std::to_string(min) + " to " + std::to_string(max));
}

OptionCheck wholeNumber() {
  return {[](const std::string& text) -> std::string {
    std::uint64_t value = 0;
    const char* const last = text.data() + text.size();
    const auto [end, error] = std::from_chars(text.data(), last, value);
    if (end != last || error == std::errc::invalid_argument)
      return "'" + text + "' is not a whole number of at least 0";
    if (error == std::errc::result_out_of_range)
      return "'" + text + "' is too large; write at most " + std::to_string(std::numeric_limits<std::uint64_t>::max());
    return "";
  }};
}

OptionCheck inRange(int min, int max) {
  return checkOf(CLI::Range(min, max));
}

OptionCheck inRange(double min, double max) {
  return checkOf(CLI::Range(min, max));
}

OptionCheck oneOf(const std::vector<std::string>& words) {
  return checkOf(CLI::IsMember(words));
}

CommandOption& CommandOption::typeName(const std::string& name) {
  option_->type_name(name);
  return *this;
}

CommandOption& CommandOption::check(const OptionCheck& check) {
  option_->check(
      CLI::Validator([complaint = check.complaint](std::string& text) { return complaint(text); }, check.shown));
  return *this;
}

CommandOption& CommandOption::required() {
  option_->required();
  return *this;
}

CommandOption& CommandOption::expected(int count) {
  option_->expected(count);
  return *this;
}

CommandOption& CommandOption::expected(int least, int most) {
  option_->expected(least, most);
  return *this;
}

CommandOption& CommandOption::showDefault() {
  option_->capture_default_str();
  return *this;
}

CommandOption& CommandOption::withoutValue(const std::string& text) {
  option_->default_str(text);
  return *this;
}

template <class Value>
CommandOption OptionList::option(const std::string& name, Value& value, const std::string& about) {
  return CommandOption(*app_->add_option(name, value, about));
}

template CommandOption OptionList::option(const std::string&, int&, const std::string&);
template CommandOption OptionList::option(const std::string&, double&, const std::string&);
template CommandOption OptionList::option(const std::string&, std::uint64_t&, const std::string&);
template CommandOption OptionList::option(const std::string&, std::string&, const std::string&);
template CommandOption OptionList::option(const std::string&, std::vector<int>&, const std::string&);
template CommandOption OptionList::option(const std::string&, std::vector<double>&, const std::string&);
template CommandOption OptionList::option(const std::string&, std::vector<std::uint64_t>&, const std::string&);
template CommandOption OptionList::option(const std::string&, std::vector<std::string>&, const std::string&);
template CommandOption OptionList::option(const std::string&, std::optional<double>&, const std::string&);
template CommandOption OptionList::option(const std::string&, std::optional<std::uint64_t>&, const std::string&);

CommandOption OptionList::flag(const std::string& name, bool& value, const std::string& about) {
  return CommandOption(*app_->add_flag(name, value, about));
}

OptionList OptionList::oneRequired(const std::string& title) {
  return OptionList(*app_->add_option_group(title)->require_option(1));
}

OptionList OptionList::subcommand(const std::string& name, const std::string& about) {
  return OptionList(*app_->add_subcommand(name, about));
}

void OptionList::requireSubcommand() {
  app_->require_subcommand(1);
}

void OptionList::footer(const std::string& text) {
  app_->footer(text);
}

bool OptionList::isChosen() const {
  return app_->parsed();
}

bool OptionList::isGiven(const std::string& name) const {
  return app_->count(name) > 0;
}

CommandLine::CommandLine(const std::string& about, const std::string& name)
    : CommandLine(std::make_unique<CLI::App>(about, name)) {}

CommandLine::CommandLine(std::unique_ptr<CLI::App> app) : OptionList(*app), owned_(std::move(app)) {}

CommandLine::~CommandLine() = default;

int CommandLine::run(int argc, const char* const* argv, const std::function<int()>& work) {
  std::signal(SIGXFSZ, SIG_IGN);  // a limit on the size of files is then an error like a full disk
  app_->set_help_flag("-h,--help", "print this text and end");
  app_->get_formatter()->column_width(kColumn);
  std::string problem;
  try {
    app_->parse(argc, argv);
    return work();
  } catch (const CLI::Success&) {
    std::cout << app_->help() << std::flush;
    return 0;
  } catch (const CLI::ParseError& error) {
    problem = sentenceOf(error, app_->remaining(true));
  } catch (const std::exception& error) {
    problem = error.what();
  }
  std::fprintf(stderr, "%s: %s\n", app_->get_name().c_str(), problem.c_str());
  return 2;
}

}  // namespace vibe

#include "vibe_core/program/command_line.hpp"

#include <CLI/CLI.hpp>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <limits>
#include <optional>

#include "vibe_core/program/error.hpp"

namespace vibe {

namespace {

constexpr std::size_t kColumn = 22;  // column where the description of an option begins

OptionCheck described(CLI::Validator validator) {
  return OptionCheck(std::make_shared<const CLI::Validator>(std::move(validator)));
}

std::string first(const std::vector<std::string>& words) {
  return words.empty() ? "" : words.front();
}

}  // namespace

OptionCheck::OptionCheck(const std::function<std::string(const std::string&)>& complaint)
    : validator_(
          std::make_shared<const CLI::Validator>([complaint](std::string& text) { return complaint(text); }, "")) {}

OptionCheck OptionCheck::hidden() const {
  CLI::Validator validator = *validator_;
  return described(validator.description(""));
}

std::string OptionCheck::complaint(const std::string& text) const {
  return (*validator_)(text);
}

OptionCheck finiteFrom(double min) {
  return OptionCheck([min](const std::string& text) {
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    const bool accepted = !text.empty() && *end == '\0' && std::isfinite(value) && value >= min;
    return accepted ? std::string() : "'" + text + "' is not a number of at least " + CLI::detail::to_string(min);
  });
}

OptionCheck finiteIn(double min, double max) {
  return OptionCheck([min, max](const std::string& text) {
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    char limits[80];
    std::snprintf(limits, sizeof limits, "' is not a number from %g to %g", min, max);
    return !text.empty() && *end == 0 && value >= min && value <= max ? std::string() : "'" + text + limits;
  });
}

OptionCheck wholeFrom(long min, long max) {
  return OptionCheck([min, max](const std::string& text) {
    char* end = nullptr;
    errno = 0;
    const long value = std::strtol(text.c_str(), &end, 10);
    const bool accepted = !text.empty() && *end == '\0' && errno == 0 && value >= min && value <= max;
    return accepted ? std::string()
                    : "'" + text + "' is not a whole number from " + std::to_string(min) + " to " + std::to_string(max);
  });
}

OptionCheck wholeNumber() {
  return OptionCheck([](const std::string& text) -> std::string {
    std::uint64_t value = 0;
    const char* const last = text.data() + text.size();
    const auto [end, error] = std::from_chars(text.data(), last, value);
    if (end != last || error == std::errc::invalid_argument)
      return "'" + text + "' is not a whole number of at least 0";
    if (error == std::errc::result_out_of_range)
      return "'" + text + "' is too large; write at most " + std::to_string(std::numeric_limits<std::uint64_t>::max());
    return "";
  });
}

OptionCheck inRange(int min, int max) {
  return described(CLI::Range(min, max));
}

OptionCheck inRange(double min, double max) {
  return described(CLI::Range(min, max));
}

OptionCheck oneOf(const std::vector<std::string>& words) {
  return described(CLI::IsMember(words));
}

CommandOption& CommandOption::typeName(const std::string& name) {
  option_->type_name(name);
  return *this;
}

CommandOption& CommandOption::check(const OptionCheck& check) {
  option_->check(check.validator());
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

std::string usageSentence(const UsageError& error, const std::string& unknown) {
  if (unknown.empty()) return std::string(error.what()) + "; see --help.";
  return unknown.compare(0, 1, "-") == 0 ? "Option '" + unknown + "' is unknown; see --help."
                                         : "'" + unknown + "' is not an option; see --help.";
}

CommandLine::CommandLine(const std::string& about, const std::string& name)
    : CommandLine(std::make_unique<CLI::App>(about, name)) {}

CommandLine::CommandLine(std::unique_ptr<CLI::App> app) : OptionList(*app), owned_(std::move(app)) {}

CommandLine::~CommandLine() = default;

std::string CommandLine::name() const {
  return app_->get_name();
}

void CommandLine::setHelp(const std::string& flags, const std::string& about) {
  app_->set_help_flag(flags, about);
}

void CommandLine::setColumn(std::size_t column) {
  app_->get_formatter()->column_width(column);
}

bool CommandLine::parse(int argc, const char* const* argv) {
  try {
    app_->parse(argc, argv);
    return true;
  } catch (const CLI::Success&) {
    std::cout << app_->help() << std::flush;
    return false;
  } catch (const CLI::ParseError& error) {
    throw UsageError(error.what(), first(app_->remaining()), first(app_->remaining(true)));
  }
}

int runProgram(CommandLine& line, int argc, const char* const* argv, const std::function<void()>& work) {
  line.setHelp("--help", "print this text and end");
  line.setColumn(kColumn);
  try {
    if (line.parse(argc, argv)) work();
    return 0;
  } catch (const UsageError& error) {
    std::fprintf(stderr, "%s: %s\n", line.name().c_str(), usageSentence(error, error.unknown).c_str());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", line.name().c_str(), error.what());
  }
  return 2;
}

}  // namespace vibe

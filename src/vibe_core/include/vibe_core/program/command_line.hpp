#pragma once
#include <functional>
#include <memory>
#include <string>
#include <type_traits>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace vibe {

// Command lines of programs. CLI11 reads them; it is compiled in the library only, since its headers cost each program
// several seconds.

/// What the text of a value must be.
struct OptionCheck {
  std::function<std::string(const std::string&)> complaint;  ///< what is wrong with a text; empty: nothing is
  std::string shown = {};                                    ///< what it accepts, in the help text

  /// The same, without a word in the help text.
  OptionCheck hidden() const { return {complaint, {}}; }
};

/// Accepts finite numbers of at least `min`.
OptionCheck finiteFrom(double min);
/// Accepts finite numbers from `min` to `max`.
OptionCheck finiteIn(double min, double max);
/// Accepts whole numbers from `min` to `max`.
OptionCheck wholeFrom(long min, long max);
/// Accepts the whole numbers of a std::uint64_t, in decimal digits.
OptionCheck wholeNumber();
/// Accepts whole numbers from `min` to `max` and shows the range in the help text.
OptionCheck inRange(int min, int max);
/// The same for any numbers; accepts NaN as well.
OptionCheck inRange(double min, double max);
/// Accepts these words and shows them in the help text.
OptionCheck oneOf(const std::vector<std::string>& words);

/// An option that is being described. Each function returns the option itself.
class CommandOption {
 public:
  /// @param option  must outlive this; the CLI11 application that it was added to owns it
  explicit CommandOption(CLI::Option& option) : option_(&option) {}
  CommandOption& typeName(const std::string& name);      ///< of its value, in the help text
  CommandOption& check(const OptionCheck& check);        ///< one more condition that each of its values must meet
  CommandOption& required();                             ///< without it the command line is an error
  CommandOption& expected(int count);                    ///< of values
  CommandOption& expected(int least, int most);          ///< the same, from the least to the greatest number
  CommandOption& showDefault();                          ///< the present value of the variable, in the help text
  CommandOption& withoutValue(const std::string& text);  ///< its value when it is given without one

 private:
  CLI::Option* option_;
};

/// Options that belong together: those of a program, of a subcommand, or of which one must be chosen.
class OptionList {
 public:
  /// @param app  must outlive this and whatever is made from it
  explicit OptionList(CLI::App& app) : app_(&app) {}

  /// An option `--name` or a positional argument `name`, bound to a variable that keeps its value if it is not given.
  /// Value is int, double, std::uint64_t or std::string, a std::vector of these, or a std::optional<double> or
  /// std::optional<std::uint64_t>.
  template <class Value>
  CommandOption option(const std::string& name, Value& value, const std::string& about);
  /// An option without a value: the variable becomes true where it is given and keeps what it holds where it is not.
  CommandOption flag(const std::string& name, bool& value, const std::string& about);

  /// Options of which exactly one must be given. @param title  in the help text
  OptionList oneRequired(const std::string& title);
  /// Options of its own, which follow the word `name` on the command line; isChosen() says whether it was there.
  OptionList subcommand(const std::string& name, const std::string& about);
  void requireSubcommand();              ///< exactly one subcommand must be named
  void footer(const std::string& text);  ///< behind the options in the help text

  bool isChosen() const;                        ///< a subcommand: it was named
  bool isGiven(const std::string& name) const;  ///< an option

 protected:
  CLI::App* app_;
};

/// The command line of a program.
class CommandLine : public OptionList {
 public:
  /// @param name  of the program in the help text and before errors; empty: as it was called
  explicit CommandLine(const std::string& about, const std::string& name = "");
  ~CommandLine();
  CommandLine(const CommandLine&) = delete;
  CommandLine& operator=(const CommandLine&) = delete;

  /// @see runProgram()
  int run(int argc, const char* const* argv, const std::function<int()>& work);

 private:
  std::unique_ptr<CLI::App> owned_;

  explicit CommandLine(std::unique_ptr<CLI::App> app);
};

/// Main function of a command-line program: parses the options and calls `work`. With --help it prints the help text
/// instead. An error in the command line or in `work` is printed to standard error as one sentence after the name of
/// the program.
/// @param line  options and positional arguments bound to variables that `work` uses
/// @returns the exit status: what `work` returns, 0 if it returns nothing, or 2 after an error
template <class Work>
int runProgram(CommandLine& line, int argc, const char* const* argv, const Work& work) {
  return line.run(argc, argv, [&work]() -> int {
    if constexpr (!std::is_void_v<decltype(work())>) return work();
    work();
    return 0;
  });
}

}  // namespace vibe

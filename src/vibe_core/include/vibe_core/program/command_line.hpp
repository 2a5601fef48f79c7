#pragma once
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
class Validator;
}  // namespace CLI

namespace vibe {

// Command lines of programs. CLI11 reads them; it is compiled in the library only, since its headers cost each program
// several seconds.

/// What the text of a value must be.
class OptionCheck {
 public:
  /// @param complaint  says what is wrong with a text; empty: nothing is
  explicit OptionCheck(const std::function<std::string(const std::string&)>& complaint);
  /// @param validator  of CLI11, not null
  explicit OptionCheck(std::shared_ptr<const CLI::Validator> validator) : validator_(std::move(validator)) {}

  /// The same, without its description in the help text.
  OptionCheck hidden() const;
  /// @return what is wrong with a text; empty: nothing is
  std::string complaint(const std::string& text) const;
  const CLI::Validator& validator() const { return *validator_; }  ///< of CLI11; lives as long as this or a copy of it

 private:
  std::shared_ptr<const CLI::Validator> validator_;
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

/// A command line that is not as described; what() says how, without a full stop.
class UsageError : public std::runtime_error {
 public:
  /// @param own, any  become `unknown` and `unknown_anywhere`
  UsageError(const std::string& what, std::string own, std::string any)
      : std::runtime_error(what), unknown(std::move(own)), unknown_anywhere(std::move(any)) {}
  std::string unknown;           ///< first word that the program does not know; empty: none
  std::string unknown_anywhere;  ///< the same, words behind a subcommand included
};

/// "Option '--x' is unknown; see --help." if there is an unknown word, since that may be the misspelt name of a
/// required option; otherwise what the error says.
std::string usageSentence(const UsageError& error, const std::string& unknown);

/// The command line of a program.
class CommandLine : public OptionList {
 public:
  /// @param name  of the program in the help text; empty: as it was called
  explicit CommandLine(const std::string& about, const std::string& name = "");
  ~CommandLine();
  CommandLine(const CommandLine&) = delete;
  CommandLine& operator=(const CommandLine&) = delete;

  /// As given to the constructor; otherwise how the program was called, which is known from parse() on.
  std::string name() const;
  /// Instead of -h and --help.
  void setHelp(const std::string& flags, const std::string& about);
  void setColumn(std::size_t column);  ///< where descriptions begin in the help text

  /// @return whether to go on; false: the help text was asked for and has been printed
  /// @throws UsageError
  bool parse(int argc, const char* const* argv);

 private:
  std::unique_ptr<CLI::App> owned_;

  explicit CommandLine(std::unique_ptr<CLI::App> app);
};

/// Main function of a command-line program: parses the options and calls `work`. With --help it prints the help text
/// instead. An error in the command line or in `work` is printed to standard error as one sentence after the name of
/// the program.
/// @param line  options and positional arguments bound to variables that `work` uses; its name is that of the program
/// @returns the exit status: 0, or 2 after an error
int runProgram(CommandLine& line, int argc, const char* const* argv, const std::function<void()>& work);

}  // namespace vibe

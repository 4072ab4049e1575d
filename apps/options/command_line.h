// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace artus {

/// What a flag's value must be: `problem` says what is wrong with a text (empty: nothing), `wanted`
/// stands in --help.
struct FlagCheck {
  std::function<std::string(const std::string&)> problem;
  std::string wanted;
};

/// A flag or an argument of a command, as it was added; what follows refines it.
class Option {
 public:
  explicit Option(CLI::Option* option) : option_(option) {}
  Option* required(bool value = true);
  Option* check(const FlagCheck& check);
  Option* one_of(const std::vector<std::string>& values);
  /// --help shows the value that the variable has now.
  Option* capture_default_str();
  Option* group(const std::string& heading);
  Option* description(const std::string& text);
  /// Takes so many values.
  Option* expected(int count);
  /// Makes sense with `other` alone.
  Option* needs(const Option* other);

 private:
  CLI::Option* option_;
};

/// The program's or a command's flags. CLI11 stands behind it, seen by one file alone: it is half a
/// minute of compiling that each command would pay again.
class Command {
 public:
  /// The program itself.
  explicit Command(const std::string& description);
  explicit Command(CLI::App* app);
  ~Command();
  Command(const Command&) = delete;
  Command& operator=(const Command&) = delete;

  /// A command of the program, or one of this command: `artus sweep merge`. Flags that this command
  /// requires are not required of its own commands, and its callback does not run with theirs.
  Command* add_subcommand(const std::string& name, const std::string& description);
  /// The heading under which --help lists the subcommands that are added from here on.
  void group(const std::string& heading) { group_ = heading; }
  /// Names of those that were added, in their order.
  [[nodiscard]] std::vector<std::string> subcommands() const;
  /// One that was added. Requires: that it was.
  [[nodiscard]] Command& subcommand(const std::string& name);
  /// A flag with a value ("--depth,-d"), or an argument (a name without dashes). Value: a path, a
  /// string, a number, an optional of those, or a vector of strings or numbers.
  template <typename Value>
  Option* add_option(const std::string& names, Value& value, const std::string& help);
  Option* add_flag(const std::string& names, bool& value, const std::string& help);
  [[nodiscard]] Option* get_option(const std::string& name);
  void footer(const std::string& text);
  void set_version_flag(const std::string& name, const std::string& text);
  void require_subcommand(int count);
  /// Runs after the command line was read, when this command was chosen.
  void callback(std::function<void()> body);

  /// Reads the command line and runs what it chose. False when it was wrong, or asked for help or
  /// the version: that was printed, and `exit_code` is 0 for the latter.
  [[nodiscard]] bool parse(int argc, const char* const* argv, int& exit_code);
  /// What parse() was given, without the program's name and with blanks between.
  [[nodiscard]] const std::string& line() const noexcept { return line_; }

 private:
  std::unique_ptr<CLI::App> program_;  // the program's; a command's belongs to it
  CLI::App* app_;
  std::string group_;
  std::string line_;
  std::deque<Option> options_;
  std::vector<std::unique_ptr<Command>> commands_;
};

}  // namespace artus

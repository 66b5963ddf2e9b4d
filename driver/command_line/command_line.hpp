// SPDX-License-Identifier: MIT
/// The command line of a program: its options, subcommands, help and errors. It uses the library CLI11. Files that
/// include this header do not include the headers of CLI11, so they compile fast.
///
/// Commands and options belong to their Program. A Command or an Option object is only a reference, which is cheap to
/// copy and valid as long as the Program lives. Definitions that contradict each other (two options with one name)
/// throw std::runtime_error. All functions are for the main thread.
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace CLI {  // NOLINT(readability-identifier-naming): the library calls itself so
class App;
class Option;
}  // namespace CLI

namespace hapticd::command_line {

constexpr int kBadUsage = 2;  ///< exit code of every program for a wrong command line

/// Returns a text such as " (did you mean \"run\"?)" for a word that is none of the known ones, or "".
using Suggest = std::function<std::string(const std::string& word, const std::vector<std::string>& known)>;

/// Sets the function with which the messages of this process suggest names; without it they suggest none.
void suggestBy(const Suggest& function);

/// An option, a flag or a positional argument.
class Option {
 public:
  explicit Option(CLI::Option* option) : option_(option) {}

  // Rules. Each returns the option, so that the next rule can follow.
  Option required() const;
  Option expected(int least, int most) const;  ///< takes from `least` to `most` values
  Option delimiter(char between) const;        ///< splits one word into several values
  Option oneValueEach() const;                 ///< may be repeated, and never takes the words that follow its value
  Option within(double low, double high) const;
  Option wholeWithin(int low, int high) const;
  Option oneOf(const std::vector<std::string>& words) const;
  Option existingFile() const;
  /// Checks the word with `wrong`, which returns what is wrong with the word, or "" if it is good.
  Option check(const std::function<std::string(const std::string& word)>& wrong) const;
  Option needs(const Option& other) const;
  Option needs(const std::string& name) const;
  Option excludes(const Option& other) const;
  Option excludes(const std::string& name) const;
  Option showDefault() const;  ///< the help shows the value that the variable has now
  /// Sets the value that the variable gets if the option is given without a value.
  Option valueWithoutWord(const std::string& value) const;

  // What the help says about the option.
  bool positional() const;
  bool isHelp() const;
  std::string description() const;
  std::string positionalName() const;          ///< such as "scene"
  std::string allNames() const;                ///< such as "-o,--out"
  std::vector<std::string> longNames() const;  ///< such as "out"
  std::string valueName() const;  ///< placeholder of the value in the help, such as "{x,y,z}"; "" for a flag

 private:
  friend class Command;
  CLI::Option* option_;
};

/// The program itself, or one of its subcommands.
class Command {
 public:
  explicit Command(CLI::App* app) : app_(app) {}

  /// @param name "-o,--out" for an option, "file" for a positional argument, "-o,--out,out" for an argument that may be
  /// given in both forms
  /// @param value receives the value, and is not changed if the option is not given. It must live as long as the
  /// program. Types other than those instantiated in command_line.cpp cause a linker error.
  template <class Value>
  Option addOption(const std::string& name, Value& value, const std::string& description = "") const;
  Option addFlag(const std::string& name, bool& value, const std::string& description = "") const;
  Command addSubcommand(const std::string& name, const std::string& description) const;

  void footer(const std::string& text) const;                    ///< text below the help: examples, exit codes
  void callback(const std::function<void()>& whatItDoes) const;  ///< called after the whole command line was read
  void requireSubcommand() const;                                ///< exactly one subcommand must be given
  void optionsMayFollowSubcommand() const;                       ///< options of the program may also follow it
  void takesForeignCommandLine() const;                          ///< nothing after the first unknown word is parsed
  std::vector<std::string> foreignCommandLine() const;           ///< the words that were not parsed
  bool given(const std::string& option) const;                   ///< whether the command line contained the option
  Command subcommand(const std::string& name) const;             ///< the subcommand of that name, which exists
  std::string name() const;
  std::string description() const;
  std::string footer() const;
  std::vector<Command> subcommands() const;  ///< in the order in which they were added
  std::vector<Option> options() const;       ///< all options, also --help

 protected:
  CLI::App* app_;
};

/// A program's command line as a whole.
class Program : public Command {
 public:
  /// @param name the program's name in the help; "" takes the name by which it was called
  explicit Program(const std::string& description, const std::string& name = "");
  ~Program();
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  void version(const std::string& text) const;  ///< sets the text that --version prints
  /// Reads the command line and runs the callback of the given command. Exceptions of the callback are passed on.
  /// @return the exit code with which the program must end: 0 if the help or the version was printed, kBadUsage if an
  /// error was printed. Nothing if the program must go on
  std::optional<int> parse(int argc, const char* const* argv) const;
};

/// Converts a word to a value, as an option of this type does. If it returns false, the word could not be read, and
/// `value` is undefined.
template <class Value>
bool read(const std::string& word, Value& value);

/// Returns the parts of a list such as "a,b"; "a,,b" has an empty part.
std::vector<std::string> split(const std::string& list, char between);

/// Returns the text without white space at both ends.
std::string trimmed(const std::string& text);

}  // namespace hapticd::command_line

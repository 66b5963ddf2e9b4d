// SPDX-License-Identifier: MIT
/// The command line of a program: its options, subcommands, help and errors. It is CLI11 behind a header that compiles
/// fast.
///
/// Commands and options belong to their Program; a Command or an Option is a reference to one of them, cheap to copy
/// and valid as long as the Program lives. A table that contradicts itself (two options of one name) throws
/// std::runtime_error. All functions are for the main thread.
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace hapticd::command_line {

constexpr int kBadUsage = 2;  ///< exit code of every program for a wrong command line

/// An option, a flag or a positional argument.
class Option {
 public:
  explicit Option(CLI::Option* option) : option_(option) {}

  // Rules. Each gives back the option, so that the next rule can follow.
  Option required() const;
  Option expected(int count) const;            ///< takes this many values
  Option expected(int least, int most) const;  ///< Rules. Each returns the option, so that the next rule can follow.
  Option delimiter(char between) const;        ///< splits one word into several values
  Option oneValueEach() const;                 ///< may be repeated, and never takes the words that follow its value
  Option within(double low, double high) const;
  Option wholeWithin(int low, int high) const;
  Option oneOf(const std::vector<std::string>& words) const;
  Option existingFile() const;
  /// The word must satisfy `wrong`, which says what is wrong with it, or gives "".
  Option check(const std::function<std::string(const std::string& word)>& wrong) const;
  Option needs(const Option& other) const;
  Option needs(const std::string& name) const;
  Option excludes(const Option& other) const;
  Option excludes(const std::string& name) const;
  Option showDefault() const;                               ///< the help shows the value that the variable has now
  Option valueWithoutWord(const std::string& value) const;  ///< the value that it gets where none follows

  // What the help says about it.
  bool positional() const;
  bool isHelp() const;
  std::string description() const;
  std::string positionalName() const;          ///< "scene"
  std::string allNames() const;                ///< "-o,--out"
  std::vector<std::string> longNames() const;  ///< "out"
  std::string valueName() const;               ///< what stands for the value in the help, "TEXT:{x,y,z}"; "" of a flag

 private:
  friend class Command;
  CLI::Option* option_;
};

/// The program itself, or one of its subcommands.
class Command {
 public:
  explicit Command(CLI::App* app) : app_(app) {}

  /// @param name "-o,--out" for an option, "file" for a positional argument, "-o,--out,out" for either
  /// @param value keeps what it holds if the option is not given; must live as long as the program. Only types with an
  /// instance in command_line.cpp link.
  template <class Value>
  Option addOption(const std::string& name, Value& value, const std::string& description = "") const;
  Option addFlag(const std::string& name, bool& value, const std::string& description = "") const;
  Command addSubcommand(const std::string& name, const std::string& description) const;

  void footer(const std::string& text) const;                    ///< stands below the help: examples, exit codes
  void callback(const std::function<void()>& whatItDoes) const;  ///< runs when the whole command line was read
  void requireSubcommand() const;                                ///< one, and no more
  void optionsMayFollowSubcommand() const;                       ///< options of the program may stand after it too
  void takesForeignCommandLine() const;                          ///< what follows the first unknown word stays as it is
  std::vector<std::string> foreignCommandLine() const;           ///< those words
  bool given(const std::string& option) const;                   ///< whether the command line contained it
  Command subcommand(const std::string& name) const;             ///< one that was added
  std::string name() const;
  std::string description() const;
  std::string footer() const;
  std::vector<Command> subcommands() const;  ///< in the order in which they were added
  std::vector<Option> options() const;       ///< with --help

 protected:
  CLI::App* app_;
};

/// A program's command line as a whole.
class Program : public Command {
 public:
  /// @param name as the help shows it; "": as the program was called
  explicit Program(const std::string& description, const std::string& name = "");
  ~Program();
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  void version(const std::string& text) const;  ///< what --version prints
  /// Reads the command line and runs the callback of its command, whose exceptions pass. @return the exit code of a
  /// program that is done: it printed help or version (0), or what is wrong (kBadUsage); nothing if it must go on
  std::optional<int> parse(int argc, const char* const* argv) const;
};

/// Reads a word as an option of this type would; `value` is undefined after "false".
template <class Value>
bool read(const std::string& word, Value& value);

/// The parts of a list such as "a,b"; "a,,b" has an empty part.
std::vector<std::string> split(const std::string& list, char between);

/// The text without white space at both ends.
std::string trimmed(const std::string& text);

}  // namespace hapticd::command_line

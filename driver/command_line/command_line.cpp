// SPDX-License-Identifier: MIT
#include "command_line/command_line.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdint>
#include <cstdio>
#include <filesystem>

namespace hapticd::command_line {

Option Option::required() const {
  return Option(option_->required());
}

Option Option::expected(int count) const {
  return Option(option_->expected(count));
}

Option Option::expected(int least, int most) const {
  return Option(option_->expected(least, most));
}

Option Option::delimiter(char between) const {
  return Option(option_->delimiter(between));
}

Option Option::oneValueEach() const {
  return Option(option_->allow_extra_args(false));
}

/// CLI::Range is not used, because it would also accept nan.
Option Option::within(double low, double high) const {
  const auto refuse = [=](const std::string& text) {
    double value = 0;
    if (!CLI::detail::lexical_cast(text, value))
      return fmt::format("\"{}\" is not a number, expected one from {:g} to {:g}", text, low, high);
    const bool good = value >= low && value <= high;
    return good ? std::string() : fmt::format("Value {} not in range {:g} to {:g}", text, low, high);
  };
  return Option(option_->check(CLI::Validator(refuse, fmt::format("FLOAT in [{} - {}]", low, high))));
}

Option Option::wholeWithin(int low, int high) const {
  return Option(option_->check(CLI::Range(low, high)));
}

Option Option::oneOf(const std::vector<std::string>& words) const {
  return Option(option_->check(CLI::IsMember(words)));
}

Option Option::existingFile() const {
  return Option(option_->check(CLI::ExistingFile));
}

Option Option::check(const std::function<std::string(const std::string&)>& wrong) const {
  return Option(option_->check(wrong));
}

Option Option::needs(const Option& other) const {
  return Option(option_->needs(other.option_));
}

Option Option::needs(const std::string& name) const {
  return Option(option_->needs(name));
}

Option Option::excludes(const Option& other) const {
  return Option(option_->excludes(other.option_));
}

Option Option::excludes(const std::string& name) const {
  return Option(option_->excludes(name));
}

Option Option::showDefault() const {
  return Option(option_->capture_default_str());
}

Option Option::valueWithoutWord(const std::string& value) const {
  return Option(option_->default_str(value));
}

bool Option::positional() const {
  return option_->get_positional();
}

bool Option::isHelp() const {
  return option_->check_lname("help");
}

std::string Option::description() const {
  return option_->get_description();
}

std::string Option::positionalName() const {
  return option_->get_name(true);
}

std::string Option::allNames() const {
  return option_->get_name(false, true);
}

std::vector<std::string> Option::longNames() const {
  return option_->get_lnames();
}

std::string Option::valueName() const {
  return option_->get_type_name();
}

template <class Value>
Option Command::addOption(const std::string& name, Value& value, const std::string& description) const {
  return Option(app_->add_option(name, value, description));
}

template Option Command::addOption(const std::string&, std::string&, const std::string&) const;
template Option Command::addOption(const std::string&, double&, const std::string&) const;
template Option Command::addOption(const std::string&, int&, const std::string&) const;
template Option Command::addOption(const std::string&, unsigned short&, const std::string&) const;
template Option Command::addOption(const std::string&, uint32_t&, const std::string&) const;
template Option Command::addOption(const std::string&, uint64_t&, const std::string&) const;
template Option Command::addOption(const std::string&, std::optional<double>&, const std::string&) const;
template Option Command::addOption(const std::string&, std::optional<int>&, const std::string&) const;
template Option Command::addOption(const std::string&, std::optional<uint32_t>&, const std::string&) const;
template Option Command::addOption(const std::string&, std::vector<std::string>&, const std::string&) const;
template Option Command::addOption(const std::string&, std::vector<double>&, const std::string&) const;
template Option Command::addOption(const std::string&, std::vector<std::filesystem::path>&, const std::string&) const;

Option Command::addFlag(const std::string& name, bool& value, const std::string& description) const {
  return Option(app_->add_flag(name, value, description));
}

Command Command::addSubcommand(const std::string& name, const std::string& description) const {
  return Command(app_->add_subcommand(name, description));
}

void Command::footer(const std::string& text) const {
  app_->footer(text);
}

void Command::callback(const std::function<void()>& what_it_does) const {
  app_->callback(what_it_does);
}

void Command::requireSubcommand() const {
  app_->require_subcommand(1);
}

void Command::optionsMayFollowSubcommand() const {
  app_->fallthrough();
}

void Command::takesForeignCommandLine() const {
  app_->prefix_command();
  app_->fallthrough(false);  // the words after the first unknown one are not parsed as options of the program either
}

std::vector<std::string> Command::foreignCommandLine() const {
  return app_->remaining();
}

bool Command::given(const std::string& option) const {
  return app_->count(option) > 0;
}

Command Command::subcommand(const std::string& name) const {
  return Command(app_->get_subcommand(name));
}

std::string Command::name() const {
  return app_->get_name();
}

std::string Command::description() const {
  return app_->get_description();
}

std::string Command::footer() const {
  return app_->get_footer();
}

std::vector<Command> Command::subcommands() const {
  std::vector<Command> all;
  for (CLI::App* below : app_->get_subcommands(nullptr)) all.emplace_back(below);
  return all;
}

std::vector<Option> Command::options() const {
  std::vector<Option> all;
  for (CLI::Option* option : app_->get_options(nullptr)) all.emplace_back(option);
  return all;
}

Program::Program(const std::string& description, const std::string& name) : Command(new CLI::App(description, name)) {}

Program::~Program() {
  delete app_;
}

void Program::version(const std::string& text) const {
  app_->set_version_flag("--version", text);
}

namespace {

/// Gives CLI11's "Could not convert: value = abc" the form of the other messages. Such a message is always about a
/// number, because only numbers are converted.
std::string unreadable(const std::string& told) {
  const size_t colon = told.find(": "), equals = told.find(" = ");
  if (colon == std::string::npos || equals == std::string::npos || equals < colon) return "error: " + told;
  const std::string name = told.substr(colon + 2, equals - colon - 2);
  return "error: " + name + ": \"" + told.substr(equals + 3) + "\" cannot be read, expected a number; see --help";
}

}  // namespace

std::optional<int> Program::parse(int argc, const char* const* argv) const {
  try {
    app_->parse(argc, argv);
    return std::nullopt;
  } catch (const CLI::ConversionError& error) {
    std::fprintf(stderr, "%s\n", unreadable(error.what()).c_str());
    return kBadUsage;
  } catch (const CLI::ParseError& error) {
    return app_->exit(error) == 0 ? 0 : kBadUsage;
  }
}

template <class Value>
bool read(const std::string& word, Value& value) {
  return CLI::detail::lexical_cast(word, value);
}

template bool read(const std::string&, std::string&);
template bool read(const std::string&, double&);
template bool read(const std::string&, int&);

std::vector<std::string> split(const std::string& list, char between) {
  return CLI::detail::split(list, between);
}

std::string trimmed(const std::string& text) {
  return CLI::detail::trim_copy(text);
}

}  // namespace hapticd::command_line

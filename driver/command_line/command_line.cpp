// SPDX-License-Identifier: MIT
#include "command_line/command_line.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <filesystem>

#include "command_line/did_you_mean.hpp"
#include "command_line/option_texts.hpp"

namespace hapticd::command_line {

Option Option::required() const {
  return Option(option_->required());
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
  const auto refuse = [low, high, unit = unitOf(description())](const std::string& text) {
    return notWithin(text, low, high, unit);
  };
  return Option(option_->check(CLI::Validator(refuse, fmt::format("({:g} to {:g})", low, high))));
}

Option Option::wholeWithin(int low, int high) const {
  const auto refuse = [low, high, unit = unitOf(description())](const std::string& text) {
    return notWithin(text, low, high, unit);
  };
  return Option(option_->check(CLI::Validator(refuse, fmt::format("({} to {})", low, high))));
}

Option Option::oneOf(const std::vector<std::string>& words) const {
  const auto refuse = [words](const std::string& text) {
    if (std::find(words.begin(), words.end(), text) != words.end()) return std::string();
    return fmt::format("\"{}\" is not known, expected one of {}{}", text, fmt::join(words, ", "),
                       didYouMean(text, words));
  };
  return Option(option_->check(CLI::Validator(refuse, fmt::format("{{{}}}", fmt::join(words, ",")))));
}

Option Option::existingFile() const {
  const auto refuse = [](const std::string& text) {
    if (CLI::detail::check_path(text.c_str()) == CLI::detail::path_type::file) return std::string();
    return fmt::format("there is no file \"{}\", expected the path of a file", text);
  };
  return Option(option_->check(CLI::Validator(refuse, "FILE")));
}

Option Option::check(const std::function<std::string(const std::string&)>& wrong) const {
  return Option(option_->check([wrong](const std::string& word) {
    const std::string text = wrong(word);
    return text.empty() || text.find(word) != std::string::npos ? text : text + ", got \"" + word + "\"";
  }));
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
  return readableType(option_->get_type_name());
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

namespace {

/// Writes the help with readable placeholders of values.
class HelpFormatter final : public CLI::Formatter {
 public:
  // NOLINTNEXTLINE(readability-identifier-naming): the library calls it so
  std::string make_option_opts(const CLI::Option* option) const override {
    const std::string type = option->get_type_name();
    return replaced(Formatter::make_option_opts(option), type, readableType(type));
  }
};

}  // namespace

Program::Program(const std::string& description, const std::string& name) : Command(new CLI::App(description, name)) {
  app_->formatter(std::make_shared<HelpFormatter>());  // subcommands take it from their program
}

Program::~Program() {
  delete app_;
}

void Program::version(const std::string& text) const {
  app_->set_version_flag("--version", text);
}

namespace {

/// Returns the command that the line names so far: the program, or the innermost subcommand.
const CLI::App& innermost(const CLI::App& app) {
  const CLI::App* at = &app;
  while (!at->get_subcommands().empty()) at = at->get_subcommands().back();
  return *at;
}

/// Returns the words that name a command, such as "hapticd ctl set".
std::string wordsOf(const CLI::App& app) {
  if (app.get_parent() != nullptr) return wordsOf(*app.get_parent()) + " " + app.get_name();
  return std::filesystem::path(app.get_name()).filename().string();
}

/// Returns the words that a command takes without an option, such as "SCENE [MODEL]".
std::vector<std::string> argumentsOf(const CLI::App& app) {
  std::vector<std::string> words;
  for (const CLI::Option* option : app.get_options([](const CLI::Option* one) { return one->get_positional(); })) {
    std::string word = option->get_name(true);
    std::transform(word.begin(), word.end(), word.begin(), [](unsigned char c) { return std::toupper(c); });
    words.push_back(option->get_required() ? word : "[" + word + "]");
  }
  return words;
}

OptionFacts factsOf(const CLI::Option& option) {
  return {option.get_name(),
          option.get_type_name(),
          option.get_description(),
          option.get_items_expected_min(),
          option.get_items_expected_max(),
          option.results()};
}

/// Returns how a command is called, with all that it needs, such as "hapticd ctl move MODEL --position X Y Z".
std::string usageOf(const CLI::App& app) {
  std::string usage = wordsOf(app);
  for (const std::string& word : argumentsOf(app)) usage += " " + word;
  for (const CLI::Option* option : app.get_options(nullptr))
    if (option->get_required() && !option->get_positional())
      usage += " " + option->get_name() + " " + placeholders(factsOf(*option));
  return usage;
}

std::vector<std::string> subcommandNames(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* below : app.get_subcommands(nullptr)) names.push_back(below->get_name());
  return names;
}

/// Returns the long names of a command's options and of those above it, with their dashes.
std::vector<std::string> optionNames(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* at = &app; at != nullptr; at = at->get_parent())
    for (const CLI::Option* option : at->get_options(nullptr))
      for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

/// True for a word such as "--other", but not for "-0.005", which is a value.
bool namesOption(const std::string& word) {
  double number = 0;
  return word.size() > 1 && word[0] == '-' && word != "--" && !read(word, number);
}

/// Describes the first word that no command takes. After the word -- no other one is an option.
std::string unexpected(const CLI::App& app, const std::vector<std::string>& words) {
  const bool plain = !words.empty() && words.front() == "--";
  const std::string word = words.size() > (plain ? 1 : 0) ? words[plain ? 1 : 0] : "";
  if (!plain && namesOption(word)) {
    const std::string name = word.substr(0, word.find('='));
    return "there is no option " + name + didYouMean(name, optionNames(app));
  }
  if (const auto names = subcommandNames(app); !names.empty())
    return fmt::format("there is no subcommand \"{}\", expected one of {}{}", word, fmt::join(names, ", "),
                       didYouMean(word, names));
  const std::string more = fmt::format("unexpected word \"{}\": `{}` takes ", word, wordsOf(app));
  const bool digits = !word.empty() && word.find_first_not_of("0123456789.,-+eE") == word.npos;
  const char* list = digits ? "; the numbers of one option are separated by commas, without blanks: 0.21,0.17" : "";
  if (argumentsOf(app).empty()) return more + "only options" + list;
  return more + fmt::format("only {} and options", fmt::join(argumentsOf(app), " ")) + list;
}

/// Describes what is missing: a subcommand, an argument or an option.
std::string missing(const CLI::App& app, std::string told) {
  constexpr std::string_view kEnd = " is required";
  if (told.ends_with(kEnd)) told.resize(told.size() - kEnd.size());
  std::vector<std::string> rest = app.remaining();
  for (const CLI::App* at = app.get_parent(); rest.empty() && at != nullptr; at = at->get_parent())
    rest = at->remaining();  // a command passes words that it does not know to its parent
  if (!rest.empty() && (namesOption(rest.front()) || told == "A subcommand")) return unexpected(app, rest);
  if (told == "A subcommand")
    return fmt::format("no subcommand given, expected one of {}", fmt::join(subcommandNames(app), ", "));
  const CLI::Option* model = app.get_option_no_throw("model");
  return fmt::format("{} is missing, expected `{}`{}", told, usageOf(app), model ? splitAtDot(factsOf(*model)) : "");
}

/// Returns the option that an error names, such as "--for" in "--for: 1 required FLOAT missing"; nothing if no command
/// of this line has it.
std::optional<OptionFacts> named(const CLI::App& app, const std::string& name) {
  for (const CLI::App* at = &app; at != nullptr; at = at->get_parent())
    if (const CLI::Option* option = at->get_option_no_throw(name); option != nullptr) return factsOf(*option);
  return std::nullopt;
}

/// Gives CLI11's "Could not convert: value = abc" the form of the other messages.
std::string unreadable(const CLI::App& app, const std::string& told) {
  const size_t colon = told.find(": "), equals = told.find(" = ");
  if (colon == std::string::npos || equals == std::string::npos || equals < colon) return told;
  const auto option = named(app, told.substr(colon + 2, equals - colon - 2));
  return option ? unreadable(*option) : told;
}

std::string wrongCount(const CLI::App& app, const std::string& told) {
  const auto option = named(app, told.substr(0, told.find(": ")));
  return option ? wrongCount(*option, told) : told;
}

/// Returns what is wrong with the command line, in the form of all other messages.
std::string describe(const CLI::App& app, const CLI::ParseError& error) {
  std::string told = error.what();
  if (dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr) return unexpected(innermost(app), app.remaining(true));
  if (dynamic_cast<const CLI::RequiredError*>(&error) != nullptr) return missing(innermost(app), told);
  if (dynamic_cast<const CLI::ConversionError*>(&error) != nullptr) return unreadable(innermost(app), told);
  if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) != nullptr) return wrongCount(innermost(app), told);
  if (dynamic_cast<const CLI::RequiresError*>(&error) != nullptr)
    return replaced(told, " requires ", " has no effect alone, expected also ");
  if (dynamic_cast<const CLI::ExcludesError*>(&error) != nullptr)
    return replaced(told, " excludes ", " is given together with ") + ", expected one of them";
  return told;
}

}  // namespace

std::optional<int> Program::parse(int argc, const char* const* argv) const {
  try {
    app_->parse(argc, argv);
    return std::nullopt;
  } catch (const CLI::Success& help) {
    return app_->exit(help);
  } catch (const CLI::ParseError& error) {
    std::fprintf(stderr, "error: %s; see %s --help\n", describe(*app_, error).c_str(),
                 wordsOf(innermost(*app_)).c_str());
    return kBadUsage;
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

// SPDX-License-Identifier: MIT
/// Tests what a program reads from its command line, and its messages about mistakes there.
#include "command_line/command_line.hpp"

#include <gtest/gtest.h>

namespace hapticd::command_line {
namespace {

/// A program with one subcommand that has an option of each kind.
struct Example {
  Program program{"An example.", "example"};
  Command draw = program.addSubcommand("draw", "Draw something.");
  Command move = program.addSubcommand("move", "Move something.");
  std::string file, colour = "red", name, title;
  double scale = 1;
  int copies = 1;
  uint32_t layer = 0;
  std::optional<double> angle, delay;
  std::vector<double> corner, weights, to;
  bool quiet = false;
  int calls = 0;

  Example() {
    program.requireSubcommand();
    program.addOption("--name", name, "its name");
    program.optionsMayFollowSubcommand();
    program.version("example 7");
    draw.addOption("file", file, "file to draw").required();
    draw.addOption("--colour", colour, "its colour").oneOf({"red", "blue"});
    draw.addOption("--scale", scale, "its scale").within(0.5, 2).showDefault();
    draw.addOption("--copies", copies, "how many").wholeWithin(1, 9);
    draw.addOption("--angle", angle, "its angle [rad]");
    draw.addOption("--corner", corner, "x y").expected(2, 2).needs("--angle");
    draw.addOption("--weights", weights, "numbers").delimiter(',').oneValueEach();
    draw.addFlag("-q,--quiet", quiet, "say nothing").excludes("--copies");
    draw.addOption("--delay", delay, "how long to wait [s]; default: 0").within(0, 5);
    draw.addOption("--layer", layer, "its layer");
    draw.addOption("--title", title, "its title").check([](const std::string& word) {
      return word.find('/') == std::string::npos ? "" : "expected letters";
    });
    move.addOption("file", file, "file to move").required();
    move.addOption("--to", to, "x y z [m], world frame").required().expected(3, 3);
    draw.callback([this] { ++calls; });
  }

  /// The exit code, or -1 for a program that goes on. `said` is what it printed.
  int parse(std::vector<const char*> words) {
    words.insert(words.begin(), "example");
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    const auto ended = program.parse(static_cast<int>(words.size()), words.data());
    said = testing::internal::GetCapturedStdout() + testing::internal::GetCapturedStderr();
    return ended.value_or(-1);
  }
  std::string said;
};

TEST(CommandLine, ReadsEveryKindOfValueAndRunsTheCommandOnce) {
  Example e;
  ASSERT_EQ(e.parse({"draw", "a.svg", "--colour", "blue", "--scale", "1.5", "--angle", "0.25", "--corner", "3", "4",
                     "--weights", "1,2", "--weights", "3", "-q"}),
            -1)
      << e.said;
  EXPECT_EQ(e.file, "a.svg");
  EXPECT_EQ(e.colour, "blue");
  EXPECT_EQ(e.scale, 1.5);
  EXPECT_EQ(e.angle, 0.25);
  EXPECT_EQ(e.corner, (std::vector<double>{3, 4}));
  EXPECT_EQ(e.weights, (std::vector<double>{1, 2, 3}));
  EXPECT_TRUE(e.quiet);
  EXPECT_EQ(e.copies, 1) << "was not given";
  EXPECT_TRUE(e.draw.given("--scale"));
  EXPECT_FALSE(e.draw.given("--copies"));
  EXPECT_EQ(e.calls, 1);
}

using WrongLines = std::vector<std::pair<std::vector<const char*>, std::string>>;

void expectRefused(const WrongLines& wrong) {
  for (const auto& [words, text] : wrong) {
    Example e;
    EXPECT_EQ(e.parse(words), kBadUsage) << text;
    EXPECT_NE(e.said.find(text), std::string::npos) << "expected \"" << text << "\" in: " << e.said;
    EXPECT_EQ(e.calls, 0) << text;
  }
}

TEST(CommandLine, RefusesAValueThatBreaksARule) {
  expectRefused({
      {{"draw", "a", "--colour", "green"}, "error: --colour: \"green\" is not known, expected one of red, blue"},
      {{"draw", "a", "--scale", "3"}, "error: --scale: 3 is out of range, expected a number from 0.5 to 2"},
      {{"draw", "a", "--scale", "nan"}, "--scale: nan is out of range, expected a number from 0.5 to 2"},
      {{"draw", "a", "--scale", "much"}, "--scale: \"much\" is not a number, expected one from 0.5 to 2"},
      {{"draw", "a", "--copies", "0"}, "--copies: 0 is out of range, expected a whole number from 1 to 9"},
      {{"draw", "a", "--copies", "1.5"}, "--copies: \"1.5\" is not a whole number, expected one from 1 to 9"},
      {{"draw", "a", "--angle", "x"}, "error: --angle: \"x\" cannot be read, expected a number in rad;"},
      {{"draw", "a", "--delay", "9"}, "error: --delay: 9 is out of range, expected a number from 0 to 5 s;"},
      {{"draw", "a", "--delay", "1s"}, "error: --delay: \"1s\" is not a number, expected one from 0 to 5 s;"},
      {{"draw", "a", "--layer", "-1"}, "error: --layer: -1 is out of range, expected a whole number from 0;"},
      {{"draw", "a", "--layer", "1.5"}, "error: --layer: \"1.5\" is not a whole number, expected one from 0;"},
      {{"draw", "a", "--layer", "up"}, "error: --layer: \"up\" cannot be read, expected a whole number from 0;"},
      {{"draw", "a", "--layer", "5000000000"}, "5000000000 is out of range, expected a whole number nearer to 0;"},
      {{"draw", "a", "--title", "a/b"}, "error: --title: expected letters, got \"a/b\";"},
      {{"move", "a", "--to", "1", "2"}, "error: --to: expected 3 numbers, got 2: 1 2;"},
      {{"move", "a", "--to", "1", "2", "3", "4"}, "error: --to: expected 3 numbers, got 4: 1 2 3 4;"},
      {{"move", "a", "--to", "1,2,3"}, "error: --to: expected 3 numbers, got 1: 1,2,3; separate them by spaces;"},
      {{"move", "a", "--to", "1", "2", "c"}, "error: --to: \"c\" cannot be read, expected a number in m;"},
      {{"move", "a", "--to"}, "error: --to: expected 3 numbers, got none;"},
  });
}

TEST(CommandLine, RefusesWordsThatAreMissingOrTooMany) {
  expectRefused({
      {{}, "error: no subcommand given, expected one of draw, move; see example --help"},
      {{"draw"}, "error: file is missing, expected `example draw FILE`; see example draw --help"},
      {{"move", "a"}, "error: --to is missing, expected `example move FILE --to X Y Z`;"},
      {{"--name", "x", "drwa"}, "error: there is no subcommand \"drwa\", expected one of draw, move"},
      {{"draw", "a", "--angle"}, "error: --angle: 1 more value expected: NUMBER; see example draw --help"},
      {{"draw", "a", "b"}, "error: unexpected word \"b\": `example draw` takes only FILE and options"},
      {{"drwa"}, "error: there is no subcommand \"drwa\", expected one of draw"},
      {{"draw", "a", "--corner", "1", "2"}, "--corner has no effect alone, expected also --angle"},
      {{"draw", "a", "--corner", "1", "--angle", "2"}, "--corner"},
      {{"draw", "a", "-q", "--copies", "2"}, "is given together with"},
      {{"draw", "a", "--weights", "1", "2"}, "2"},
      {{"draw", "a", "--other"}, "error: there is no option --other; see example draw --help"},
      {{"move", "a", "-0.005", "0.003"}, "error: --to is missing, expected `example move FILE --to X Y Z`;"},
      {{"draw", "a", "-0.5"}, "error: unexpected word \"-0.5\": `example draw` takes only FILE and options"},
      {{"move", "--", "-a"}, "error: --to is missing, expected `example move FILE --to X Y Z`;"},
      {{"draw", "--", "-a", "-b"}, "error: unexpected word \"-b\": `example draw` takes only FILE and options"},
  });
}

TEST(CommandLine, SuggestsNamesIfItIsToldHow) {
  suggestBy([](const std::string& word, const std::vector<std::string>& known) {
    return " (of " + std::to_string(known.size()) + " not " + word + ")";
  });
  Example e;
  e.parse({"draw", "a", "--colour", "green"});
  EXPECT_NE(e.said.find("one of red, blue (of 2 not green)"), std::string::npos) << e.said;
  e.parse({"draw", "a", "--coluor=red"});
  EXPECT_NE(e.said.find("there is no option --coluor (of "), std::string::npos) << e.said;
  suggestBy(nullptr);
}

TEST(CommandLine, HelpAndVersionEndTheProgramWell) {
  Example e;
  EXPECT_EQ(e.parse({"--version"}), 0);
  EXPECT_EQ(e.said, "example 7\n");
  EXPECT_EQ(e.parse({"draw", "--help"}), 0);
  for (const char* text : {"Draw something.", "file TEXT REQUIRED", "--colour {red,blue}", "-q,--quiet",
                           "--scale NUMBER (0.5 to 2)=1", "--layer INTEGER"})
    EXPECT_NE(e.said.find(text), std::string::npos) << "expected \"" << text << "\" in: " << e.said;
  EXPECT_EQ(e.calls, 0);
}

TEST(CommandLine, TellsItsTableForManualsAndCompletions) {
  Example e;
  ASSERT_EQ(e.program.subcommands().size(), 2u);
  const Command draw = e.program.subcommands()[0];
  EXPECT_EQ(draw.name(), "draw");
  EXPECT_EQ(draw.description(), "Draw something.");
  const std::vector<Option> options = draw.options();
  ASSERT_EQ(options.size(), 12u);
  EXPECT_TRUE(options[0].isHelp());
  EXPECT_TRUE(options[1].positional());
  EXPECT_EQ(options[1].positionalName(), "file");
  EXPECT_FALSE(options[2].positional());
  EXPECT_EQ(options[2].valueName(), "{red,blue}");
  EXPECT_EQ(options[2].longNames(), std::vector<std::string>{"colour"});
  EXPECT_EQ(options[8].valueName(), "");
  EXPECT_EQ(options[8].allNames(), "-q,--quiet");
  EXPECT_EQ(options[8].description(), "say nothing");
}

TEST(CommandLine, LeavesTheWordsOfAForeignProgramAlone) {
  Program program("A wrapper.", "wrapper");
  std::string config;
  bool env = false;
  program.addOption("--config", config, "a file");
  program.optionsMayFollowSubcommand();
  const Command client = program.addSubcommand("client", "Run a program.");
  client.addFlag("--env", env, "print");
  client.takesForeignCommandLine();
  const char* const words[] = {"wrapper", "client", "--env", "./it", "--config", "x", "-v"};
  ASSERT_EQ(program.parse(7, words), std::nullopt);
  EXPECT_TRUE(env);
  EXPECT_EQ(config, "");
  EXPECT_EQ(client.foreignCommandLine(), (std::vector<std::string>{"./it", "--config", "x", "-v"}));
}

TEST(CommandLine, ReadsWordsAndLists) {
  double number = 0;
  EXPECT_TRUE(read("1e3", number));
  EXPECT_EQ(number, 1000);
  EXPECT_FALSE(read("1e3x", number));
  int whole = 0;
  EXPECT_FALSE(read("1.5", whole));
  EXPECT_EQ(split("a,,b", ','), (std::vector<std::string>{"a", "", "b"}));
  EXPECT_EQ(trimmed("  a b\t\n"), "a b");
}

}  // namespace
}  // namespace hapticd::command_line

// SPDX-License-Identifier: MIT
/// table1: repeats the evaluation of Thompson et al. 1999 in simulation, see kUsage.
#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <functional>
#include <string>

#include "page.hpp"
#include "session.hpp"

namespace {

using namespace hapticd::table1;

constexpr const char* kUsage =
    "Usage: table1 [--seconds S] [--seed N] [--check] [--write]\n\n"
    "Runs the evaluation of Thompson et al. (1999) again with a simulated hand and prints its table.\n"
    "  --seconds S  simulated time of each row [s]; 60 by default, as the goals need\n"
    "  --seed N     seed of the variation of the push\n"
    "  --check      end with exit code 1 if a goal is missed\n"
    "  --write      overwrite driver/docs/reports/table1.md and its pictures\n\n"
    "Exit code 2: bad usage.\n"
    "Example: table1 --check\n";

/// True if every argument is an option of this program or the value of one.
bool understood(int argc, char** argv) {
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--seconds" || word == "--seed") {
      if (++i >= argc) return false;
    } else if (word != "--check" && word != "--write") {
      return false;
    }
  }
  return true;
}

Protocol protocolOf(int argc, char** argv) {
  Protocol protocol;
  for (int i = 1; i + 1 < argc; ++i) {
    if (std::strcmp(argv[i], "--seconds") == 0) protocol.seconds = std::atof(argv[i + 1]);
    if (std::strcmp(argv[i], "--seed") == 0) protocol.seed = static_cast<unsigned>(std::atoi(argv[i + 1]));
  }
  return protocol;
}

bool has(int argc, char** argv, const char* flag) {
  for (int i = 1; i < argc; ++i)
    if (std::strcmp(argv[i], flag) == 0) return true;
  return false;
}

/// Repeats the row of the cylinder at rest, and changes one number of the protocol at a time.
std::vector<Variation> variations(const Subject& subject, const Protocol& protocol, const std::filesystem::path& work) {
  const std::vector<std::pair<std::string, std::function<void(Protocol&)>>> changes = {
      {"as above", [](Protocol&) {}},
      {"touch at 0.05 m/s", [](Protocol& p) { p.touch_speed = 0.05; }},
      {"touch at 0.2 m/s", [](Protocol& p) { p.touch_speed = 0.2; }},
      {"touch at 0.3 m/s", [](Protocol& p) { p.touch_speed = 0.3; }},
      {"never lifted", [](Protocol& p) { p.touch_every = 1e6; }},
      {"never lifted, steady push", [](Protocol& p) { p.touch_every = 1e6, p.spread = p.tremor = 0; }},
      {"push 5 N", [](Protocol& p) { p.force = 5; }},
      {"push 12 N", [](Protocol& p) { p.force = 12; }},
      {"500 Hz", [](Protocol& p) { p.rate = 500; }},
      {"5000 Hz", [](Protocol& p) { p.rate = 5000; }},
      {"window n = 3", [](Protocol& p) { p.window = 3; }},
      {"window n = 50", [](Protocol& p) { p.window = 50; }}};
  std::vector<Variation> all;
  for (const auto& [name, change] : changes) {
    Protocol changed = protocol;
    change(changed);
    all.push_back({name, run(subject, false, changed, work / "row").depth});
  }
  return all;
}

int evaluate(int argc, char** argv) {
  setenv("HAPTICD_INSTRUCTIONS", "portable", 1);  // gives the same numbers on every processor
  const auto begun = std::chrono::steady_clock::now();
  const Protocol protocol = protocolOf(argc, argv);
  const std::filesystem::path work =
      std::filesystem::temp_directory_path() / fmt::format("hapticd-table1-{}", getpid());
  std::vector<Row> rows;
  std::vector<Subject> all = subjects();
  for (const Subject& subject : all)
    for (const bool moving : {false, true}) {
      Protocol own = protocol;
      own.seed = protocol.seed * 1000 + static_cast<unsigned>(rows.size());
      rows.push_back({subject.name, moving, subject.paper[moving ? 1 : 0], run(subject, moving, own, work / "row")});
      fmt::print("{}\n", lineOf(rows.back()));
    }
  const Recording pressed = press(all.back(), protocol, work / "press");
  const std::vector<Variation> varied =
      has(argc, argv, "--write") ? variations(all[1], protocol, work) : std::vector<Variation>{};
  std::filesystem::remove_all(work);
  const Verdict verdict = judge(rows);
  fmt::print("{}\n", verdict.text);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  fmt::print("{:.1f} s for {:.0f} s of simulated time a row\n", seconds, protocol.seconds);
  if (has(argc, argv, "--write"))
    writePage({rows, varied, pressed, protocol, verdict}, HAPTICD_SOURCE_DIR "/driver/docs/reports");
  return has(argc, argv, "--check") && !verdict.met ? 1 : 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (has(argc, argv, "--help") || has(argc, argv, "-h")) {
    fmt::print("{}", kUsage);
    return 0;
  }
  if (!understood(argc, argv)) {
    fmt::print(stderr, "error: an argument is not an option, or an option has no value\n{}", kUsage);
    return 2;
  }
  try {
    return evaluate(argc, argv);
  } catch (const std::exception& e) {
    fmt::print(stderr, "error: {}\n", e.what());
    return 1;
  }
}

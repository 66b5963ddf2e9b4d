// SPDX-License-Identifier: MIT
/// `hapticd top`: shows what a running daemon does, from its status page. The page is mapped read-only, so `top` may be
/// killed at any time.
#include <poll.h>
#include <signal.h>
#include <termios.h>
#include <unistd.h>

#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "base/clock.hpp"
#include "base/happens_within.hpp"
#include "cli/support/command.hpp"
#include "control/liveness.hpp"
#include "live_status/live_status.hpp"
#include "status/page_file.hpp"

namespace hapticd::cli {

namespace {

using live_status::LiveStatus;

struct TopArguments {
  std::string name = "hapticd", sort = "step";
  double every = 0.5;
  bool once = false, json = false;
};

/// While this object lives, the terminal delivers each key at once and without echo.
class RawKeys {
 public:
  RawKeys() : raw_(isatty(STDIN_FILENO) != 0 && tcgetattr(STDIN_FILENO, &before_) == 0) {
    termios now = before_;
    now.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
    if (raw_) tcsetattr(STDIN_FILENO, TCSANOW, &now);
  }
  ~RawKeys() {
    if (raw_) tcsetattr(STDIN_FILENO, TCSANOW, &before_);
  }
  RawKeys(const RawKeys&) = delete;
  RawKeys& operator=(const RawKeys&) = delete;

  /// Returns the key that is pressed within a time, or 0 if none is.
  char wait(double seconds) const {
    pollfd polled{STDIN_FILENO, static_cast<short>(raw_ ? POLLIN : 0), 0};
    char key = 0;
    if (poll(&polled, 1, static_cast<int>(seconds * 1e3)) == 1 && read(STDIN_FILENO, &key, 1) != 1) return 'q';
    return key;
  }

 private:
  termios before_{};
  bool raw_;
};

bool ended(const status::Page& page) {
  return kill(static_cast<pid_t>(page.pid), 0) != 0 && errno == ESRCH;
}

/// Reports the end of the daemon. A daemon that ended in order has removed its files.
int endOfDaemon(const TopArguments& options) {
  if (!control::wasKilled(status::runtimeFolderOf(options.name) + "/" + options.name + ".sock")) return kWorked;
  return fail(kFailed,
              "the daemon " + options.name + " was killed, or it crashed\n  fix: start it again with hapticd run");
}

/// Returns the ticks per second between two looks.
double heldSince(const status::TickStatus& before, const status::TickStatus& now) {
  const double passed = now.t - before.t;
  return passed > 0 ? static_cast<double>(now.tick - before.tick) / passed : 0;
}

int watch(const TopArguments& options, const status::Page& page) {
  const RawKeys keys;
  std::string sort = options.sort;
  constexpr size_t kRows = 30;
  status::TickStatus before{};  // so the first look shows the mean since the start of the run
  for (char key = 0; key != 'q'; key = keys.wait(options.every)) {
    if (key == 'n') sort = "name";
    if (key == 'f') sort = "force";
    if (key == 'd') sort = "depth";
    if (key == 's') sort = "step";
    LiveStatus live = live_status::readPage(page);
    live.held = heldSince(before, live.now);
    before = live.now;
    live_status::sortModels(live.models, sort);
    std::printf("\033[H\033[J%s\nsort: s step, f force, d depth, n name (now %s); q ends\n", table(live, kRows).c_str(),
                sort.c_str());
    std::fflush(stdout);
    if (ended(page)) {
      std::puts("the daemon has ended");
      return endOfDaemon(options);
    }
  }
  return kWorked;
}

/// Prints one line of JSON after another, until the reader of the output or the daemon ends.
int stream(const TopArguments& options, const status::Page& page) {
  RealClock clock(0);
  status::TickStatus before{};
  while (!ended(page)) {
    LiveStatus live = live_status::readPage(page);
    live.held = heldSince(before, live.now);
    before = live.now;
    live_status::sortModels(live.models, options.sort);
    if (std::printf("%s\n", toJson(live).dump().c_str()) < 0 || std::fflush(stdout) != 0) return kWorked;
    clock.waitUntil(clock.now() + static_cast<Nanoseconds>(options.every * 1e9));
  }
  return endOfDaemon(options);
}

/// Returns true if the page does not change. The page of a stopped process exists, so the process would seem to run.
/// @param tick tick that the page showed before
bool standsStill(const status::Page& page, uint64_t tick) {
  constexpr Nanoseconds kLook = 10'000'000, kPatience = 500'000'000;
  return !happensWithin(kPatience, kLook,
                        [&] { return ended(page) || page.now.read().value_or(status::TickStatus{}).tick != tick; });
}

int top(const TopArguments& options) {
  const std::string base = status::runtimeFolderOf(options.name) + "/" + options.name;
  auto opened = status::PageFile::open(base + ".status");
  if (!opened)
    return fail(kFailed, control::isAlive(base + ".sock") ? opened.error() : control::noDaemonText(base + ".sock"));
  const status::Page& page = std::as_const(**opened).page();
  if (!options.once) return options.json ? stream(options, page) : watch(options, page);
  if (ended(page))
    return fail(kFailed, "the daemon " + options.name +
                             " has gone: it was killed, or it crashed\n  fix: start it again with hapticd run");
  LiveStatus live = live_status::readPage(page);
  const bool still = standsStill(page, live.now.tick);
  live.held = live.now.t > 0 && !still ? static_cast<double>(live.now.tick) / live.now.t : 0;
  live_status::sortModels(live.models, options.sort);
  std::fputs(options.json ? (toJson(live).dump() + "\n").c_str() : table(live, live.models.size()).c_str(), stdout);
  if (!still) return kWorked;
  return fail(kFailed,
              "the daemon " + options.name +
                  " stands still: no tick came while this command waited, so the numbers are old\n  fix: let its "
                  "process go on (kill -CONT PID), or end it (kill -9 PID)");
}

}  // namespace

void addTop(const Command& app, int& exit_code) {
  auto options = std::make_shared<TopArguments>();
  const Command command =
      app.addSubcommand("top", "Watch a running daemon: time, lateness, force and depth of each model and device.");
  command.addOption("--name", options->name, "name of the daemon, as given to `hapticd run --name`; default: hapticd");
  command.addOption("--sort", options->sort, "quantity by which the models are sorted; default: step (time of a step)")
      .oneOf({"step", "force", "depth", "name"});
  command.addOption("--every", options->every, "time between two updates [s]; default: 0.5").within(0.05, 60.0);
  command.addFlag("--once", options->once, "print once and exit");
  command.addFlag("--json", options->json, "print JSON: one line per interval; with --once, one line");
  command.footer(
      "Keys: s, f, d and n sort by step time, force, depth and name; q quits.\n\n"
      "late: how long after their deadlines the ticks began; tick: how long they took. ITER: how often the last step\n"
      "evaluated a surface. KNOWN: share of the ticks in which the foot point surely was the nearest, or was kept by\n"
      "a contact. STATUS: ok, degraded (a cheaper method gave the foot) or the error of the last step, which the host\n"
      "faded out; SILENCED models give no force until the end of the run, and a line below says why.\n\n"
      "Examples:\n  hapticd top --sort force\n  hapticd top --json --every 1 | jq .models[0].force_n");
  command.callback([options, &exit_code] { exit_code = top(*options); });
}

}  // namespace hapticd::cli

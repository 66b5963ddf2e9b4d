// SPDX-License-Identifier: MIT
/// `hapticd top`: shows what a running daemon does, from its status page. The page is mapped read-only, so `top` may be
/// killed at any time.
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/clock.hpp"
#include "cli/command.hpp"
#include "control/liveness.hpp"
#include "diagnostics/machine/client_warnings.hpp"
#include "host/class_table.hpp"
#include "servo/safety/limiter.hpp"
#include "session/silence_reason.hpp"
#include "status/page_file.hpp"

namespace hapticd::cli {

namespace {

using Json = nlohmann::ordered_json;

struct TopArguments {
  std::string name = "hapticd", sort = "step";
  double every = 0.5;
  bool once = false, json = false;
};

struct ModelLine {
  std::string name, plugin;
  status::ModelStatus now;
  status::ModelFeet feet;
  std::string silenced;              ///< why the model was silenced; "" if it was not
  double p50 = 0, p99 = 0, max = 0;  ///< [us] times of a step
  bool traced = false;
};

struct ArmLine {
  std::string name, module;
  status::ArmStatus now;
  double force() const { return std::hypot(now.force[0], now.force[1], now.force[2]); }
  std::string fault() const {
    const auto fault = static_cast<servo::Fault>(now.fault);
    return fault == servo::Fault::kNone ? "" : servo::describe(fault);
  }
};

struct View {
  status::TickStatus now;
  double rate = 0, held = 0;  ///< [Hz] rate that the scene asks for, and ticks per second since the last view
  double late[3] = {}, compute[3] = {};
  std::vector<ArmLine> arms;
  std::vector<ModelLine> models;
  std::vector<diagnostics::ClientStatus> clients;
  double answer_time = 0;  ///< [s]
};

std::string textOf(const char* text, size_t size) {
  return {text, strnlen(text, size)};
}

void quantiles(const status::SharedHistogram& histogram, double* to) {
  to[0] = histogram.quantile(0.5), to[1] = histogram.quantile(0.99), to[2] = histogram.max();
}

View readPage(const status::Page& page) {
  View view;
  view.now = page.now.read().value_or(status::TickStatus{});
  view.rate = page.rate;
  quantiles(page.lateness_us, view.late);
  quantiles(page.compute_us, view.compute);
  for (uint32_t i = 0; i < std::min(page.arms, status::kMaxArms); ++i) {
    const auto name = page.arm[i].name.read().value_or(status::Name{});
    view.arms.push_back({textOf(name.text, sizeof name.text), textOf(name.kind, sizeof name.kind),
                         page.arm[i].now.read().value_or(status::ArmStatus{})});
  }
  for (uint32_t i = 0; i < status::kMaxModels; ++i) {
    const auto name = page.model[i].name.read().value_or(status::Name{});
    if (name.text[0] == '\0') continue;
    ModelLine line{textOf(name.text, sizeof name.text),
                   textOf(name.kind, sizeof name.kind),
                   page.model[i].now.read().value_or(status::ModelStatus{}),
                   page.feet[i].read().value_or(status::ModelFeet{}),
                   "",
                   0,
                   0,
                   0,
                   false};
    const status::SharedHistogram& step = page.model[i].step_us;
    line.p50 = step.quantile(0.5), line.p99 = step.quantile(0.99), line.max = step.max();
    constexpr uint64_t kFresh = 50;  // [ticks] a model whose last step is longer ago is far from the tip
    line.traced = line.now.tick + kFresh >= view.now.tick && std::isfinite(line.now.depth);
    if (!line.traced) line.now.force = 0;
    line.silenced =
        servo::silenceReason(line.name, "FILE.so (`hapticd plugin info " + line.plugin + "` names the file)",
                             static_cast<servo::ShapeFault>(line.now.trouble), line.now.failed_status);
    view.models.push_back(line);
  }
  view.clients = diagnostics::clientsOf(page);
  view.answer_time = page.answer_time;
  return view;
}

void sortModels(std::vector<ModelLine>& models, const std::string& by) {
  std::sort(models.begin(), models.end(), [&](const ModelLine& a, const ModelLine& b) {
    if (by == "force") return a.now.force > b.now.force;
    if (by == "name") return a.name < b.name;
    if (by == "depth") {
      const auto depth = [](const ModelLine& m) { return m.traced ? m.now.depth : -HUGE_VAL; };
      return depth(a) > depth(b);
    }
    return a.p99 != b.p99 ? a.p99 > b.p99 : a.name < b.name;
  });
}

Json jsonOfClients(const View& view) {
  Json clients = Json::array();
  for (const diagnostics::ClientStatus& client : view.clients)
    clients.push_back({{"device", client.report.device},
                       {"program", client.report.program},
                       {"pid", client.report.pid},
                       {"answers", client.report.answers},
                       {"same_tick", client.report.sameTick()},
                       {"next_tick", client.report.nextTick()},
                       {"silences", client.report.silences},
                       {"force_n", client.force},
                       {"largest_n", client.report.largest_n}});
  return clients;
}

Json toJson(const View& view) {
  const auto three = [](const double* q) { return Json{{"p50", q[0]}, {"p99", q[1]}, {"max", q[2]}}; };
  Json devices = Json::array(), models = Json::array();
  for (const ArmLine& arm : view.arms)
    devices.push_back({{"name", arm.name},
                       {"module", arm.module},
                       {"force_n", arm.force()},
                       {"tip_m", arm.now.position},
                       {"samples", arm.now.sequence},
                       {"valid", arm.now.valid != 0},
                       {"fault", arm.now.fault == 0 ? Json() : Json(arm.fault())}});
  for (const ModelLine& m : view.models)
    models.push_back({{"name", m.name},
                      {"plugin", m.plugin},
                      {"step_us", {{"p50", m.p50}, {"p99", m.p99}, {"max", m.max}}},
                      {"force_n", m.now.force},
                      {"depth_mm", m.traced ? Json(m.now.depth * 1e3) : Json()},
                      {"iterations", m.now.iterations},
                      {"gain", m.now.gain},
                      {"feet", {{"nearest", m.feet.nearest}, {"held", m.feet.held}, {"degraded", m.feet.degraded}}},
                      {"status", m.now.status},
                      {"silenced", m.silenced.empty() ? Json() : Json(m.silenced)},
                      {"waits", m.now.waits != 0}});
  return {{"seconds", view.now.t},
          {"ticks", view.now.tick},
          {"rate_hz", view.rate},
          {"held_hz", view.held},
          {"overruns", view.now.overruns},
          {"missed_ticks", view.now.missed},
          {"lateness_us", three(view.late)},
          {"compute_us", three(view.compute)},
          {"devices", devices},
          {"models", models},
          {"clients", jsonOfClients(view)}};
}

/// Returns the table of programs that push; "" if none does.
std::string clientsTable(const View& view) {
  if (view.clients.empty()) return "";
  std::string text = fmt::format("\n{:<28} {:>8} {:<16} {:>9} {:>9} {:>11} {:>11} {:>7}  {}\n", "PROGRAM", "PID",
                                 "DEVICE", "FORCE N", "MAX N", "SAME TICK %", "NEXT TICK %", "SILENT", "ANSWERS");
  bool late = false;
  for (const auto& [client, force] : view.clients) {
    text += fmt::format("{:<28.28} {:>8} {:<16.16} {:9.3f} {:9.3f} {:11.1f} {:11.1f} {:7}  {}{}\n", client.program,
                        client.pid, client.device, force, client.largest_n, 100 * client.sameTick(),
                        100 * client.nextTick(), client.silences, client.answers, record::late(client) ? "  LATE" : "");
    late = late || record::late(client);
  }
  if (late) text += "late: " + record::lateFix(view.answer_time) + "\n";
  return text;
}

/// Returns the word of the column STATUS.
std::string statusOf(const ModelLine& model) {
  if (!model.silenced.empty()) return "SILENCED";
  if (model.now.waits != 0) return "waits for the tip to leave it";
  return model.now.status == HSP_OK ? "ok" : host::statusText(model.now.status);
}

/// Returns the share of the ticks in which the foot point was certain: it was the nearest point, or the contact was
/// held. Ticks without a foot point do not count.
std::string knownShare(const status::ModelFeet& feet) {
  const uint64_t known = feet.nearest + feet.held, all = known + feet.degraded;
  if (all == 0) return "-";
  const double percent = std::floor(1000.0 * static_cast<double>(known) / static_cast<double>(all)) / 10;
  return fmt::format("{:.1f}%", percent);  // rounded down, so that 100 % means all
}

std::string table(const View& view, size_t rows) {
  std::string text = fmt::format(
      "{:10.1f} s   {:.0f} Hz asked, {:.0f} held   {} missed   late {:.1f} / {:.1f} / {:.0f} us   tick {:.1f} / {:.1f} "
      "/ "
      "{:.0f} us  (p50 / p99 / max)\n\n",
      view.now.t, view.rate, view.held, view.now.missed, view.late[0], view.late[1], view.late[2], view.compute[0],
      view.compute[1], view.compute[2]);
  text += fmt::format("{:<28} {:<16} {:>9} {:>26} {:>12}  {}\n", "DEVICE", "MODULE", "FORCE N", "TIP x y z mm",
                      "SAMPLES", "FAULT");
  for (const ArmLine& arm : view.arms)
    text += fmt::format("{:<28.28} {:<16.16} {:9.3f} {:8.1f} {:8.1f} {:8.1f} {:12}  {}\n", arm.name, arm.module,
                        arm.force(), 1e3 * arm.now.position[0], 1e3 * arm.now.position[1], 1e3 * arm.now.position[2],
                        arm.now.sequence, arm.fault());
  text += clientsTable(view);
  text += fmt::format("\n{:<28} {:<16} {:>9} {:>9} {:>8} {:>8} {:>8} {:>5} {:>7}  {}\n", "MODEL", "PLUGIN", "FORCE N",
                      "DEPTH mm", "p50 us", "p99 us", "max us", "ITER", "KNOWN", "STATUS");
  for (size_t i = 0; i < std::min(rows, view.models.size()); ++i) {
    const ModelLine& m = view.models[i];
    const std::string depth = m.traced ? fmt::format("{:.3f}", m.now.depth * 1e3) : "-";
    text += fmt::format("{:<28.28} {:<16.16} {:9.3f} {:>9} {:8.2f} {:8.2f} {:8.1f} {:5} {:>7}  {}\n", m.name, m.plugin,
                        m.now.force, depth, m.p50, m.p99, m.max, m.now.iterations, knownShare(m.feet), statusOf(m));
  }
  if (view.models.size() > rows) text += fmt::format("... and {} more\n", view.models.size() - rows);
  for (const ModelLine& m : view.models)
    if (!m.silenced.empty()) text += m.silenced + "\n";
  return text;
}

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

/// Returns the ticks per second between two views.
double heldSince(const status::TickStatus& before, const status::TickStatus& now) {
  const double passed = now.t - before.t;
  return passed > 0 ? static_cast<double>(now.tick - before.tick) / passed : 0;
}

int watch(const TopArguments& options, const status::Page& page) {
  const RawKeys keys;
  std::string sort = options.sort;
  constexpr size_t kRows = 30;
  status::TickStatus before{};  // so the first view shows the mean since the start of the run
  for (char key = 0; key != 'q'; key = keys.wait(options.every)) {
    if (key == 'n') sort = "name";
    if (key == 'f') sort = "force";
    if (key == 'd') sort = "depth";
    if (key == 's') sort = "step";
    View view = readPage(page);
    view.held = heldSince(before, view.now);
    before = view.now;
    sortModels(view.models, sort);
    std::printf("\033[H\033[J%s\nsort: s step, f force, d depth, n name (now %s); q ends\n", table(view, kRows).c_str(),
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
    View view = readPage(page);
    view.held = heldSince(before, view.now);
    before = view.now;
    sortModels(view.models, options.sort);
    if (std::printf("%s\n", toJson(view).dump().c_str()) < 0 || std::fflush(stdout) != 0) return kWorked;
    clock.waitUntil(clock.now() + static_cast<Nanoseconds>(options.every * 1e9));
  }
  return endOfDaemon(options);
}

/// Returns true if the page does not change. The page of a stopped process exists, so the process would seem to run.
/// @param tick tick that the page showed before
bool standsStill(const status::Page& page, uint64_t tick) {
  constexpr Nanoseconds kLook = 10'000'000, kPatience = 500'000'000;
  RealClock clock(0);
  const Nanoseconds end = clock.now() + kPatience;
  while (clock.now() < end) {
    if (ended(page) || page.now.read().value_or(status::TickStatus{}).tick != tick) return false;
    clock.waitUntil(clock.now() + kLook);
  }
  return true;
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
  View view = readPage(page);
  const bool still = standsStill(page, view.now.tick);
  view.held = view.now.t > 0 && !still ? static_cast<double>(view.now.tick) / view.now.t : 0;
  sortModels(view.models, options.sort);
  std::fputs(options.json ? (toJson(view).dump() + "\n").c_str() : table(view, view.models.size()).c_str(), stdout);
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

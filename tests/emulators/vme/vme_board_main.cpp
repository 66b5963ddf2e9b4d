// SPDX-License-Identifier: MIT
/// Runs an arm controller board on a slave window of a VME bus, or on a plain file that stands in for it.
///
///   vme_board WINDOW --arm FILE [--plugin-path DIR] [--rate HZ] [--for S] [--fault NAME --at S --lasts S [--in-force]]
///
/// WINDOW: /dev/bus/vme/s0, or a file, which is made. FILE: a simulated arm of eight joints with its hand, such as
/// config/devices/simulated-sarcos.yaml. NAME: silent, torn, corrupt, protocol, hydraulics, jump, half-rate, absent,
/// in-turn, restart; with --in-force, S counts from the first torque that was ordered. Says "ready" once its first
/// state block is written, and at the end how many commands came.
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <map>

#include "base/clock.hpp"
#include "base/os.hpp"
#include "command_line/command_line.hpp"
#include "emulators/vme/vme_board.hpp"
#include "vme/vme_user.hpp"

namespace hapticd::emulator {
namespace {

constexpr off_t kState = 0, kCommand = 0x100;
constexpr uint64_t kBase = 0x100000, kSize = 0x10000;  // as config/devices/sarcos.yaml has them
volatile std::sig_atomic_t g_stop = 0;

struct Options {
  std::string window, arm, fault;
  std::vector<std::string> modules;
  double rate = 1500, duration = 1e9, at = 1, lasts = 0.5;
  bool in_force = false;
};

const std::map<std::string, VmeFault> kFaults = {{"silent", VmeFault::kSilent},   {"torn", VmeFault::kTorn},
                                                 {"corrupt", VmeFault::kCorrupt}, {"protocol", VmeFault::kProtocol},
                                                 {"jump", VmeFault::kJump},       {"half-rate", VmeFault::kHalfRate},
                                                 {"absent", VmeFault::kAbsent},   {"hydraulics", VmeFault::kHydraulics},
                                                 {"in-turn", VmeFault::kInTurn},  {"restart", VmeFault::kNone}};

std::vector<std::string> faultNames() {
  std::vector<std::string> names;
  for (const auto& [name, fault] : kFaults) names.push_back(name);
  return names;
}

int openWindow(const std::string& path) {
  const int fd = open(path.c_str(), O_RDWR | O_CLOEXEC | (path.rfind("/dev/", 0) == 0 ? 0 : O_CREAT), 0600);
  struct stat about{};
  if (fd < 0 || fstat(fd, &about) != 0) return -1;
  if (S_ISREG(about.st_mode)) return ftruncate(fd, kSize) == 0 ? fd : -1;
  vme::PackedSlave slave{1, kBase, kSize, vme::kA24, vme::kSingle | vme::kUser | vme::kData};
  return ioctl(fd, vme::kSetSlave, &slave) == 0 ? fd : -1;
}

bool writeState(int fd, const VmeBlock& state) {
  // The last number is the word that says that the rest is whole.
  constexpr size_t kBody = kVmeBlock - 2;
  return pwrite(fd, state.data(), kBody, kState) == static_cast<ssize_t>(kBody) &&
         pwrite(fd, state.data() + kBody, 2, kState + static_cast<off_t>(kBody)) == 2;
}

int serve(int fd, VmeBoard& board, const Options& options) {
  RealClock clock(0);
  const Nanoseconds start = clock.now(), period = static_cast<Nanoseconds>(1e9 / options.rate);
  const auto at = [&](double s) { return start + static_cast<Nanoseconds>(s * 1e9); };
  VmeBlock command{}, state{};
  (void)!pwrite(fd, command.data(), command.size(), kCommand);
  uint64_t pushed = 0, cycles = 0, longest = 0;
  bool restarted = false;
  Nanoseconds before = start, zero = options.in_force ? 0 : start;  // the faults' time; 0: it has not come
  const auto since = [&](Nanoseconds now) { return zero == 0 ? -1.0 : static_cast<double>(now - zero) * 1e-9; };
  for (Nanoseconds due = start + period; g_stop == 0 && due < at(options.duration); due += period) {
    const Nanoseconds now = clock.waitUntil(due);
    const bool wrong = !options.fault.empty() && since(now) >= options.at && since(now) < options.at + options.lasts;
    if (wrong && options.fault == "restart" && !restarted) board.restart(), restarted = true;
    board.spoil(wrong ? kFaults.at(options.fault) : VmeFault::kNone);
    if (pread(fd, command.data(), command.size(), kCommand) != static_cast<ssize_t>(command.size())) return 1;
    longest = std::max(longest, now - before);
    if (board.cycle(command, state, static_cast<double>(now - before) * 1e-9) && !writeState(fd, state)) return 1;
    before = now;
    pushed += board.pushed() ? 1 : 0;
    if (zero == 0 && board.pushed()) zero = now;
    if (++cycles == 1) std::printf("ready\n"), std::fflush(stdout);
    if (now > due + 50 * period) due = now;  // the machine held it up: no burst
  }
  std::printf("%llu cycles, %llu commands, valves open in %llu, longest cycle %.1f ms\n",
              static_cast<unsigned long long>(cycles), static_cast<unsigned long long>(board.commands()),
              static_cast<unsigned long long>(pushed), static_cast<double>(longest) * 1e-6);
  return 0;
}

int run(const Options& options) {
  host::SearchPath path = host::SearchPath::standard();
  path.prepend({options.modules.begin(), options.modules.end()});
  host::Catalog catalog(path);
  VmeBoard board(options.arm, catalog);
  const int fd = openWindow(options.window);
  if (fd < 0) return std::perror(options.window.c_str()), 1;
  (void)os::setFifo(os::kServoPriority + 10);  // hardware waits for no program
  const int result = serve(fd, board, options);
  close(fd);
  return result;
}

}  // namespace
}  // namespace hapticd::emulator

int main(int argc, char** argv) {
  using namespace hapticd;
  using namespace hapticd::emulator;
  Options options;
  const command_line::Program app("An arm controller board on a VME bus");
  app.addOption("window", options.window).required();
  app.addOption("--arm", options.arm).required();
  app.addOption("--plugin-path", options.modules);
  app.addOption("--rate", options.rate);
  app.addOption("--for", options.duration);
  app.addOption("--fault", options.fault).oneOf(faultNames());
  app.addOption("--at", options.at);
  app.addOption("--lasts", options.lasts);
  app.addFlag("--in-force", options.in_force);
  if (const auto ended = app.parse(argc, argv)) return *ended;
  for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, [](int) { g_stop = 1; });
  try {
    return run(options);
  } catch (const std::exception& e) {
    return std::fprintf(stderr, "vme_board: %s\n", e.what()), 1;
  }
}

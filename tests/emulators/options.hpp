// SPDX-License-Identifier: MIT
/// What every program that plugs in an emulated arm understands, and the signals that lead it:
/// SIGUSR1 unplugs the arm (and plugs it in again after --replug-after), SIGUSR2 lets the hand begin, SIGHUP has a
/// fault read from the file of --faults, SIGTERM ends the program.
#pragma once
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "emulators/emulated_arm.hpp"

namespace hapticd::emulator {

struct Options {
  std::string kind, serial = "0001";
  double replug_after = -1;  ///< [s]; < 0: it stays away
  bool hold = false;         ///< the hand waits for SIGUSR2
  bool latency = false;      ///< the encoders step, and how long answers take is told at the end
  std::string faults;        ///< file of a fault's name, read at SIGHUP; empty: none
  simulated::Parameters hand;
};

inline volatile std::sig_atomic_t g_unplug = 0, g_begin = 0, g_order = 0, g_end = 0;

[[noreturn]] inline void exitWithUsage(const char* program) {
  std::fprintf(stderr,
               "usage: %s KIND [--serial S] [--replug-after S] [--hand-stiffness N/m] [--hand-rise M]\n"
               "       [--hold 1] [--latency 1] [--faults FILE]\n  kinds:",
               program);
  for (const std::string& kind : emulatedKinds()) std::fprintf(stderr, " %s", kind.c_str());
  std::fprintf(stderr, "\n");
  std::exit(2);
}

/// Exits with a usage text when the arguments are wrong.
inline Options readOptions(int argc, char** argv) {
  Options o;
  if (argc < 2 || argc % 2 != 0) exitWithUsage(argv[0]);
  o.kind = argv[1];
  o.hand = defaultHand(o.kind);
  for (int i = 2; i + 1 < argc; i += 2) {
    const std::string name = argv[i];
    if (name == "--serial")
      o.serial = argv[i + 1];
    else if (name == "--replug-after")
      o.replug_after = std::atof(argv[i + 1]);
    else if (name == "--hand-stiffness")
      o.hand.hand_stiffness = std::atof(argv[i + 1]);
    else if (name == "--hand-rise")
      o.hand.rise = std::atof(argv[i + 1]);
    else if (name == "--latency")
      o.latency = std::atoi(argv[i + 1]) != 0;
    else if (name == "--faults")
      o.faults = argv[i + 1];
    else if (name == "--hold")
      o.hold = std::atoi(argv[i + 1]) != 0;
    else
      exitWithUsage(argv[0]);
  }
  std::signal(SIGUSR1, [](int) { g_unplug = 1; });
  std::signal(SIGUSR2, [](int) { g_begin = 1; });
  std::signal(SIGHUP, [](int) { g_order = 1; });
  std::signal(SIGTERM, [](int) {
    g_end = 1;
    g_unplug = 1;
  });
  return o;
}

/// Where the hand begins, for whoever puts a scene before it.
inline void tellTip(const EmulatedArm& arm) {
  const Eigen::Vector3d tip = arm.start();
  std::printf("tip %.6f %.6f %.6f\n", tip.x(), tip.y(), tip.z());
  std::fflush(stdout);
}

}  // namespace hapticd::emulator

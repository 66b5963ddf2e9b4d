// SPDX-License-Identifier: MIT
/// Runs a program, such as hapticd, as a child that finds an emulated WoodenHaptics plugged in.
/// Usage: LD_PRELOAD=libumockdev-preload.so.0 hidraw_host COMMAND ARGUMENT...
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>

#include "played_hidraw.hpp"

int main(int argc, char** argv) {
  using namespace hapticd::emulator;
  if (argc < 2) return std::fprintf(stderr, "usage: hidraw_host COMMAND ARGUMENT...\n"), 2;
  UMockdevTestbed* testbed = umockdev_testbed_new();
  int result = 1;
  {
    EmulatedArm arm("woodenhaptics", defaultHand("woodenhaptics"));
    PlayedHidraw device(testbed, 0, arm, "A1");
    device.plug();
    const pid_t child = fork();
    if (child == 0) {
      execvp(argv[1], argv + 1);
      std::perror(argv[1]);
      _exit(127);
    }
    int status = 0;
    waitpid(child, &status, 0);
    result = WIFEXITED(status) ? WEXITSTATUS(status) : 1;
    std::fprintf(stderr, "hidraw_host: %llu commands, motors %s\n", static_cast<unsigned long long>(arm.commands()),
                 arm.pushed() ? "ON" : "off");
  }
  g_object_unref(testbed);
  return result;
}

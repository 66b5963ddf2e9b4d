// SPDX-License-Identifier: MIT
/// Runs a program, such as hapticd, as a child that finds an emulated arm plugged in.
/// Usage: LD_PRELOAD=libumockdev-preload.so.0 hidraw_host KIND COMMAND ARGUMENT...
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>

#include "played_hidraw.hpp"

int main(int argc, char** argv) {
  using namespace hapticd::emulator;
  if (argc < 3) return std::fprintf(stderr, "usage: hidraw_host KIND COMMAND ARGUMENT...\n"), 2;
  UMockdevTestbed* testbed = umockdev_testbed_new();
  int result = 1;
  {
    EmulatedArm arm(argv[1], defaultHand(argv[1]));
    PlayedHidraw device(testbed, 0, arm, "A1");
    device.plug();
    const pid_t child = fork();
    if (child == 0) {
      execvp(argv[2], argv + 2);
      std::perror(argv[2]);
      _exit(127);
    }
    int status = 0;
    waitpid(child, &status, 0);
    result = WIFEXITED(status) ? WEXITSTATUS(status) : 1;
    std::fprintf(stderr, "hidraw_host: %llu commands, motors %s, searches of the zero: %d, found: %d\n",
                 static_cast<unsigned long long>(arm.commands()), arm.pushed() ? "ON" : "off", arm.searches(),
                 arm.zeros());
  }
  g_object_unref(testbed);
  return result;
}

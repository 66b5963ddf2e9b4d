// SPDX-License-Identifier: MIT
#include "watch/signal_names.hpp"

#include <csignal>
#include <cstring>

namespace hapticd::watch {

const char* crashName(int signal) noexcept {
  switch (signal) {
    case SIGSEGV:
      return "a memory access that is not allowed (SIGSEGV)";
    case SIGBUS:
      return "a memory access that cannot be done (SIGBUS)";
    case SIGFPE:
      return "an arithmetic exception (SIGFPE)";
    case SIGILL:
      return "an instruction that this processor lacks (SIGILL)";
    case SIGABRT:
      return "an abort, such as an uncaught exception or a failed assertion (SIGABRT)";
    case SIGXCPU:
      return "a servo thread that never slept (SIGXCPU)";
    case SIGTRAP:
      return "a breakpoint without a debugger (SIGTRAP)";
    case SIGSYS:
      return "a system call that does not exist (SIGSYS)";
    default:
      return nullptr;
  }
}

Line signalName(int signal) noexcept {
  Line line;
  if (const char* known = crashName(signal)) return line.add(known);
  line.add("a signal that ends a process (");
  if (const char* name = sigabbrev_np(signal)) return line.add("SIG").add(name).add(")");
  const int number = signal - SIGRTMIN;
  const char digits[] = {static_cast<char>('0' + number / 10 % 10), static_cast<char>('0' + number % 10), '\0'};
  return line.add("SIGRTMIN+").add(digits).add(")");
}

}  // namespace hapticd::watch

// SPDX-License-Identifier: MIT
/// A plugin that harms the process that runs it, in the way that its parameter names.
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <thread>

#include "hapticd/shape.hpp"

namespace {

/// Crashes when the process ends, if it was told to.
struct AtTheEnd {
  bool crashes = false;
  ~AtTheEnd() {
    if (crashes) std::raise(SIGSEGV);
  }
};
AtTheEnd at_the_end;

struct Harmful : hapticd::Shape {
  static constexpr const char* kHows[] = {"good",  "loop",  "pause",  "sleep",      "exit", "quick_exit",
                                          "close", "stack", "thread", "destructor", "fork"};
  static constexpr hapticd::ShapeInfo kInfo{"org.hapticd.test.harmful", "harmful", "1.0.0", "MIT", "Harms its host."};
  int how, ticks = 0;
  static constexpr auto fields() {
    return std::array{hapticd::Fields<Harmful>::choice("how", &Harmful::how, kHows, 0, "What it does.")};
  }

  void activate(const hsp_activation&, hsp_report& report) {
    report.max_stiffness = 1000;
    while (how == 1) asm volatile("");
    if (how == 8)
      std::thread([] {
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
        volatile int* volatile nowhere = nullptr;
        *nowhere = 1;
      }).detach();
    if (how == 9) at_the_end.crashes = true;
    if (how == 10 && fork() == 0) {
      alarm(60);
      for (;;) pause();
    }
  }

  hsp_status touch(const hsp_probe&, const hsp_step&, hsp_contact& out) noexcept HSP_RT {
    out.force[1] = 1;
    out.flags = HSP_OUT_TRACED | HSP_OUT_CONTACT;
    out.normal[1] = 1;
    if (++ticks < 10) return HSP_OK;
    while (how == 2) pause();
    if (how == 3) usleep(1000);
    if (how == 4) std::exit(0);
    if (how == 5) _exit(0);
    for (int fd = 3; how == 6 && ticks == 10 && fd < 200; ++fd) close(fd);
    if (how == 7) out.depth_m = fill(0);
    return HSP_OK;
  }

  /// Calls itself until the stack is full.
  static int fill(int depth) noexcept {
    volatile char room[4096] = {static_cast<char>(depth)};
    return depth < 0 ? 0 : fill(depth + 1) + room[depth % 4096];
  }
};

}  // namespace

HAPTICD_SHAPES(Harmful)

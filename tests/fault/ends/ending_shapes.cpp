// SPDX-License-Identifier: MIT
/// Shapes that end the process in one of many ways, take long, or answer what is no answer.
#include <pthread.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <csignal>
#include <cstddef>
#include <cstdlib>
#include <ctime>
#include <string>
#include <string_view>
#include <thread>

#include "hapticd/shape.hpp"

namespace {

using hapticd::Fields;

void crash() {
  volatile int* volatile nowhere = nullptr;
  *nowhere = 1;
}

struct Ending : hapticd::Shape {
  int how, ticks = 0;
  static constexpr const char* kHows[] = {
      "never",           "exit",       "quick_exit",  "exit_in_thread", "segv_in_thread",
      "abort_in_thread", "raise",      "kill_itself", "timer",          "masked_segv",
      "reset_segv",      "plain_exit", "raw_exit",    "loop",           "segv"};
  int signal, after;
  static constexpr hapticd::ShapeInfo kInfo{"org.hapticd.test.ending", "ending", "1.0.0", "MIT", "Ends the process."};
  static constexpr auto fields() {
    using F = Fields<Ending>;
    return std::array{F::choice("how", &Ending::how, kHows, 0, "How it ends the process."),
                      F::integer("signal", &Ending::signal, "", 1, 64, SIGUSR1, "Of raise and kill_itself."),
                      F::integer("after", &Ending::after, "", 1, 1000000, 400, "Steps before that.")};
  }
  void activate(const hsp_activation&, hsp_report& report) { report.max_stiffness = 1000; }
  hsp_status touch(const hsp_probe&, const hsp_step&, hsp_contact& out) noexcept HSP_RT {
    out.force[1] = 1;
    if (++ticks == after) end();
    return HSP_OK;
  }

 private:
  static void elsewhere(void (*what)()) { std::thread(what).detach(); }
  void end() {
    sigset_t all;
    sigfillset(&all);
    const std::string wish = kHows[how];
    if (wish == "exit") std::exit(0);
    if (wish == "quick_exit") std::quick_exit(0);
    if (wish == "exit_in_thread") elsewhere([] { std::exit(0); });
    if (wish == "segv_in_thread") elsewhere(&crash);
    if (wish == "abort_in_thread") elsewhere([] { std::abort(); });
    if (wish == "raise") std::raise(signal);
    if (wish == "kill_itself") kill(getpid(), signal);
    if (wish == "timer") {
      const itimerval soon{{0, 0}, {0, 1000}};
      setitimer(ITIMER_REAL, &soon, nullptr);
    }
    if (wish == "masked_segv") pthread_sigmask(SIG_BLOCK, &all, nullptr), crash();
    if (wish == "reset_segv") std::signal(SIGSEGV, SIG_DFL), crash();
    if (wish == "plain_exit") _exit(0);
    if (wish == "raw_exit") syscall(SYS_exit_group, 0);
    if (wish == "segv") crash();
    for (volatile int turns = 0; wish == "loop";) turns = turns + 1;
  }
};

/// Takes its time: in a step, to be set up, or to be drawn.
struct Slow : hapticd::Shape {
  double busy, setting_up, drawing;
  int ticks = 0;
  static constexpr hapticd::ShapeInfo kInfo{"org.hapticd.test.slow", "slow", "1.0.0", "MIT", "Takes long."};
  static constexpr auto fields() {
    using F = Fields<Slow>;
    return std::array{F::real("busy", &Slow::busy, "s", 0, 1, 0, "CPU time of each step after the first hundred."),
                      F::real("setting_up", &Slow::setting_up, "s", 0, 1e6, 0, "In activate()."),
                      F::real("drawing", &Slow::drawing, "s", 0, 1e6, 0, "In tessellate().")};
  }
  void activate(const hsp_activation&, hsp_report&) { rest(setting_up); }
  hsp_status touch(const hsp_probe&, const hsp_step&, hsp_contact& out) noexcept HSP_RT {
    out.force[0] = 0.25;
    for (const double until = cpu() + busy; ++ticks > 100 && busy > 0 && cpu() < until;) {
    }
    return HSP_OK;
  }
  const void* extension(const char* name) {
    static constexpr hsp_ext_geometry kGeometry{sizeof(hsp_ext_geometry), 0, &tessellate, &bounds};
    return std::string(name) == HSP_EXT_GEOMETRY ? &kGeometry : nullptr;
  }

 private:
  static double cpu() noexcept {
    timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  }
  static void rest(double seconds) { std::this_thread::sleep_for(std::chrono::duration<double>(seconds)); }
  static hsp_status tessellate(hsp_shape* shape, double, hsp_mesh*) {
    rest(reinterpret_cast<Slow*>(shape)->drawing);
    return HSP_OK;
  }
  static hsp_status bounds(hsp_shape*, double*, double*) { return HSP_E_UNSUPPORTED; }
};

/// Overwrites what the C library keeps about a block that was freed, so that a later malloc() of anyone aborts.
class TornBlock {
 public:
  /// Three blocks that lie side by side: the one between them stays a block of its own when it is freed.
  void prepare() {
    for (auto& block : blocks_) block = static_cast<size_t*>(std::malloc(kBytes));
    for (size_t i = 0; i + 2 < blocks_.size(); ++i)
      if (blocks_[i + 1] - blocks_[i] == kApart && blocks_[i + 2] - blocks_[i + 1] == kApart) torn_ = blocks_[i + 1];
  }
  void tear() {
    std::free(torn_);
    torn_[-1] = ~size_t{0};  // its size
  }

 private:
  static constexpr size_t kBytes = 4000;  // too large for the lists that malloc() does not check
  static constexpr ptrdiff_t kApart = (kBytes + 2 * sizeof(size_t)) / sizeof(size_t);
  std::array<size_t*, 64> blocks_{};
  size_t* torn_ = nullptr;
};

/// Crashes in one of its functions; or answers surfaces that it does not have.
struct Broken : hapticd::Shape {
  int where, surfaces, steps = 0;
  static constexpr const char* kWheres[] = {"nowhere",       "set_up",      "reset",  "stored",     "search",
                                            "start_tracing", "lies",        "thread", "taken_down", "destroyed",
                                            "set_up_exit",   "set_up_loop", "tears"};
  static constexpr hapticd::ShapeInfo kInfo{"org.hapticd.test.broken", "broken", "1.0.0", "MIT", "Crashes."};
  static constexpr auto fields() {
    using F = Fields<Broken>;
    return std::array{F::choice("where", &Broken::where, kWheres, 0, "Where it crashes, after some steps."),
                      F::integer("surfaces", &Broken::surfaces, "", 1, 2000000000, 4, "That it says it has.")};
  }
  ~Broken() {
    if (is("destroyed")) crash();
  }
  void deactivate() {
    if (is("taken_down")) crash();
  }
  void activate(const hsp_activation&, hsp_report&) {
    if (is("set_up")) crash();
    if (is("set_up_exit")) _exit(0);
    if (is("tears")) memory_.prepare();
    for (volatile int turns = 0; is("set_up_loop");) turns = turns + 1;
    if (is("thread"))
      std::thread([] {
        for (;;) std::this_thread::sleep_for(std::chrono::milliseconds(1));
      }).detach();
    surfaces_ = {sizeof surfaces_, static_cast<uint32_t>(surfaces), &nearby, &start, &end};
  }
  void reset() noexcept HSP_RT {
    if (is("reset")) crash();
  }
  hsp_status touch(const hsp_probe&, const hsp_step&, hsp_contact& out) noexcept HSP_RT {
    out.force[1] = 0.5;
    if (is("tears") && ++steps == 400) memory_.tear();
    return is("reset") && ++steps > 400 ? HSP_E_NUMERIC : HSP_OK;
  }
  const void* extension(const char* name) {
    static constexpr hsp_ext_energy kEnergy{sizeof(hsp_ext_energy), 0, &stored};
    const bool searched = is("search") || is("start_tracing") || is("lies") || surfaces != 4;
    if (std::string(name) == HSP_EXT_SURFACES) return searched ? &surfaces_ : nullptr;
    return std::string(name) == HSP_EXT_ENERGY ? &kEnergy : nullptr;
  }

 private:
  bool is(const char* what) const { return std::string_view(kWheres[where]) == what; }
  static Broken& of(hsp_shape* shape) { return *reinterpret_cast<Broken*>(shape); }
  static double stored(hsp_shape* shape) noexcept {
    if (of(shape).is("stored") && ++of(shape).steps > 400) crash();
    return 0;
  }
  static int64_t nearby(const hsp_shape* shape, const double*, double, hsp_near* near, uint64_t cap) {
    auto& self = *const_cast<Broken*>(reinterpret_cast<const Broken*>(shape));
    if (self.is("search") && ++self.steps > 20) crash();
    if (!self.is("lies")) return cap > 0 ? (near[0] = hsp_near{0, 0, {0, 0}, 0}, 1) : 1;
    const double nan = 0.0 / std::strtod("0", nullptr);
    const hsp_near lies[] = {{4, 0, {0, 0}, 0},       {4'000'000'000u, 0, {0, 0}, 0}, {1, 7, {nan, 0}, 0},
                             {2, 0, {0, 1e308}, nan}, {3, 4'000'000'000u, {0, 0}, 0}, {0, 0, {0, 0}, 0}};
    for (uint64_t i = 0; i < cap; ++i) near[i] = lies[i % 6];
    return ++self.steps % 2 == 0 ? INT64_MAX : static_cast<int64_t>(cap);
  }
  static hsp_status start(hsp_shape* shape, const hsp_near*) noexcept {
    if (of(shape).is("start_tracing")) crash();
    return HSP_OK;
  }
  static hsp_status end(hsp_shape*, uint32_t, uint32_t) noexcept { return HSP_OK; }
  hsp_ext_surfaces surfaces_{};
  TornBlock memory_;
};

}  // namespace

HAPTICD_SHAPES(Ending, Slow, Broken)

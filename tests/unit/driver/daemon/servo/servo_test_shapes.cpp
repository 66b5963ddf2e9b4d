// SPDX-License-Identifier: MIT
/// Small shapes with known answers, and shapes that misbehave, for the tests of the servo.
#include <pthread.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cmath>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <limits>
#include <string_view>

#include "hapticd/shape.hpp"
#include "search_hook.hpp"

namespace {

using hapticd::Fields;

/// Solid half space y < 0 of the model frame: depth is -y, force stiffness * depth + damping * closing speed.
struct Wall : hapticd::Shape {
  double stiffness, damping;
  static constexpr hapticd::ShapeInfo kInfo{"org.hapticd.test.wall", "wall", "1.0.0", "MIT", "A wall."};
  static constexpr auto fields() {
    using F = Fields<Wall>;
    return std::array{
        F::real("stiffness", &Wall::stiffness, "N/m", 0, 1e6, 1000, "Stiffness.", HSP_P_LIVE | HSP_P_SAFETY),
        F::real("damping", &Wall::damping, "N s/m", 0, 1e3, 0, "Damping.")};
  }
  void activate(const hsp_activation&, hsp_report& report) {
    report.max_stiffness = stiffness;
    report.flags = damping > 0 ? static_cast<uint32_t>(HSP_R_VELOCITY) : 0u;
  }
  hsp_status touch(const hsp_probe& in, const hsp_step&, hsp_contact& out) noexcept HSP_RT {
    out.flags = HSP_OUT_TRACED;
    out.depth_m = -in.position[1];
    out.point[0] = in.position[0], out.point[2] = in.position[2];
    out.normal[1] = 1;
    if (out.depth_m <= 0 || (in.flags & HSP_IN_INVALID) != 0) return HSP_OK;
    out.flags |= HSP_OUT_CONTACT;
    out.force[1] = std::fmax(0.0, stiffness * out.depth_m - damping * in.velocity[1]);
    return HSP_OK;
  }
};

/// A wall with the wrong sign.
struct Pulling : hapticd::Shape {
  double stiffness;
  static constexpr hapticd::ShapeInfo kInfo{"org.hapticd.test.pulling", "pulling", "1.0.0", "MIT",
                                            "Pulls the hand in."};
  static constexpr auto fields() {
    return std::array{Fields<Pulling>::real("stiffness", &Pulling::stiffness, "N/m", 0, 1e6, 1000, "Stiffness.")};
  }
  void activate(const hsp_activation&, hsp_report& report) { report.max_stiffness = stiffness; }
  hsp_status touch(const hsp_probe& in, const hsp_step&, hsp_contact& out) noexcept HSP_RT {
    out.flags = HSP_OUT_TRACED;
    out.depth_m = -in.position[1];
    out.point[0] = in.position[0], out.point[2] = in.position[2];
    out.normal[1] = 1;
    if (out.depth_m <= 0 || (in.flags & HSP_IN_INVALID) != 0) return HSP_OK;
    out.flags |= HSP_OUT_CONTACT;
    out.force[1] = -stiffness * out.depth_m;
    return HSP_OK;
  }
};

/// Pushes with 1 N along y until tick `after`, then answers as `how` says for `times` ticks.
struct Misbehaving : hapticd::Shape {
  int how, after, times;
  int ticks = 0;
  static constexpr const char* kHows[] = {"not_finite", "bad_status", "lost", "degraded", "huge"};
  static constexpr hapticd::ShapeInfo kInfo{"org.hapticd.test.misbehaving", "misbehaving", "1.0.0", "MIT",
                                            "Misbehaves."};
  static constexpr auto fields() {
    using F = Fields<Misbehaving>;
    return std::array{F::choice("how", &Misbehaving::how, kHows, 0, "What goes wrong."),
                      F::integer("after", &Misbehaving::after, "", 0, 1000000000, 10, "Good ticks before."),
                      F::integer("times", &Misbehaving::times, "", 0, 1000000, 1, "Bad ticks.")};
  }
  void activate(const hsp_activation&, hsp_report&) {}
  hsp_status touch(const hsp_probe&, const hsp_step&, hsp_contact& out) noexcept HSP_RT {
    out.force[1] = 1;
    const bool bad = ticks >= after && ticks < after + times;
    ++ticks;
    if (!bad) return HSP_OK;
    if (how == 0) out.force[0] = std::numeric_limits<double>::quiet_NaN();
    if (how == 4) out.force[0] = 1e200;
    return how == 1 ? -77 : how == 2 ? HSP_E_NUMERIC : how == 3 ? HSP_DEGRADED : HSP_OK;
  }
};

/// Pushes and turns the hand; or turns it round in each tick from the tenth on.
struct Turning : hapticd::Shape {
  int ticks = 0;
  double kick;
  static constexpr hapticd::ShapeInfo kInfo{"org.hapticd.test.turning", "turning", "1.0.0", "MIT", "Turns."};
  static constexpr auto fields() {
    return std::array{Fields<Turning>::real("kick", &Turning::kick, "N m", 0, 1e6, 0, "That turns round.")};
  }
  void activate(const hsp_activation&, hsp_report&) {}
  hsp_status touch(const hsp_probe&, const hsp_step&, hsp_contact& out) noexcept HSP_RT {
    out.force[1] = 1;
    out.torque[0] = 0.25;
    if (kick > 0 && ++ticks > 10) out.torque[0] = ticks % 2 == 0 ? kick : -kick;
    return HSP_OK;
  }
};

/// Pushes with as many newtons as the seconds of its time.
struct Clocked : hapticd::Shape {
  int unused;
  static constexpr hapticd::ShapeInfo kInfo{"org.hapticd.test.clocked", "clocked", "1.0.0", "MIT", "Tells the time."};
  static constexpr auto fields() {
    return std::array{Fields<Clocked>::integer("unused", &Clocked::unused, "", 0, 1, 0, "Nothing.")};
  }
  void activate(const hsp_activation&, hsp_report&) {}
  hsp_status touch(const hsp_probe& in, const hsp_step&, hsp_contact& out) noexcept HSP_RT {
    out.force[1] = 1e-9 * static_cast<double>(in.time_ns);
    return HSP_OK;
  }
};

/// Turns the hand back toward where it was at first, by 2 N m for each radian.
struct Aligning : hapticd::Shape {
  int unused;
  static constexpr hapticd::ShapeInfo kInfo{"org.hapticd.test.aligning", "aligning", "1.0.0", "MIT", "Aligns."};
  static constexpr auto fields() {
    return std::array{Fields<Aligning>::integer("unused", &Aligning::unused, "", 0, 1, 0, "Nothing.")};
  }
  void activate(const hsp_activation&, hsp_report& report) { report.flags = HSP_R_ORIENTATION; }
  hsp_status touch(const hsp_probe& in, const hsp_step&, hsp_contact& out) noexcept HSP_RT {
    for (int i = 0; i < 3; ++i) out.torque[i] = -4 * in.orientation[1 + i];
    return HSP_OK;
  }
};

/// Pushes as it is told while it runs; or also turns round in each tick.
struct Obliging : hapticd::Shape {
  double wish, whim;
  bool kicks;
  int ticks = 0;
  static constexpr hapticd::ShapeInfo kInfo{"org.hapticd.test.obliging", "obliging", "1.0.0", "MIT", "Obliges."};
  static constexpr auto fields() {
    using F = Fields<Obliging>;
    return std::array{F::real("wish", &Obliging::wish, "N", 0, 1e3, 0, "Force.", HSP_P_LIVE | HSP_P_SAFETY),
                      F::boolean("kicks", &Obliging::kicks, false, "It takes each tick as its chance."),
                      F::real("whim", &Obliging::whim, "N", 0, 1e3, 0, "Force without consent.", HSP_P_LIVE)};
  }
  void activate(const hsp_activation&, hsp_report&) {}
  hsp_status touch(const hsp_probe&, const hsp_step&, hsp_contact& out) noexcept HSP_RT {
    out.force[1] = kicks && ++ticks % 2 == 0 ? -wish : wish + whim;
    return HSP_OK;
  }
};

/// A wall that falls along -x at 1 m/s, for poses and relative velocity.
struct Sliding : hapticd::Shape {
  static constexpr hapticd::ShapeInfo kInfo{
      "org.hapticd.test.sliding", "sliding", "1.0.0", "MIT", "Moves.", HSP_C_MOVES};
  int unused;
  static constexpr auto fields() {
    return std::array{Fields<Sliding>::integer("unused", &Sliding::unused, "", 0, 1, 0, "Nothing.")};
  }
  void activate(const hsp_activation&, hsp_report& report) { report.flags = HSP_R_MOVES | HSP_R_VELOCITY; }
  hsp_status touch(const hsp_probe& in, const hsp_step& step, hsp_contact& out) noexcept HSP_RT {
    step.pose->position[0] -= step.dt_s;
    step.pose->linear[0] = -1;
    out.force[0] = in.velocity[0];  // what the shape was told, to be read by the test
    return HSP_OK;
  }
};

/// Moves along x, and pushes with 1 N along x, against its normal. Its quaternion may have another length than 1.
struct Ramming : hapticd::Shape {
  double speed, length;
  static constexpr hapticd::ShapeInfo kInfo{"org.hapticd.test.ramming", "ramming",  "1.0.0", "MIT",
                                            "Pushes with its back.",    HSP_C_MOVES};
  static constexpr auto fields() {
    using F = Fields<Ramming>;
    return std::array{F::real("speed", &Ramming::speed, "m/s", -100, 100, 0, "Speed along x."),
                      F::real("length", &Ramming::length, "", 0, 2, 1, "Of its quaternion.")};
  }
  void activate(const hsp_activation&, hsp_report& report) { report.flags = HSP_R_MOVES; }
  hsp_status touch(const hsp_probe& in, const hsp_step& step, hsp_contact& out) noexcept HSP_RT {
    step.pose->position[0] += speed * step.dt_s;
    step.pose->linear[0] = speed;
    step.pose->orientation[0] = length;
    out.flags = HSP_OUT_TRACED | HSP_OUT_CONTACT;
    out.depth_m = 1e-3;
    std::memcpy(out.point, in.position, sizeof out.point);
    out.normal[0] = -1;
    out.force[0] = 1;
    return HSP_OK;
  }
};

/// Does in step what a shape must never do, for the proof that the guard sees it.
struct Allocating : hapticd::Shape {
  int unused;
  static constexpr hapticd::ShapeInfo kInfo{"org.hapticd.test.allocating", "allocating", "1.0.0", "MIT", "Allocates."};
  static constexpr auto fields() {
    return std::array{Fields<Allocating>::integer("unused", &Allocating::unused, "", 0, 1, 0, "Nothing.")};
  }
  void activate(const hsp_activation&, hsp_report&) {}
  hsp_status touch(const hsp_probe&, const hsp_step&, hsp_contact&) noexcept {
    char* block = new char[64];
    asm volatile("" : : "r"(block) : "memory");  // a pair of new and delete may be optimised away
    delete[] block;
    return HSP_OK;
  }
};

/// Takes a lock in each step, or asks the kernel now and then (where it is watched, asking takes long), or gives a page
/// back and touches it again, for the proof that a run over the scenes would see it.
struct Rude : hapticd::Shape {
  int how;
  unsigned ticks = 0;
  static constexpr const char* kHows[] = {"lock", "ask", "fault"};
  static constexpr hapticd::ShapeInfo kInfo{"org.hapticd.test.rude", "rude", "1.0.0", "MIT",
                                            "Locks, asks the kernel, or faults a page."};
  static constexpr auto fields() {
    return std::array{Fields<Rude>::choice("how", &Rude::how, kHows, 0, "What it does.")};
  }
  void activate(const hsp_activation&, hsp_report&) {}
  hsp_status touch(const hsp_probe&, const hsp_step&, hsp_contact&) noexcept {
    static pthread_mutex_t mutex = PTHREAD_MUTEX_INITIALIZER;
    if (how == 1 && ++ticks % 64 == 0) syscall(SYS_getppid);
    if (how == 2 && ++ticks % 64 == 0) fault();
    if (how == 0 && pthread_mutex_lock(&mutex) == 0) pthread_mutex_unlock(&mutex);
    return HSP_OK;
  }
  static void fault() noexcept {
    constexpr size_t kPage = 4096;
    alignas(kPage) static volatile char page[kPage];
    void* at = const_cast<char*>(page);
    munlock(at, kPage);
    madvise(at, kPage, MADV_DONTNEED);
    page[0] = 1;
  }
};

/// Behaves for ten ticks, and then does what ends or stops a process.
struct Deadly : hapticd::Shape {
  int how, ticks = 0;
  static constexpr const char* kHows[] = {"segv",  "fpe",  "ill",   "bus",   "hang",
                                          "pause", "jump", "sleep", "abort", "slow"};
  static constexpr hapticd::ShapeInfo kInfo{"org.hapticd.test.deadly", "deadly", "1.0.0", "MIT", "Crashes."};
  static constexpr auto fields() {
    return std::array{Fields<Deadly>::choice("how", &Deadly::how, kHows, 0, "What it does.")};
  }
  void activate(const hsp_activation&, hsp_report& report) { report.max_stiffness = 1000; }
  hsp_status touch(const hsp_probe&, const hsp_step&, hsp_contact& out) noexcept HSP_RT {
    out.force[1] = 1;
    out.flags = HSP_OUT_TRACED | HSP_OUT_CONTACT;
    out.normal[1] = 1;
    if (++ticks < 10) return HSP_OK;
    volatile int zero = 0;
    volatile int* volatile nowhere = nullptr;
    if (how == 0) *nowhere = 1;
    if (how == 1) std::raise(SIGFPE);
    if (how == 2) std::raise(SIGILL);
    if (how == 3) std::raise(SIGBUS);
    while (how == 4) zero = zero + 1;
    if (how == 5 && ticks == 10) spin(300'000'000);  // five times what the watchdog leaves a simulated arm
    if (how == 6 && ticks % 2 == 0) out.force[1] = 500;
    if (how == 7 && ticks == 10) usleep(50'000);
    if (how == 8) std::abort();
    if (how == 9) spin(2'000'000);  // two ticks
    return HSP_OK;
  }

  /// Counted as the watchdog counts: by processor time.
  static void spin(time_t nanoseconds) noexcept {
    const auto used = [] {
      timespec now{};
      clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
      return now.tv_sec * 1'000'000'000 + now.tv_nsec;
    };
    for (const time_t from = used(); used() - from < nanoseconds;) continue;
  }
};

/// Has three surfaces, which are near every point, and lets a test look on while it is searched.
struct Searched : hapticd::Shape {
  static constexpr uint32_t kSurfaces = 3;
  int unused;
  hapticd::SearchHook hook;
  hsp_ext_surfaces surfaces{sizeof(hsp_ext_surfaces), kSurfaces, &nearby,
                            [](hsp_shape*, const hsp_near*) HSP_RT -> hsp_status { return HSP_OK; },
                            [](hsp_shape*, uint32_t, uint32_t) HSP_RT -> hsp_status { return HSP_OK; }};
  static constexpr hapticd::ShapeInfo kInfo{"org.hapticd.test.searched", "searched", "1.0.0", "MIT", "Is searched."};
  static constexpr auto fields() {
    return std::array{Fields<Searched>::integer("unused", &Searched::unused, "", 0, 1, 0, "Nothing.")};
  }
  void activate(const hsp_activation&, hsp_report&) {}
  hsp_status touch(const hsp_probe&, const hsp_step&, hsp_contact&) noexcept HSP_RT { return HSP_OK; }
  const void* extension(const char* name) {
    if (std::string_view(name) == hapticd::kSearchHook) return &hook;
    return std::string_view(name) == HSP_EXT_SURFACES ? &surfaces : nullptr;
  }
  static int64_t nearby(const hsp_shape* shape, const double*, double, hsp_near* out, uint64_t cap) {
    const hapticd::SearchHook& hook = reinterpret_cast<const Searched*>(shape)->hook;
    if (hook.call != nullptr) hook.call(hook.with);
    for (uint32_t i = 0; i < kSurfaces && i < cap; ++i) out[i] = {i, 0, {0, 0}, 0.01};
    return kSurfaces;
  }
};

/// Throws what nobody should throw.
struct Throwing : hapticd::Shape {
  int unused;
  static constexpr hapticd::ShapeInfo kInfo{"org.hapticd.test.throwing", "throwing", "1.0.0", "MIT", "Throws."};
  static constexpr auto fields() {
    return std::array{Fields<Throwing>::integer("unused", &Throwing::unused, "", 0, 1, 0, "Nothing.")};
  }
  void activate(const hsp_activation&, hsp_report&) { throw 42; }
  hsp_status touch(const hsp_probe&, const hsp_step&, hsp_contact&) noexcept { return HSP_OK; }
};

}  // namespace

HAPTICD_SHAPES(Wall, Pulling, Misbehaving, Sliding, Allocating, Throwing, Deadly, Turning, Rude, Aligning, Obliging,
               Searched, Clocked, Ramming)

// SPDX-License-Identifier: MIT
/// bench_servo [TICKS]: measures the time of a tick without plugin and device. It measures the whole tick, from waking
/// up to going to sleep, with black box and status page. The model is a wall and the arm a gantry, which take only
/// nanoseconds. The rate is 10 kHz in real time. Every second tick follows a sleep, during which the kernel and other
/// guests of a hypervisor replace the contents of caches and branch predictors. The other ticks follow at once, without
/// a sleep. So the second kind shows the cost of the daemon, and the difference of both kinds what the machine adds.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "base/os.hpp"
#include "test_rig.hpp"

namespace hapticd::servo {
namespace {

constexpr double kRate = 10'000;  ///< [Hz]

/// A real clock that sleeps only before every second tick, and records the time between two waits.
class BookingClock final : public Clock {
 public:
  Nanoseconds now() noexcept HSP_RT override { return clock_.now(); }
  Nanoseconds waitUntil(Nanoseconds deadline) noexcept HSP_RT override {
    if (begun_ != 0) (slept_ ? after_sleep_us : at_once_us).add(static_cast<double>(monotonicNow() - begun_) * 1e-3);
    slept_ = !slept_;
    const Nanoseconds woke = slept_ ? clock_.waitUntil(deadline) : deadline;
    begun_ = monotonicNow();
    return woke;
  }
  record::Histogram after_sleep_us;
  record::Histogram at_once_us;

 private:
  RealClock clock_{0};
  Nanoseconds begun_ = 0;
  bool slept_ = false;
};

void print(const char* when, const record::Histogram& busy) {
  std::printf("%s, %llu ticks: p50 %.2f us, p99 %.2f us, p99.9 %.2f us, max %.1f us\n", when,
              static_cast<unsigned long long>(busy.total()), busy.quantile(0.5), busy.quantile(0.99),
              busy.quantile(0.999), busy.max());
}

void bench(uint64_t ticks) {
  Rig rig(0);  // the rig's own loop is not used
  const auto page = std::filesystem::temp_directory_path() / "bench_servo.status";
  rig.telemetry->attach(
      std::make_unique<Flight>(std::move(*record::FlightRing::create(
                                   flightStreams(rig.scene, rig.arms, kRate, Telemetry::kBlackBoxSeconds, 0), {})),
                               rig.arms, 8));
  rig.telemetry->attach(
      std::make_unique<StatusWriter>(std::move(*status::PageFile::create(page.string())), rig.scene, rig.arms, kRate));
  BookingClock clock;
  LoopSettings settings;
  settings.period_ns = static_cast<Nanoseconds>(1e9 / kRate);
  settings.ticks = ticks;
  settings.lockstep = false;
  Loop loop(rig.world->core(), rig.world->lockstep(), rig.arms, clock, settings, *rig.telemetry);
  os::Thread servo;
  const auto code = servo.start("bench-servo", [&] {
    if (os::setFifo(os::kServoPriority)) std::fprintf(stderr, "warning: no real-time rights; others take part\n");
    loop.run();
  });
  if (code) return;
  servo.join();
  std::printf("tick without plugin and device at 10 kHz\n");
  print("after a sleep", clock.after_sleep_us);
  print("at once      ", clock.at_once_us);
}

}  // namespace
}  // namespace hapticd::servo

int main(int argc, char** argv) {
  hapticd::servo::bench(argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 100'000);
  return 0;
}

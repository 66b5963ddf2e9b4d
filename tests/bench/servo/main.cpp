/// What a tick costs besides its plugin and its device: `bench_servo [TICKS]`. The whole tick from waking to sleeping,
/// with black box and status page, over a wall and a gantry that take nanoseconds; 10 kHz in real time, so that caches
/// are as cold as they are between ticks.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "test_rig.hpp"

namespace hapticd::servo {
namespace {

constexpr double kRate = 10'000;  ///< [Hz]

/// A real clock that books the time between two waits.
class BookingClock final : public Clock {
 public:
  Nanoseconds now() noexcept HSP_RT override { return clock_.now(); }
  Nanoseconds waitUntil(Nanoseconds deadline) noexcept HSP_RT override {
    if (begun_ != 0) busy_us.add(static_cast<double>(monotonicNow() - begun_) * 1e-3);
    const Nanoseconds woke = clock_.waitUntil(deadline);
    const Nanoseconds first = monotonicNow();
    begun_ = monotonicNow();
    clock_us.add(static_cast<double>(begun_ - first) * 1e-3);
    return woke;
  }
  record::Histogram busy_us;
  record::Histogram clock_us;  ///< two readings of the clock, one after the other, in the same cold state

 private:
  RealClock clock_{0};
  Nanoseconds begun_ = 0;
};

void bench(uint64_t ticks) {
  Rig rig(0);  // its own loop is not run
  const auto page = std::filesystem::temp_directory_path() / "bench_servo.status";
  rig.telemetry->attach(
      std::make_unique<Flight>(std::move(*record::FlightRing::create(
                                   flightStreams(rig.scene, rig.arms, kRate, Telemetry::kBlackBoxSeconds, 0), {})),
                               rig.arms));
  rig.telemetry->attach(
      std::make_unique<StatusWriter>(std::move(*status::PageFile::create(page.string())), rig.scene, rig.arms, kRate));
  BookingClock clock;
  LoopSettings settings;
  settings.period_ns = static_cast<Nanoseconds>(1e9 / kRate);
  settings.ticks = ticks;
  settings.lockstep = false;
  Loop loop(*rig.world, rig.arms, clock, settings, *rig.telemetry);
  os::Thread servo;
  const auto code = servo.start("bench-servo", [&] {
    if (os::setFifo(os::kServoPriority)) std::fprintf(stderr, "warning: no real-time rights; others take part\n");
    loop.run();
  });
  if (code) return;
  servo.join();
  const record::Histogram& busy = clock.busy_us;
  std::printf(
      "tick without plugin and device, %llu ticks at 10 kHz: p50 %.2f us, p99 %.2f us, p99.9 %.2f us, max %.1f us\n",
      static_cast<unsigned long long>(busy.total()), busy.quantile(0.5), busy.quantile(0.99), busy.quantile(0.999),
      busy.max());
  std::printf("of that a reading of the clock: p50 %.2f us, p99 %.2f us\n", clock.clock_us.quantile(0.5),
              clock.clock_us.quantile(0.99));
}

}  // namespace
}  // namespace hapticd::servo

int main(int argc, char** argv) {
  hapticd::servo::bench(argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 100'000);
  return 0;
}

// SPDX-License-Identifier: MIT
/// The device module `vendor_dhd`: an arm behind its vendor's DHD library. Names, arguments and frames of the library's
/// functions are those of the vendor's public documentation. Its units are metres and newtons; x points to the user, y
/// to the right, z up.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <stdexcept>
#include <thread>

#include "base/os.hpp"
#include "vendor_arm/cartesian.hpp"
#include "vendor_arm/loaded_library.hpp"

namespace hapticd::vendor_dhd {
namespace {

struct Functions {
  int (*open_id)(char index) = nullptr;
  int (*close)(char id) = nullptr;
  int (*enable_force)(unsigned char on, char id) = nullptr;
  int (*get_position)(double* x, double* y, double* z, char id) = nullptr;
  int (*set_force)(double x, double y, double z, char id) = nullptr;
  unsigned (*get_buttons)(char id) = nullptr;
  const char* (*system_name)(char id) = nullptr;
  const char* (*last_error)() = nullptr;
};

class DhdArm : public vendor_arm::CartesianArm<DhdArm> {
 public:
  static constexpr DeviceInfo kInfo{"org.hapticd.device.vendor_dhd", "vendor_dhd", "0.1.0", "MIT",
                                    "An arm behind its vendor's DHD library, which is loaded at run time."};
  std::string library;
  int index = 0, rate = 0;
  double force = 0;

  static constexpr auto fields() {
    using F = Fields<DhdArm>;
    return std::array{
        F::text("library", &DhdArm::library, "libdhd.so.3",
                "The vendor's library: a name that the loader finds, or a file."),
        F::integer("index", &DhdArm::index, "", 0, 15, 0,
                   "Number of the arm, counted from 0, among those that the library finds."),
        F::real("force", &DhdArm::force, "N", 0.1, 100, 5, "Largest force."),
        F::real("reach", &DhdArm::reach, "m", 0.01, 2, 0.3,
                "Largest distance of the tip from the origin, on each axis."),
        F::integer("rate", &DhdArm::rate, "Hz", 100, 8000, 2000,
                   "Largest number of exchanges with the library per second."),
    };
  }

  void open(hdv_info& info) {
    load();
    id_ = dhd_.open_id(static_cast<char>(index));
    if (id_ < 0)
      throw std::runtime_error("the vendor's library cannot open arm " + std::to_string(index) + ": " + why() +
                               "\n  fix: try the vendor's own test program first");
    describe(info, force);
    info.capabilities = HDV_C_UNVERIFIED;  // the vendor's own program finds the zero before the daemon runs
    info.continuous_force = force;
    info.rate_hz = rate;
    info.buttons = kButtons;
    const char* name = dhd_.system_name(id());
    std::snprintf(info.product, sizeof info.product, "%s", name != nullptr ? name : "");
  }

  void start(const hdv_start&) {
    exchange_.reset(force);
    end_ = false;
    if (dhd_.enable_force(1, id()) < 0)
      throw std::runtime_error("the vendor's library cannot switch the forces on: " + why());
    if (const auto failed = thread_.start("hapticd-dhd", [this] { run(); }))
      throw std::runtime_error("cannot start a thread for the vendor's library: " + failed.message());
    if (exchange_.awaitFirst()) return;
    stop();
    throw std::runtime_error("the vendor's library has given no position for 2 s: " + why());
  }

  void stop() {
    end_ = true;
    thread_.join();
    if (id_ < 0) return;
    dhd_.set_force(0, 0, 0, id());
    dhd_.enable_force(0, id());
  }
  void close() {
    if (id_ >= 0) dhd_.close(id());
    id_ = -1;
  }

 private:
  static constexpr uint32_t kButtons = 8;

  char id() const { return static_cast<char>(id_); }
  std::string why() const {
    const char* text = dhd_.last_error();
    return text != nullptr ? text : "the library does not say why";
  }

  void load() {
    loaded_.load(library);
    constexpr const char* kExpected = "the DHD library 3";
    loaded_.find(dhd_.open_id, "dhdOpenID", kExpected);
    loaded_.find(dhd_.close, "dhdClose", kExpected);
    loaded_.find(dhd_.enable_force, "dhdEnableForce", kExpected);
    loaded_.find(dhd_.get_position, "dhdGetPosition", kExpected);
    loaded_.find(dhd_.set_force, "dhdSetForce", kExpected);
    loaded_.find(dhd_.get_buttons, "dhdGetButtonMask", kExpected);
    loaded_.find(dhd_.system_name, "dhdGetSystemName", kExpected);
    loaded_.find(dhd_.last_error, "dhdErrorGetLastStr", kExpected);
  }

  /// Runs in the thread that calls the library, because a call may block. If the arm is lost, it stays lost until the
  /// next start().
  void run() {
    (void)os::setFifo(os::kServoPriority + 1);  // this thread waits for the hardware, so that the servo need not
    const auto period = std::chrono::nanoseconds(kNanosecondsPerSecond) / rate;
    auto due = std::chrono::steady_clock::now();
    vendor_arm::ArmReading seen;
    seen.calibrated = true;
    while (!end_) {
      exchangeOnce(seen);
      exchange_.show(seen);
      due = std::max(due + period, std::chrono::steady_clock::now());
      std::this_thread::sleep_until(due);
    }
  }

  void exchangeOnce(vendor_arm::ArmReading& seen) {
    double x = 0, y = 0, z = 0, wanted[3];
    if (seen.lost || dhd_.get_position(&x, &y, &z, id()) < 0) {
      seen.lost = true;
      dhd_.set_force(0, 0, 0, id());  // again and again: the motors keep the last force that reached them
      return;
    }
    seen.position[0] = y, seen.position[1] = z, seen.position[2] = x;
    seen.buttons = dhd_.get_buttons(id());
    seen.time_ns = monotonicNow();
    ++seen.sequence;
    exchange_.force(wanted);
    if (dhd_.set_force(wanted[2], wanted[0], wanted[1], id()) < 0) seen.lost = true;
  }

  vendor_arm::LoadedLibrary loaded_;
  Functions dhd_;
  os::Thread thread_;
  std::atomic<bool> end_{false};
  int id_ = -1;
};

}  // namespace
}  // namespace hapticd::vendor_dhd

HAPTICD_DEVICES(hapticd::vendor_dhd::DhdArm)

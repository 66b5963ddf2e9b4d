// SPDX-License-Identifier: MIT
/// The callback that runs in the vendor's servo loop.
#pragma once
#include <atomic>
#include <cstdint>

#include "vendor_arm/exchange.hpp"
#include "vendor_hd/vendor_library.hpp"

namespace hapticd::vendor_hd {

class Servo {
 public:
  Servo(const VendorLibrary& vendor, vendor_arm::Exchange& exchange) : vendor_(vendor), exchange_(exchange) {}

  /// [main] Switches the forces on and schedules the callback. Returns false if the vendor's library refuses.
  bool start(HHD device);
  void stop();  ///< [main] switches the force off and ends the callback

 private:
  static HDCallbackCode HDCALLBACK callback(void* self);
  void tick();
  void look(vendor_arm::ArmReading& seen);
  void notice(vendor_arm::ArmReading& seen);

  const VendorLibrary& vendor_;
  vendor_arm::Exchange& exchange_;
  HHD device_ = HD_INVALID_HANDLE;
  HDSchedulerHandle handle_ = 0;
  bool scheduled_ = false;
  std::atomic<bool> end_{false};
  vendor_arm::ArmReading last_;  ///< used only by the callback
  uint64_t ticks_ = 0;
};

}  // namespace hapticd::vendor_hd

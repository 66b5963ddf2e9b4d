// SPDX-License-Identifier: MIT
/// Faults of an emulated arm on order: SIGHUP has the name of one read from a file. It strikes while the motors push,
/// and what follows is told: how long they pushed on, and when they push again after "none".
#pragma once
#include <string>

#include "emulators/usb_arm.hpp"

namespace hapticd::emulator {

class FaultOrders {
 public:
  /// @param file with the name of a fault; empty: there are no orders
  explicit FaultOrders(std::string file);
  /// Each time after the arm was advanced by `seconds`. @param asked a signal came
  void follow(UsbArm& arm, double seconds, bool asked);

 private:
  void read();

  enum class Stage { kWell, kOrdered, kStruck, kOff, kMended };
  std::string file_, name_;
  Fault fault_ = Fault::kNone;
  Stage stage_ = Stage::kWell;
  double since_ = 0;  ///< [s] of the stage
};

}  // namespace hapticd::emulator

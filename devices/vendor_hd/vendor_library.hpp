// SPDX-License-Identifier: MIT
/// The functions of a libHD.so that is loaded at run time.
#pragma once
#include <string>

#include "HD/hd.h"
#include "vendor_arm/loaded_library.hpp"

namespace hapticd::vendor_hd {

/// [main] Each arm has a VendorLibrary of its own. The dynamic linker loads the library only once per process.
class VendorLibrary {
 public:
  /// Throws std::runtime_error whose text says what is missing and how to get it.
  void load(const std::string& file);
  /// Removes all pending errors of the library and returns them as text; "" if there are none.
  std::string errors() const;

  decltype(&::hdInitDevice) init = nullptr;
  decltype(&::hdDisableDevice) disable_device = nullptr;
  decltype(&::hdMakeCurrentDevice) make_current = nullptr;
  decltype(&::hdBeginFrame) begin_frame = nullptr;
  decltype(&::hdEndFrame) end_frame = nullptr;
  decltype(&::hdGetError) get_error = nullptr;
  decltype(&::hdGetErrorString) error_text = nullptr;
  decltype(&::hdEnable) enable = nullptr;
  decltype(&::hdDisable) disable = nullptr;
  decltype(&::hdGetDoublev) get_doubles = nullptr;
  decltype(&::hdGetIntegerv) get_integers = nullptr;
  decltype(&::hdGetString) get_string = nullptr;
  decltype(&::hdSetDoublev) set_doubles = nullptr;
  decltype(&::hdCheckCalibration) check_calibration = nullptr;
  decltype(&::hdUpdateCalibration) update_calibration = nullptr;
  decltype(&::hdStartScheduler) start_scheduler = nullptr;
  decltype(&::hdStopScheduler) stop_scheduler = nullptr;
  decltype(&::hdScheduleAsynchronous) schedule = nullptr;
  decltype(&::hdUnschedule) unschedule = nullptr;

 private:
  vendor_arm::LoadedLibrary library_;
};

}  // namespace hapticd::vendor_hd

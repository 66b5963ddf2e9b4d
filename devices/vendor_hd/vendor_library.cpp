// SPDX-License-Identifier: MIT
#include "vendor_hd/vendor_library.hpp"

namespace hapticd::vendor_hd {

void VendorLibrary::load(const std::string& file) {
  library_.load(file);
  const auto find = [this](auto& function, const char* name) {
    library_.find(function, name, "the HDAPI 3.0 or newer");
  };
  find(init, "hdInitDevice");
  find(disable_device, "hdDisableDevice");
  find(make_current, "hdMakeCurrentDevice");
  find(begin_frame, "hdBeginFrame");
  find(end_frame, "hdEndFrame");
  find(get_error, "hdGetError");
  find(error_text, "hdGetErrorString");
  find(enable, "hdEnable");
  find(disable, "hdDisable");
  find(get_doubles, "hdGetDoublev");
  find(get_integers, "hdGetIntegerv");
  find(get_string, "hdGetString");
  find(set_doubles, "hdSetDoublev");
  find(check_calibration, "hdCheckCalibration");
  find(update_calibration, "hdUpdateCalibration");
  find(start_scheduler, "hdStartScheduler");
  find(stop_scheduler, "hdStopScheduler");
  find(schedule, "hdScheduleAsynchronous");
  find(unschedule, "hdUnschedule");
}

std::string VendorLibrary::errors() const {
  std::string text;
  constexpr int kMost = 64;  // bound, in case a library always returns one more error
  for (int i = 0; i < kMost; ++i) {
    const HDErrorInfo error = get_error();
    if (error.errorCode == HD_SUCCESS) break;
    const char* words = error_text(error.errorCode);
    text += (text.empty() ? "" : ", ") + std::string(words != nullptr ? words : "unknown error");
  }
  return text;
}

}  // namespace hapticd::vendor_hd

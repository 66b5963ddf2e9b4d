// SPDX-License-Identifier: MIT
/// The device module `vendor_hd`: an arm that only its vendor's driver can control, through the HDAPI. Its joints are
/// the coordinates of its tip. The vendor's driver compensates gravity.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <thread>

#include "vendor_arm/cartesian.hpp"
#include "vendor_hd/servo.hpp"
#include "vendor_hd/vendor_library.hpp"

namespace hapticd::vendor_hd {
namespace {

class VendorArm : public vendor_arm::CartesianArm<VendorArm> {
 public:
  static constexpr DeviceInfo kInfo{
      "org.hapticd.device.vendor_hd", "vendor_hd", "0.1.0", "MIT",
      "An arm behind its vendor's HDAPI library (libHD.so), which is loaded at run time."};
  std::string library, device;
  double force = 0;

  static constexpr auto fields() {
    using F = Fields<VendorArm>;
    return std::array{
        F::text("library", &VendorArm::library, "libHD.so",
                "The vendor's library: a name that the loader finds, or a file."),
        F::text("device", &VendorArm::device, "",
                "Name that the vendor's setup gave the arm. Without it, the default arm is used."),
        F::real("force", &VendorArm::force, "N", 0, 100, 0,
                "Largest force; 0 means the one that the vendor's library gives."),
        F::real("reach", &VendorArm::reach, "m", 0.01, 2, 0.4,
                "Largest distance of the tip from the origin, on each axis."),
    };
  }

  void open(hdv_info& info) {
    vendor_.load(library);
    (void)vendor_.errors();  // drops earlier errors of other arms in this process
    handle_ = vendor_.init(device.empty() ? HD_DEFAULT_DEVICE : device.c_str());
    const std::string wrong = vendor_.errors();
    if (handle_ == HD_INVALID_HANDLE || !wrong.empty())
      throw std::runtime_error("the vendor's library cannot open " +
                               (device.empty() ? "its default arm" : "'" + device + "'") + ": " + wrong +
                               "\n  fix: try the vendor's own diagnostic program first");
    describe(info);
  }

  void start(const hdv_start&) {
    exchange_.reset(max_force_);
    if (!servo_.start(handle_) || !vendor_.errors().empty()) {
      servo_.stop();
      throw std::runtime_error(
          "the vendor's library cannot start its servo loop; try the vendor's own diagnostic program");
    }
    if (exchange_.awaitFirst()) return;
    servo_.stop();
    throw std::runtime_error("the vendor's servo loop has given no position for 2 s");
  }

  void stop() { servo_.stop(); }
  void close() {
    if (handle_ != HD_INVALID_HANDLE) vendor_.disable_device(handle_);
    handle_ = HD_INVALID_HANDLE;
  }

  const void* extension(const char* name) {
    if (std::strcmp(name, HDV_EXT_CALIBRATION) == 0) return &kCalibration;
    return CartesianArm::extension(name);
  }

 private:
  double number(HDenum name) const {
    double value = 0;
    vendor_.get_doubles(name, &value);
    return std::isfinite(value) && value > 0 ? value : 0;
  }

  void describe(hdv_info& info) {
    constexpr double kMmPerMetre = 1000;
    const double most = number(HD_NOMINAL_MAX_FORCE);
    max_force_ = force > 0 && most > 0 ? std::min(force, most) : std::max(force, most);
    if (max_force_ == 0)
      throw std::runtime_error(
          "the vendor's library does not give the arm's largest force\n"
          "  fix: give it in N as parameters: {force: ...}");
    CartesianArm::describe(info, max_force_);
    info.rate_hz = std::max(number(HD_UPDATE_RATE), 1.0);
    info.continuous_force = std::min(number(HD_NOMINAL_MAX_CONTINUOUS_FORCE), max_force_);
    info.max_stiffness = number(HD_NOMINAL_MAX_STIFFNESS) * kMmPerMetre;
    info.buttons = 4;
    const auto text = [this](HDenum name) {
      const char* words = vendor_.get_string(name);
      return words != nullptr ? words : "";
    };
    std::snprintf(info.serial, sizeof info.serial, "%s", text(HD_DEVICE_SERIAL_NUMBER));
    std::snprintf(info.product, sizeof info.product, "%s", text(HD_DEVICE_MODEL_TYPE));
    (void)vendor_.errors();  // drops errors about values that this arm does not have
  }

  static hsp_status calibrate(hdv_device* arm) {
    constexpr std::chrono::milliseconds kPause(300);
    const VendorLibrary& vendor = self(arm).vendor_;
    HDint styles = 0;
    vendor.get_integers(HD_CALIBRATION_STYLE, &styles);
    for (const HDint style : {HD_CALIBRATION_AUTO, HD_CALIBRATION_INKWELL, HD_CALIBRATION_ENCODER_RESET})
      if ((styles & style) != 0) {
        vendor.update_calibration(static_cast<HDenum>(style));
        break;
      }
    std::this_thread::sleep_for(kPause);
    return vendor.check_calibration() == HD_CALIBRATION_OK ? HSP_OK : HSP_E_IO;
  }
  static constexpr hdv_ext_calibration kCalibration = {
      sizeof(hdv_ext_calibration), 0, "Put the stylus into its well, or as the vendor's manual says.", &calibrate};
  VendorLibrary vendor_;
  Servo servo_{vendor_, exchange_};
  HHD handle_ = HD_INVALID_HANDLE;
  double max_force_ = 0;
};

}  // namespace
}  // namespace hapticd::vendor_hd

HAPTICD_DEVICES(hapticd::vendor_hd::VendorArm)

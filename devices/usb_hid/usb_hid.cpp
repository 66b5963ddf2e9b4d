// SPDX-License-Identifier: MIT
/// The device module `usb_hid`: any arm on USB with HID reports, which a device file describes.
#include "usb_hid/hid_transport.hpp"
#include "wire_arm/arm.hpp"

namespace hapticd::wire_arm {
namespace {

class HidArm final : public Arm<HidArm> {
 public:
  static constexpr DeviceInfo kInfo = {"org.hapticd.device.usb_hid", "usb_hid", "0.1.0", "MIT",
                                       "An arm on USB with HID reports, which its device file describes."};
  static constexpr auto fields() {
    return join(ParameterTable<HidArm>::usb(), ParameterTable<HidArm>::device(), ParameterTable<HidArm>::arm());
  }
  std::unique_ptr<Transport> makeTransport() const { return makeHidTransport(); }
};

}  // namespace
}  // namespace hapticd::wire_arm

HAPTICD_DEVICES(hapticd::wire_arm::HidArm)

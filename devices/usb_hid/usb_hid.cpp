/// The device module `usb_hid`: any arm that speaks HID reports, described by its device file.
#include "usb_arm/arm.hpp"
#include "usb_hid/hid_transport.hpp"

namespace hapticd::usb {
namespace {

class HidArm final : public Arm<HidArm> {
 public:
  static constexpr DeviceInfo kInfo = {"org.hapticd.device.usb_hid", "usb_hid", "0.1.0", "MIT",
                                       "An arm on USB that speaks HID reports; its device file says which."};
  static constexpr auto fields() {
    return join(ParameterTable<HidArm>::usb(), ParameterTable<HidArm>::device(), ParameterTable<HidArm>::arm());
  }
  std::unique_ptr<Transport> makeTransport() const { return makeHidTransport(); }
};

}  // namespace
}  // namespace hapticd::usb

HAPTICD_DEVICES(hapticd::usb::HidArm)

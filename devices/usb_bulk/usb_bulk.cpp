// SPDX-License-Identifier: MIT
/// The device module `usb_bulk`: any arm with bulk or interrupt endpoints whose reports a device file describes.
#include "usb_bulk/bulk_transport.hpp"
#include "wire_arm/arm.hpp"

namespace hapticd::wire_arm {
namespace {

class BulkArm final : public Arm<BulkArm> {
 public:
  static constexpr DeviceInfo kInfo = {
      "org.hapticd.device.usb_bulk", "usb_bulk", "0.1.0", "MIT",
      "An arm on USB with bulk or interrupt endpoints, which its device file describes."};
  static constexpr auto fields() {
    return join(ParameterTable<BulkArm>::usb(), ParameterTable<BulkArm>::device(), ParameterTable<BulkArm>::arm());
  }
  std::unique_ptr<Transport> makeTransport() const { return makeBulkTransport(); }
};

}  // namespace
}  // namespace hapticd::wire_arm

HAPTICD_DEVICES(hapticd::wire_arm::BulkArm)

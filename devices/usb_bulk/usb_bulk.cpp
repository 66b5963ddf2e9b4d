/// The device module `usb_bulk`: any arm with bulk or interrupt endpoints, described by its device file.
#include "usb_arm/arm.hpp"
#include "usb_bulk/bulk_transport.hpp"

namespace hapticd::usb {
namespace {

class BulkArm final : public Arm<BulkArm> {
 public:
  static constexpr DeviceInfo kInfo = {"org.hapticd.device.usb_bulk", "usb_bulk", "0.1.0", "MIT",
                                       "An arm on USB with bulk or interrupt endpoints; its device file says which."};
  static constexpr auto fields() {
    return join(ParameterTable<BulkArm>::usb(), ParameterTable<BulkArm>::device(), ParameterTable<BulkArm>::arm());
  }
  std::unique_ptr<Transport> makeTransport() const { return makeBulkTransport(); }
};

}  // namespace
}  // namespace hapticd::usb

HAPTICD_DEVICES(hapticd::usb::BulkArm)

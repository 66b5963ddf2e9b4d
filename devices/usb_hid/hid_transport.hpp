/// HID arms through hidapi and the kernel's hidraw.
#pragma once
#include <memory>

#include "usb_arm/transport.hpp"

namespace hapticd::usb {

/// [main] A transport over hidraw; nothing is opened yet.
std::unique_ptr<Transport> makeHidTransport();

}  // namespace hapticd::usb

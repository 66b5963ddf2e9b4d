// SPDX-License-Identifier: MIT
/// Arms with bulk or interrupt endpoints of their own, through libusb.
#pragma once
#include <memory>

#include "wire_arm/transport.hpp"

namespace hapticd::wire_arm {

/// [main] A transport over libusb; nothing is opened yet.
std::unique_ptr<Transport> makeBulkTransport();

}  // namespace hapticd::wire_arm

// SPDX-License-Identifier: MIT
/// The transport for arms with bulk or interrupt endpoints, through libusb.
#pragma once
#include <memory>

#include "wire_arm/transport.hpp"

namespace hapticd::wire_arm {

/// [main] Makes a transport over libusb, without opening a device.
std::unique_ptr<Transport> makeBulkTransport();

}  // namespace hapticd::wire_arm

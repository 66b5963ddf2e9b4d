// SPDX-License-Identifier: MIT
/// The transport for HID arms, through hidapi and the kernel's hidraw.
#pragma once
#include <memory>

#include "wire_arm/transport.hpp"

namespace hapticd::wire_arm {

/// [main] Makes a transport over hidraw, without opening a device.
std::unique_ptr<Transport> makeHidTransport();

}  // namespace hapticd::wire_arm

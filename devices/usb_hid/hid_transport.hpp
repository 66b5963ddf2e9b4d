// SPDX-License-Identifier: MIT
/// HID arms through hidapi and the kernel's hidraw.
#pragma once
#include <memory>

#include "wire_arm/transport.hpp"

namespace hapticd::wire_arm {

/// [main] A transport over hidraw; nothing is opened yet.
std::unique_ptr<Transport> makeHidTransport();

}  // namespace hapticd::wire_arm

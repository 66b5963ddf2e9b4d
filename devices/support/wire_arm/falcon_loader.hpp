// SPDX-License-Identifier: MIT
/// Brings up a Novint Falcon, which forgets its firmware when it loses power: the user's firmware file is sent in
/// chunks that the arm echoes. Protocol as published by the libnifalcon project; not tried on hardware.
#pragma once
#include <vector>

#include "wire_arm/transport.hpp"

namespace hapticd::wire_arm {

inline constexpr int kFalconTries = 20;     ///< of the whole upload
inline constexpr size_t kFalconChunk = 62;  ///< bytes of firmware per USB packet

/// [main] Reads a firmware image. The image belongs to the maker and does not come with hapticd.
Result<std::vector<uint8_t>> readFalconFirmware(const std::string& file);

/// [main] and I/O thread. Leaves a running Falcon alone; else uploads, with retries. May block for some seconds.
Result<void> loadFalcon(Transport& transport, const codec::Wire& wire, const std::vector<uint8_t>& firmware);

}  // namespace hapticd::wire_arm

// SPDX-License-Identifier: MIT
/// Loads firmware into a Novint Falcon, which forgets its firmware when it loses power. The user's firmware file is
/// sent in chunks, which the arm echoes. The protocol is that of the libnifalcon project; not tried on hardware.
#pragma once
#include <vector>

#include "wire_arm/transport.hpp"

namespace hapticd::wire_arm {

inline constexpr int kFalconTries = 20;     ///< most tries of the whole upload
inline constexpr size_t kFalconChunk = 62;  ///< number of firmware bytes in a USB packet

/// [main] Reads a firmware image. The image belongs to the maker of the arm, so hapticd does not include it.
Result<std::vector<uint8_t>> readFalconFirmware(const std::string& file);

/// [main] and I/O thread. Uploads the firmware, with retries, unless the Falcon already runs it. May block for some
/// seconds.
Result<void> loadFalcon(Transport& transport, const codec::Wire& wire, const std::vector<uint8_t>& firmware);

}  // namespace hapticd::wire_arm

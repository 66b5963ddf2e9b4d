// SPDX-License-Identifier: MIT
/// Finds numbers of a device file that are allowed but were hardly meant: grams, newtons per millimetre, a sustained
/// force above the largest force.
#pragma once
#include "description/scene.hpp"
#include "document/node.hpp"
#include "host/device_instance.hpp"

namespace hapticd::diagnostics {

/// [main] Warns of such numbers, each at its key.
/// @param arm the arm; if it is simulated, it is opened, which touches no hardware. nullptr if the file has mistakes:
/// then only single values are judged
void warnOfImplausibleArm(const document::Node& root, const scene::Device& device, host::DeviceInstance* arm,
                          document::Problems& warnings);

/// [main] Warns of a field of the wire format that differs from the same field of the other joints in byte order, in
/// sign, or by powers of ten in scale. Also warns of positions whose single count moves the tip so far that a hand
/// feels the step.
/// @param arm is nullptr if the file has mistakes, so that only single fields are judged
void warnOfImplausibleFields(const document::Node& root, const scene::Device& device, size_t joints,
                             const host::DeviceInstance* arm, document::Problems& warnings);

/// [main] Warns of limits so small that no force is felt, or so large that no arm reaches them; of a wire format
/// without the fields that `admittance` needs, with an id in only one of the two reports, or with a clock that is
/// slower than the reports; and of simulated arms whose friction, mass or delay is greater than a hand would accept.
/// @param arm is nullptr if the file has mistakes, so that only single values are judged
void warnOfImplausibleLimits(const document::Node& root, const scene::Device& device, const host::DeviceInstance* arm,
                             document::Problems& warnings);

}  // namespace hapticd::diagnostics

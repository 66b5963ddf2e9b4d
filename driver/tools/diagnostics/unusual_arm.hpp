// SPDX-License-Identifier: MIT
/// Numbers of a device file that its format allows and nobody means: grams, newtons per millimetre, a sustained force
/// above the largest one.
#pragma once
#include "description/scene.hpp"
#include "document/node.hpp"
#include "host/device_instance.hpp"

namespace hapticd::diagnostics {

/// [main] Warns of them, each at its key.
/// @param arm is opened if it is simulated, which touches no hardware
void unusualArm(const document::Node& root, const scene::Device& device, host::DeviceInstance& arm,
                document::Problems& warnings);

/// [main] Warns of fields of the wire format that are not as those of the other joints are: another byte order, another
/// sign, a decimal point elsewhere; and of counts that move the tip by more than a hand can be shown.
void unusualFields(const document::Node& root, const scene::Device& device, const host::DeviceInstance& arm,
                   document::Problems& warnings);

/// [main] Warns of limits that leave nothing to feel or bound nothing, of what the wire format has no fields for, and
/// of joints of simulated arms that rub, weigh or lag more than shapes push.
void unusualLimits(const document::Node& root, const scene::Device& device, const host::DeviceInstance& arm,
                   document::Problems& warnings);

}  // namespace hapticd::diagnostics

// SPDX-License-Identifier: MIT
/// What good reports say that no arm means: flags that never change, a device that starts with each report, another
/// rate than that of the file.
#pragma once
#include <string>

#include "capture/report_table.hpp"

namespace hapticd::capture {

/// [main] One line per hint, "" if there is none. @param least_rate health.least_rate: below this share of wire.rate no
/// torque is sent
std::string courseHints(const codec::Wire& wire, const Decoded& decoded, double least_rate);

}  // namespace hapticd::capture

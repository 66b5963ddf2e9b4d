// SPDX-License-Identifier: MIT
/// Finds what cannot be right in reports without errors: flags that never change, a device that seems to restart with
/// each report, a rate that differs from the one in the device file.
#pragma once
#include <string>

#include "capture/report_table.hpp"

namespace hapticd::capture {

/// [main] Returns one line per hint, or "" if there is none. @param least_rate health.least_rate: no torque is sent if
/// the reports arrive at less than this share of wire.rate
std::string timeSeriesHints(const codec::Wire& wire, const Decoded& decoded, double least_rate);

}  // namespace hapticd::capture

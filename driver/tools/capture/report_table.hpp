// SPDX-License-Identifier: MIT
/// A capture as numbers: what a wire format makes of it, report by report, and why some of it is not a report.
#pragma once
#include <array>
#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "base/result.hpp"
#include "capture/capture.hpp"
#include "codec/wire.hpp"

namespace hapticd::capture {

struct DecodedReport {
  double time = -1;   ///< [s] in the capture, -1: unknown
  size_t offset = 0;  ///< byte of the capture at which it was complete, or for text the number of the transfer, from 1
  codec::Verdict verdict = codec::Verdict::kGood;
  codec::State state;
  std::string wrong;  ///< "" or what made the verdict: "checksum at byte 12 is 0x12, of the bytes 0 to 11 it is 0x34"
};

/// A bad report, kept to find out what is wrong with all of them.
struct BadReport {
  const codec::Field* wrong = nullptr;  ///< the wrong field of the wire format; nullptr: the report's size is wrong
  std::vector<uint8_t> bytes;           ///< without the id if a field is wrong
};

struct Decoded {
  std::vector<DecodedReport> reports;
  size_t lost = 0;             ///< bytes that belong to no report
  size_t head = 0;             ///< bytes before the first report of a framed stream: the rest of one that was cut
  size_t others = 0;           ///< reports of another kind, with another id
  size_t repeats = 0;          ///< reports with the same sequence number as the one before
  size_t gaps = 0;             ///< places where sequence numbers are missing
  std::vector<BadReport> bad;  ///< the first bad ones with a wrong size or field
  std::set<int> other_ids;     ///< of the others
  size_t good() const;
};

/// [main] Reads every report of a capture. Turns of positions that wrap are counted, from the first report on.
Decoded decodeCapture(const codec::Wire& wire, const Capture& capture);

/// [main] The reports as CSV with a header: report, time, verdict, then what the format has, in SI units.
std::string csvOf(const codec::Wire& wire, size_t joints, const Decoded& decoded);

/// [main] A line for people: how many reports there were, how many of them were good, what was wrong.
std::string summaryOf(const Decoded& decoded);

/// [main] One line of numbers as the bytes of a report: `columns` names them, "torque1,torque2" or
/// "position1,buttons,calibrated". @param to_arm an order; otherwise as the arm would send it
/// @param sequence of this report
Result<std::vector<uint8_t>> encodeRow(const codec::Wire& wire, bool to_arm, const std::vector<std::string>& columns,
                                       const double* values, uint32_t sequence);

/// [main] The columns that encodeRow() understands for an arm of `joints` joints, in this order.
std::vector<std::string> columnsOf(const codec::Wire& wire, size_t joints, bool to_arm);

}  // namespace hapticd::capture

// SPDX-License-Identifier: MIT
/// Decodes a capture into numbers with a wire format, report by report, and says why some bytes are not a report.
#pragma once
#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "base/result.hpp"
#include "capture/capture.hpp"
#include "codec/wire.hpp"

namespace hapticd::capture {

struct DecodedReport {
  double time = -1;   ///< [s] time in the capture; -1 if unknown
  size_t offset = 0;  ///< index of the byte in the capture at which the report was complete; for text, the number of
                      ///< the transfer, from 1
  codec::Verdict verdict = codec::Verdict::kGood;
  codec::State state;
  /// The reason for a bad verdict, or "": "checksum at byte 12 is 0x12, of the bytes 0 to 11 it is 0x34".
  std::string wrong;
};

/// A bad report. The first bad reports are kept, so that the hints can find the error in the device file.
struct BadReport {
  const codec::Field* wrong = nullptr;  ///< the wrong field of the wire format; nullptr if the report's size is wrong
  std::vector<uint8_t> bytes;           ///< the bytes of the report, without its id if a field is wrong
};

struct Decoded {
  std::vector<DecodedReport> reports;
  size_t lost = 0;             ///< bytes that belong to no report
  size_t head = 0;             ///< bytes before the first report of a framed stream: the end of a report
  size_t others = 0;           ///< reports of another kind, with another id
  size_t repeats = 0;          ///< reports with the same sequence number as the one before
  size_t gaps = 0;             ///< places where sequence numbers are missing
  std::vector<BadReport> bad;  ///< the first bad reports with a wrong size or field
  std::set<int> other_ids;     ///< ids of these other reports
  size_t good() const;
};

/// [main] Reads every report of a capture. For positions that wrap, turns are counted from the first report on.
Decoded decodeCapture(const codec::Wire& wire, const Capture& capture);

/// [main] Returns the reports as CSV. The header is report, time, verdict, then a column for each quantity of the
/// format, in SI units.
std::string csvOf(const codec::Wire& wire, size_t joints, const Decoded& decoded);

/// [main] Returns a line for people that says how many reports there were, how many of them were good, and what was
/// wrong.
std::string summaryOf(const Decoded& decoded);

/// [main] Encodes one line of numbers as the bytes of a report. `columns` names the numbers, such as "torque1,torque2"
/// or "position1,buttons,calibrated".
/// @param to_arm true for a command to the arm; false for a report from it
/// @param sequence sequence number of this report
Result<std::vector<uint8_t>> encodeRow(const codec::Wire& wire, bool to_arm, const std::vector<std::string>& columns,
                                       const double* values, uint32_t sequence);

/// [main] Returns the names of all columns that encodeRow() accepts for an arm with `joints` joints: first those of
/// the joints.
std::vector<std::string> columnsOf(const codec::Wire& wire, size_t joints, bool to_arm);

}  // namespace hapticd::capture

// SPDX-License-Identifier: MIT
/// Cuts a stream of USB packets into reports, for arms whose reports begin or end with marks.
#pragma once
#include <array>
#include <cstdint>
#include <span>

#include "codec/wire.hpp"

namespace hapticd::codec {

/// It takes bounded time and allocates no memory. After wrong bytes it finds the next report by its marks.
class Framer {
 public:
  Framer(const Framing& framing, size_t report_bytes) : framing_(framing), report_bytes_(report_bytes) {}

  void reset() noexcept { filled_ = 0, pending_ = false; }

  /// [any] Takes the bytes of one transfer, and calls `report(bytes)` for each report that is complete now.
  /// @return number of bytes that belonged to no report
  template <class Report>
  size_t take(std::span<const uint8_t> bytes, const Report& report) noexcept {
    size_t lost = 0;
    for (size_t i = 0; i < bytes.size(); ++i) {
      if (i % framing_.packet < framing_.header) continue;
      const auto whole = framing_.escape.used ? takeEscaped(bytes[i], lost) : takePlain(bytes[i], lost);
      if (!whole) continue;
      report(std::span<const uint8_t>(held_.data(), report_bytes_));
      // One mark may end a report and begin the next.
      filled_ = framing_.escape.used && framing_.start == framing_.end && framing_.start >= 0 ? 1 : 0;
    }
    return lost;
  }

 private:
  /// @return true if `held_` is a whole report
  bool takePlain(uint8_t byte, size_t& lost) noexcept {
    held_[filled_++] = byte;
    if (filled_ == 1 && framing_.start >= 0 && held_[0] != framing_.start) filled_ = 0, ++lost;
    if (filled_ < report_bytes_) return false;
    if (framing_.end < 0 || held_[filled_ - 1] == framing_.end) return true;
    lost += resynchronise();
    return false;
  }

  /// A mark byte that is not escaped counts as a mark at every position. @return true if `held_` is a whole report
  bool takeEscaped(uint8_t byte, size_t& lost) noexcept {
    const Escape& escape = framing_.escape;
    if (byte == escape.mark && !pending_) return pending_ = true, false;
    const bool literal = pending_;
    pending_ = false;
    if (literal) byte = escape.decoded(byte);
    const bool last = filled_ + 1 == report_bytes_;
    const bool ends = !literal && framing_.end >= 0 && byte == framing_.end;
    const bool starts = !literal && framing_.start >= 0 && byte == framing_.start;
    if (ends && last) return held_[filled_++] = byte, true;
    if (starts) {
      lost += filled_ > 1 ? filled_ : 0;  // a mark alone may fill a pause, so it is not lost
      held_[0] = byte, filled_ = 1;
      return false;
    }
    const bool wrong = ends || (filled_ == 0 && framing_.start >= 0) || (last && framing_.end >= 0);
    if (wrong) {
      lost += filled_ + (ends && filled_ == 0 ? 0 : 1);
      filled_ = 0;
      return false;
    }
    held_[filled_++] = byte;
    return filled_ == report_bytes_;
  }

  /// Drops the held bytes before the next start mark. @return number of bytes dropped
  size_t resynchronise() noexcept {
    size_t next = 1;
    while (next < filled_ && framing_.start >= 0 && held_[next] != framing_.start) ++next;
    for (size_t i = next; i < filled_; ++i) held_[i - next] = held_[i];
    filled_ -= next;
    return next;
  }

  Framing framing_;
  size_t report_bytes_, filled_ = 0;
  bool pending_ = false;  // the escape mark has come, but the byte after it has not
  std::array<uint8_t, kMaxReportBytes + 1> held_{};
};

/// [any] Puts escapes into a report that is to be sent; marks at its first and last byte are not escaped.
/// @param bytes the report, with room for twice its size @return number of bytes to send
inline size_t addEscapes(const Framing& framing, std::span<uint8_t> bytes, size_t size) noexcept {
  if (!framing.escape.used) return size;
  const auto isMark = [&](size_t i) { return (i == 0 && framing.start >= 0) || (i + 1 == size && framing.end >= 0); };
  size_t extra = 0;
  for (size_t i = 0; i < size; ++i) extra += !isMark(i) && framing.escapes(bytes[i]) ? 1 : 0;
  size_t to = size + extra;
  if (to > bytes.size()) return 0;
  for (size_t i = size; i-- > 0;) {  // backward, so that no byte is overwritten before it is read
    const uint8_t byte = bytes[i];
    if (isMark(i) || !framing.escapes(byte)) {
      bytes[--to] = byte;
    } else {
      bytes[--to] = framing.escape.encoded(byte);
      bytes[--to] = framing.escape.mark;
    }
  }
  return size + extra;
}

}  // namespace hapticd::codec

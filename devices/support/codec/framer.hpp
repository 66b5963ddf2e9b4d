// SPDX-License-Identifier: MIT
/// Cuts a stream of USB packets into reports, when the arm's reports have marks of their own.
#pragma once
#include <array>
#include <cstdint>
#include <span>

#include "codec/wire.hpp"

namespace hapticd::codec {

/// Bounded and allocation-free. After garbage it finds the next report by its marks.
class Framer {
 public:
  Framer(const Framing& framing, size_t report_bytes) : framing_(framing), report_bytes_(report_bytes) {}

  void reset() noexcept { filled_ = 0; }

  /// [any] Takes what one transfer brought and calls `report(bytes)` for each whole report in it.
  /// @return bytes that belonged to none
  template <class Report>
  size_t take(std::span<const uint8_t> bytes, const Report& report) noexcept {
    size_t lost = 0;
    for (size_t i = 0; i < bytes.size(); ++i) {
      if (i % framing_.packet < framing_.header) continue;
      held_[filled_++] = bytes[i];
      if (filled_ == 1 && framing_.start >= 0 && held_[0] != framing_.start) filled_ = 0, ++lost;
      if (filled_ < report_bytes_) continue;
      if (framing_.end >= 0 && held_[filled_ - 1] != framing_.end) {
        lost += resynchronise();
        continue;
      }
      report(std::span<const uint8_t>(held_.data(), filled_));
      filled_ = 0;
    }
    return lost;
  }

 private:
  /// Drops up to the next start mark that is held. @return bytes dropped
  size_t resynchronise() noexcept {
    size_t next = 1;
    while (next < filled_ && framing_.start >= 0 && held_[next] != framing_.start) ++next;
    for (size_t i = next; i < filled_; ++i) held_[i - next] = held_[i];
    filled_ -= next;
    return next;
  }

  Framing framing_;
  size_t report_bytes_, filled_ = 0;
  std::array<uint8_t, kMaxReportBytes + 1> held_{};
};

}  // namespace hapticd::codec

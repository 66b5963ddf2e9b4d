// SPDX-License-Identifier: MIT
/// Checks of single values of a part's records, with messages that name the record, the value and what was expected.
#pragma once
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string>

#include "kernels/part/check.hpp"
#include "kernels/part/spline_check.hpp"

namespace hapticd::brep {

inline std::string numberText(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.9g", value);
  return text;
}

/// Checks of one record. A check that fails throws an error that names the record.
struct RecordCheck {
  const char* kind;
  std::size_t index;
  [[noreturn]] void fail(const std::string& why) const {
    throw PartError(std::string(kind) + " " + std::to_string(index) + ": " + why);
  }
  void need(bool good, const char* why) const {
    if (!good) fail(why);
  }
  /// Checks that a kind is one of 0 to `last`.
  template <class Kind>
  void kindIn(Kind value, Kind last) const {
    const auto text = [](Kind k) { return std::to_string(static_cast<std::uint32_t>(k)); };
    if (value > last) fail("kind " + text(value) + ", expected 0 to " + text(last));
  }
  /// Checks that an index is below `count`.
  void indexIn(std::uint32_t value, std::size_t count, const char* what) const {
    if (value >= count)
      fail(std::string(what) + " " + std::to_string(value) + ", but the index must be below " + std::to_string(count));
  }
  void indexOrNone(std::uint32_t value, std::size_t count, const char* what) const {
    if (value != kNone) indexIn(value, count, what);
  }
  /// Checks a range of records inside an array.
  void rangeIn(std::uint64_t first, std::uint64_t length, std::size_t count, const char* what) const {
    if (first > count || length > count - first)
      fail(std::string(what) + ": " + std::to_string(length) + " from index " + std::to_string(first) +
           " on, but the part has only " + std::to_string(count));
  }
  template <std::size_t n>
  void finite(const std::array<double, n>& values, double most, const char* what) const {
    for (double value : values)
      if (!(std::abs(value) <= most))
        fail(std::string(what) + " is " + numberText(value) + ", expected a finite number of magnitude at most " +
             numberText(most));
  }
  void positive(double value, const char* what) const {
    if (!(value > 0 && value <= kFarthestPart))
      fail(std::string(what) + " is " + numberText(value) + ", expected above 0 and at most " +
           numberText(kFarthestPart));
  }
  void tolerance(double value) const {
    if (!(value >= 0 && value <= kFarthestPart))
      fail("tolerance is " + numberText(value) + " m, expected 0 to " + numberText(kFarthestPart));
  }
  void flagsIn(std::uint32_t flags, std::uint32_t known) const {
    if ((flags & ~known) != 0)
      fail("flags " + std::to_string(flags) + " have unknown bits, expected only bits of " + std::to_string(known));
  }
  void ascending(double lo, double hi, const char* what) const {
    if (!(lo < hi && std::abs(lo) <= kWidestParameter && std::abs(hi) <= kWidestParameter))
      fail(std::string(what) + " from " + numberText(lo) + " to " + numberText(hi) +
           ", expected finite numbers, the second greater than the first");
  }
};

}  // namespace hapticd::brep

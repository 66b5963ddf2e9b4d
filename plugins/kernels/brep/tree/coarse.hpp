// SPDX-License-Identifier: MIT
/// Numbers of 16 bits: the upper half of a single-precision number. They have its range and two to three digits, which
/// is enough for bounds. A part has so many bounds that their size matters.
#pragma once
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace hapticd::brep {

class Coarse {
 public:
  Coarse() = default;
  /// [main] Returns the least such number that is not below x.
  static Coarse up(double x) noexcept {
    auto single = static_cast<float>(x);
    if (static_cast<double>(single) < x) single = std::nextafter(single, std::numeric_limits<float>::infinity());
    const auto word = std::bit_cast<std::uint32_t>(single);
    if (std::isnan(single)) return Coarse(kNotANumber);
    // of the sign and the magnitude; a negative number rises if its magnitude is cut off
    return Coarse(static_cast<std::uint16_t>((word >> 31 != 0 ? word : word + 0xffffu) >> 16));
  }
  /// [main] Returns the greatest such number that is not above x.
  static Coarse down(double x) noexcept { return -up(-x); }
  /// [main] Returns a number that differs from x by less than 1 %.
  static Coarse near(double x) noexcept {
    const auto word = std::bit_cast<std::uint32_t>(static_cast<float>(x));
    return std::isfinite(static_cast<float>(x)) ? Coarse(static_cast<std::uint16_t>((word + 0x7fffu) >> 16)) : up(x);
  }
  static Coarse ofBits(std::uint16_t bits) noexcept { return Coarse(bits); }
  std::uint16_t bits() const noexcept { return bits_; }
  Coarse operator-() const noexcept { return Coarse(static_cast<std::uint16_t>(bits_ ^ 0x8000u)); }
  float value() const noexcept { return std::bit_cast<float>(std::uint32_t{bits_} << 16); }

 private:
  explicit Coarse(std::uint16_t bits) noexcept : bits_(bits) {}
  static constexpr std::uint16_t kNotANumber = 0x7fc0;

  std::uint16_t bits_ = 0;
};

/// Four floats, on which one instruction works at once.
using Float4 = float __attribute__((vector_size(16)));

/// Four coarse numbers, which are read at once.
struct Coarse4 {
  Coarse of[4];

  Float4 values() const noexcept {
    using Half4 = std::uint16_t __attribute__((vector_size(8)));
    using Word4 = std::uint32_t __attribute__((vector_size(16)));
    const Word4 words = __builtin_convertvector(std::bit_cast<Half4>(of), Word4) << 16;
    return std::bit_cast<Float4>(words);
  }
};

}  // namespace hapticd::brep

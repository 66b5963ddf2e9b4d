// SPDX-License-Identifier: MIT
/// The columns of a recorded row: named numbers, and short texts, at fixed offsets. So the servo can write a row by
/// simple stores, and every program that reads HDF5 can read it.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hapticd/abi.h"

namespace hapticd::record {

/// double, float, uint64, uint32, int32, and UTF-8 of less than kTextBytes bytes, filled up with zeros
enum class ColumnType : uint8_t { kReal, kReal32, kCount, kWord, kInt, kText };

constexpr uint32_t kTextBytes = 96;  ///< [bytes] place of a text in a row; the last byte is 0

/// The name of each type in descriptions of recordings, in the order of ColumnType.
constexpr std::array<const char*, 6> kTypeNames = {"f8", "f4", "u8", "u4", "i4", "s96"};
static_assert(kTextBytes == 96, "\"s96\" names the size of a text");

/// [any] Returns the size [bytes] of a value of this type; 0 for a value that is not in the enumeration.
constexpr uint32_t bytesOf(ColumnType type) {
  switch (type) {
    case ColumnType::kReal:
    case ColumnType::kCount:
      return 8;
    case ColumnType::kReal32:
    case ColumnType::kWord:
    case ColumnType::kInt:
      return 4;
    case ColumnType::kText:
      return kTextBytes;
  }
  return 0;
}

/// [any] Returns the alignment [bytes] of a value of this type. A text has that of the length before it in CDR.
constexpr uint32_t alignmentOf(ColumnType type) {
  return type == ColumnType::kText ? 4 : bytesOf(type);
}

/// [any] Returns the type of this name; nothing if there is none.
inline std::optional<ColumnType> typeOf(std::string_view name) {
  for (size_t i = 0; i < kTypeNames.size(); ++i)
    if (name == kTypeNames[i]) return static_cast<ColumnType>(i);
  return std::nullopt;
}

struct Column {
  std::string name, unit, doc;
  ColumnType type = ColumnType::kReal;
  uint32_t offset = 0;  ///< [bytes] distance from the start of the row
};

/// The layout of a row. Numbers are aligned to their size, texts to 4 bytes, and rows to 8.
class RowLayout {
 public:
  /// [main] Adds a column and returns its offset in the row.
  uint32_t add(const std::string& name, ColumnType type, const std::string& unit, const std::string& doc) {
    const uint32_t bytes = bytesOf(type), unit_bytes = alignmentOf(type);
    const uint32_t offset = (end_ + unit_bytes - 1) / unit_bytes * unit_bytes;
    columns_.push_back({name, unit, doc, type, offset});
    end_ = offset + bytes;
    return offset;
  }
  const std::vector<Column>& columns() const { return columns_; }
  uint32_t rowBytes() const { return (end_ + 7) / 8 * 8; }

 private:
  std::vector<Column> columns_;
  uint32_t end_ = 0;
};

/// [rt] Stores one number of a row.
template <class T>
inline void put(std::byte* row, uint32_t offset, T value) noexcept HSP_RT {
  std::memcpy(row + offset, &value, sizeof value);
}

/// A stream of a recording: a table that grows row by row.
struct StreamSpec {
  std::string name;
  RowLayout layout;
  uint64_t ring_rows = 0;  ///< number of rows that the black box keeps
};

}  // namespace hapticd::record

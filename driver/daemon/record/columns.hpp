// SPDX-License-Identifier: MIT
/// The columns of a recorded row: named numbers at fixed offsets. So the servo can write a row by simple stores, and
/// every program that reads HDF5 can read it.
#pragma once
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "hapticd/abi.h"

namespace hapticd::record {

enum class ColumnType : uint8_t { kReal, kReal32, kCount, kWord, kInt };  ///< double, float, uint64, uint32, int32

/// [any] Returns the size [bytes] of a number of this type; 0 for a value that is not in the enumeration.
constexpr uint32_t bytesOf(ColumnType type) {
  switch (type) {
    case ColumnType::kReal:
    case ColumnType::kCount:
      return 8;
    case ColumnType::kReal32:
    case ColumnType::kWord:
    case ColumnType::kInt:
      return 4;
  }
  return 0;
}

struct Column {
  std::string name, unit, doc;
  ColumnType type = ColumnType::kReal;
  uint32_t offset = 0;  ///< [bytes] distance from the start of the row
};

/// The layout of a row. Numbers are aligned to their size, and rows to 8 bytes.
class RowLayout {
 public:
  /// [main] Adds a column and returns its offset in the row.
  uint32_t add(const std::string& name, ColumnType type, const std::string& unit, const std::string& doc) {
    const uint32_t bytes = bytesOf(type), offset = (end_ + bytes - 1) / bytes * bytes;
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

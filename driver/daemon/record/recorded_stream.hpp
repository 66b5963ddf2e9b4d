// SPDX-License-Identifier: MIT
/// The rows of one stream of a recording. They are read in pages when they are asked for.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "record/columns.hpp"
#include "record/recorded_bytes.hpp"

namespace hapticd::record {

/// [any] Returns a number of a row as a double; counts above 2^53 are rounded. A text is NaN.
double numberOf(const std::byte* row, const Column& column);

/// One thread at a time may use it.
class RecordedStream {
 public:
  const std::string& name() const { return name_; }
  const std::vector<Column>& columns() const { return columns_; }
  uint32_t rowBytes() const { return row_bytes_; }
  uint64_t rows() const { return rows_; }
  uint64_t lost() const { return lost_; }  ///< rows that the writer lost

  /// [main] Returns a row, index < rows(). It stays valid until rows of four other places of this stream were read. If
  /// the file has been cut meanwhile it is all zeros, and Recording::unchanged() fails.
  const std::byte* row(uint64_t index) const {
    const uint64_t at = first_ + index, slot = ring_rows_ == 0 ? at : at % ring_rows_;
    const uint64_t in_chunk = slot % chunk_rows_,
                   number = slot / chunk_rows_ * pages_per_chunk_ + in_chunk / page_rows_;
    const Page& page = pages_.front().number == number ? pages_.front() : fetch(number);
    return page.rows.data() + in_chunk % page_rows_ * row_bytes_;
  }
  const Column* find(const std::string& name) const;

  double number(uint64_t index, const Column& column) const { return numberOf(row(index), column); }
  /// [main] Returns a text of a row; "" for a number. A damaged file may hold bytes that are no text.
  std::string text(uint64_t index, const Column& column) const;

 private:
  friend class Recording;
  /// Some rows that stand together in the file.
  struct Page {
    uint64_t number = UINT64_MAX;
    std::vector<std::byte> rows;
  };
  void setChunkRows(uint32_t rows);
  const Page& fetch(uint64_t number) const;

  std::string name_;
  std::vector<Column> columns_;
  uint32_t row_bytes_ = 8, chunk_rows_ = 1, page_rows_ = 1, pages_per_chunk_ = 1;
  uint64_t rows_ = 0, first_ = 0, ring_rows_ = 0, lost_ = 0;
  const RecordedBytes* bytes_ = nullptr;
  std::vector<uint64_t> chunks_;       ///< addresses
  mutable std::array<Page, 4> pages_;  ///< that were asked for last, the newest first
};

}  // namespace hapticd::record

// SPDX-License-Identifier: MIT
/// Reads a recording or a black box, even one whose writer crashed. It does not trust the file: sizes, addresses and
/// numbers are checked before they are used.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/result.hpp"
#include "record/columns.hpp"

namespace hapticd::record {

/// [any] Returns a number of a row as a double; counts above 2^53 are rounded. A text is NaN.
double numberOf(const std::byte* row, const Column& column);

/// The rows of one stream.
class RecordedStream {
 public:
  const std::string& name() const { return name_; }
  const std::vector<Column>& columns() const { return columns_; }
  uint32_t rowBytes() const { return row_bytes_; }
  uint64_t rows() const { return rows_; }
  uint64_t lost() const { return lost_; }       ///< rows that the writer lost
  const std::byte* row(uint64_t index) const {  ///< [any] index < rows()
    const uint64_t at = first_ + index, in_ring = ring_rows_ == 0 ? at : at % ring_rows_;
    return chunks_[in_ring / chunk_rows_] + (in_ring % chunk_rows_) * row_bytes_;
  }
  const Column* find(const std::string& name) const;

  double number(uint64_t index, const Column& column) const { return numberOf(row(index), column); }
  /// [any] Returns a text of a row; "" for a number. A damaged file may hold bytes that are no text.
  std::string text(uint64_t index, const Column& column) const;

 private:
  friend class Recording;
  std::string name_;
  std::vector<Column> columns_;
  uint32_t row_bytes_ = 8, chunk_rows_ = 1;
  uint64_t rows_ = 0, first_ = 0, ring_rows_ = 0, lost_ = 0;
  std::vector<const std::byte*> chunks_;
};

class Recording {
 public:
  /// [main] Maps the file and checks it.
  static Result<std::unique_ptr<Recording>> open(const std::string& file);
  /// [main] Reads a recording from memory, which must outlive the object. @param name name of the recording in messages
  static Result<std::unique_ptr<Recording>> parse(std::span<const std::byte> bytes, const std::string& name);
  ~Recording();
  Recording(const Recording&) = delete;
  Recording& operator=(const Recording&) = delete;

  const std::string& aboutJson() const { return about_; }
  const std::vector<RecordedStream>& streams() const { return streams_; }
  const RecordedStream* stream(const std::string& name) const;
  bool closed() const { return closed_; }  ///< true if its writer ended normally
  /// Returns the id of the process that was still writing the file when it was opened. Returns 0 if there was such a
  /// process but its id could not be found out, and nothing if there was none.
  std::optional<int> writer() const { return writer_; }
  /// Returns how rows were lost after they were written, because the file was cut or changed; "" if none were.
  const std::string& damage() const { return damage_; }
  bool blackBox() const { return black_box_; }  ///< true if it contains only the newest rows, in a ring

 private:
  Recording() = default;
  Result<void> read(std::span<const std::byte> bytes);
  Result<void> readRing(std::span<const std::byte> bytes);
  Result<void> readBlocks(std::span<const std::byte> bytes, uint64_t address);
  void noteDamage(const RecordedStream& stream, uint64_t space, uint64_t stopped, std::span<const std::byte> bytes);
  Result<void> readColumns();

  std::string about_, damage_;
  std::vector<RecordedStream> streams_;
  bool closed_ = false, black_box_ = false;
  std::optional<int> writer_;
  std::vector<std::byte>
      copy_;  ///< of a black box, whose rows point into it; otherwise they point into the mapped file
  void* mapped_ = nullptr;
  size_t mapped_bytes_ = 0;
};

}  // namespace hapticd::record

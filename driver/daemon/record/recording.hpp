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
#include "record/recorded_stream.hpp"

namespace hapticd::record {

class Recording {
 public:
  /// [main] Opens the file and checks it.
  static Result<std::unique_ptr<Recording>> open(const std::string& file);
  /// [main] Reads a recording from memory, which must outlive the object. @param name name of the recording in messages
  static Result<std::unique_ptr<Recording>> parse(std::span<const std::byte> bytes, const std::string& name);
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
  /// [main] Fails, with the file's name, if another program has cut or changed the file since it was opened. Ask after
  /// the last row was read.
  Result<void> unchanged() const;
  bool blackBox() const { return black_box_; }  ///< true if it contains only the newest rows, in a ring

 private:
  Recording() = default;
  Result<void> read();
  Result<void> readRing();
  Result<void> readBlocks(uint64_t address);
  void noteDamage(const RecordedStream& stream, uint64_t space, uint64_t stopped);
  Result<void> readColumns();

  std::string file_, about_, damage_;
  std::vector<std::byte> copy_;  ///< of a black box
  std::unique_ptr<RecordedBytes> bytes_;
  std::vector<RecordedStream> streams_;
  bool closed_ = false, black_box_ = false;
  std::optional<int> writer_;
};

}  // namespace hapticd::record

// SPDX-License-Identifier: MIT
/// The source of the rows of a view: the black box of a running daemon, or a recording. The rows are passed on
/// unchanged. Their columns are described by aboutJson().
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "base/result.hpp"

namespace hapticd::view {

/// One table of rows.
struct RowStream {
  std::string name;
  uint32_t row_bytes = 8;  ///< a multiple of 8; each row begins with its tick, u64
};

/// The rows of a run, numbered from the beginning of the run. Only one thread at a time may use it.
class RowSource {
 public:
  RowSource() = default;
  virtual ~RowSource() = default;
  RowSource(const RowSource&) = delete;
  RowSource& operator=(const RowSource&) = delete;

  /// [main] Returns the JSON that describes the run: scene, devices, columns (see recording.md).
  virtual const std::string& aboutJson() const = 0;
  /// [main] Returns the streams in the order of the file. The index of a stream is its number in messages.
  virtual const std::vector<RowStream>& streams() const = 0;
  virtual uint64_t begin(size_t stream) const = 0;  ///< [main] number of the oldest row that is kept
  virtual uint64_t end(size_t stream) const = 0;    ///< [main] number of the newest row plus one

  /// [main] Copies up to `count` rows, beginning with row number `first`. @return the number of rows copied; 0 if
  /// `first` is no longer kept
  virtual uint64_t copy(size_t stream, uint64_t first, uint64_t count, std::byte* rows) const = 0;

  /// [main] Fails if another program has cut or changed the file.
  virtual Result<void> unchanged() const { return {}; }

  /// [main] Returns the index of the stream of that name, or streams().size() if there is none.
  size_t find(const std::string& name) const;
};

/// [main] Maps the black box of a running daemon read-only. Fails if the file is not a black box or is not yet
/// complete.
Result<std::unique_ptr<RowSource>> openBlackBox(const std::string& file);

/// [main] Opens a recording, a dump, or the file that a crash left.
Result<std::unique_ptr<RowSource>> openRecording(const std::string& file);

/// [main] Returns the first row of a stream whose tick is `tick` or later. Rows are in the order of their ticks.
uint64_t firstRowOf(const RowSource& source, size_t stream, uint64_t tick);

}  // namespace hapticd::view

// SPDX-License-Identifier: MIT
/// Types that the files of the client library share. Users of the library do not see them.
#pragma once
#include <sys/mman.h>
#include <sys/types.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <list>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/descriptors.hpp"
#include "base/result.hpp"
#include "control/client.hpp"
#include "hapticd/client.h"

namespace hapticd::client {

/// Memory of the daemon, mapped into this process.
class Mapping {
 public:
  Mapping() = default;
  /// Maps memory that a daemon has passed. It must be sealed against shrinking: else this process could be killed while
  /// it reads. After an error, data() is nullptr and errno says why. @param bytes 0 for all of it
  static Mapping sealed(int fd, size_t bytes, int protection);
  Mapping(Mapping&& other) noexcept : data_(std::exchange(other.data_, nullptr)), bytes_(other.bytes_) {}
  Mapping& operator=(Mapping&& other) noexcept {
    std::swap(data_, other.data_);
    std::swap(bytes_, other.bytes_);
    return *this;
  }
  ~Mapping();
  std::byte* data() const { return data_; }
  size_t bytes() const { return bytes_; }
  /// Returns the address of byte `place`, or nullptr if not all `bytes` bytes from there are in the mapping.
  std::byte* at(size_t place, size_t bytes) const {
    return place <= bytes_ && bytes <= bytes_ - place ? data_ + place : nullptr;
  }

 private:
  Mapping(int fd, size_t bytes, int protection);
  std::byte* data_ = nullptr;
  size_t bytes_ = 0;
};

/// One stream of the black box.
struct Stream {
  std::string name;
  uint64_t written_at = 0;  ///< place in the file of the number of rows written so far
  uint64_t rows_at = 0;     ///< place in the file of the rows
  uint64_t handed = 0;      ///< number of rows up to the newest one that some thread has read
  uint64_t capacity = 0;
  size_t row_words = 0;
  std::list<std::string> texts;  ///< owns the texts to which the columns point
  std::vector<hapticd_column> columns;
};

/// The black box of a daemon. It is read and not mapped, because the kernel kills a program whose mapped file is cut.
class RowFile {
 public:
  static Result<RowFile> open(const std::string& file);
  const std::string& about() const { return about_; }
  const std::vector<std::string>& devices() const { return devices_; }
  /// Returns the time [ns] from one tick to the next.
  int64_t period() const { return period_; }
  std::vector<Stream>& streams() { return streams_; }
  /// True if the daemon has noted in this file that it ended in order.
  bool ended() const;
  /// True if `file` is still the file that was opened. Another daemon of this name would have replaced it.
  bool isFile(const std::string& file) const;
  /// Returns how many rows were ever written; nothing if the file was cut.
  std::optional<uint64_t> written(const Stream& stream) const;
  /// Copies rows as hapticd_read() does. Returns -1, and leaves `row`, if the file was cut.
  long read(const Stream& stream, uint64_t& row, void* rows, size_t most) const;

 private:
  Result<void> readStreams();
  Result<void> readBlocks(uint64_t place);
  Result<void> readAbout();
  bool copy(uint64_t place, void* to, size_t bytes) const;
  bool copyRows(const Stream& stream, uint64_t first, uint64_t count, void* rows) const;
  /// True if all these bytes were in the file when it was opened.
  bool has(uint64_t place, uint64_t bytes) const { return place <= size_ && bytes <= size_ - place; }
  Descriptor file_;
  uint64_t size_ = 0;
  std::string about_;
  std::vector<Stream> streams_;
  std::vector<std::string> devices_;
  int64_t period_ = 0;
  dev_t device_ = 0;
  ino_t inode_ = 0;
};

/// The answer to a request, and the descriptor that may come with it.
struct Answer {
  std::string line;
  Descriptor descriptor;
};

/// Fills in `error`, which may be nullptr.
void setError(hapticd_error* error, const char* code, const std::string& text);

/// Sends the request that ends a lead in order. It is called before the client is closed.
void endInOrder(hapticd_client& client, const hapticd_lead& lead);

}  // namespace hapticd::client

/// The client of client.h: the connection, the black box, and the memory that requests returned.
struct hapticd_client {
  hapticd_client(std::string where, hapticd::control::Client on, hapticd::client::RowFile box)
      : base(std::move(where)), line(std::move(on)), rows(std::move(box)) {}
  /// Sends a request and reads the answer. Returns false if the request was refused or no answer came; `error` says
  /// why.
  bool ask(const std::string& request, hapticd::client::Answer& answer, hapticd_error* error);
  /// Sends a request without waiting for the answer.
  void leave(const std::string& request);
  /// Returns the memory that comes with the answer to a request, or nullptr if it is not available. The memory is
  /// mapped at the first call, and kept in `kept`.
  std::byte* page(const char* request, hapticd::client::Mapping& kept, size_t least, int protection);

  /// [any] True if the daemon of this client has ended. Its rows and states are then out of date.
  bool ended();
  void reportSilence(const std::string& problem, hapticd_error* error);

  std::string base;  ///< beginning of the daemon's file names, "/run/hapticd/NAME"
  hapticd::control::Client line;
  hapticd::client::RowFile rows;
  std::mutex asking, mapping;
  hapticd::client::Mapping bell, states;
  std::list<hapticd_lead*> leads;
  /// [ns] how long before and after a tick is due next_state polls instead of sleeping
  std::atomic<int64_t> listen_ns = 0;
};

struct hapticd_lead {
  hapticd_client* client;
  std::string unlead;  ///< the request that ends the lead
  bool pushes;
  hapticd::client::Mapping memory;
};

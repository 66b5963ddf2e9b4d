// SPDX-License-Identifier: MIT
#include "row_source.hpp"

#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>

#include "base/regular_file.hpp"
#include "record/layout.hpp"
#include "record/recording.hpp"

namespace hapticd::view {

namespace {

/// A file that is mapped read-only while the object lives.
class Mapped {
 public:
  explicit Mapped(const std::string& file) {
    const auto fd = openRegular(file);
    if (!fd) {
      error_ = fd.error();
      return;
    }
    struct stat info{};
    const size_t size = fstat(*fd, &info) == 0 && info.st_size > 0 ? static_cast<size_t>(info.st_size) : 0;
    void* memory = size == 0 ? MAP_FAILED : mmap(nullptr, size, PROT_READ, MAP_SHARED, *fd, 0);
    error_ = size == 0 ? "is empty" : memory == MAP_FAILED ? std::strerror(errno) : "";
    close(*fd);
    if (memory != MAP_FAILED) bytes_ = static_cast<const std::byte*>(memory), size_ = size;
  }
  ~Mapped() {
    if (bytes_ != nullptr) munmap(const_cast<std::byte*>(bytes_), size_);
  }
  Mapped(const Mapped&) = delete;
  Mapped& operator=(const Mapped&) = delete;

  const std::string& error() const { return error_; }
  const std::byte* at(uint64_t address, uint64_t bytes) const {
    return address <= size_ && bytes <= size_ - address ? bytes_ + address : nullptr;
  }

 private:
  std::string error_;
  const std::byte* bytes_ = nullptr;
  size_t size_ = 0;
};

/// The rings of a black box, which a servo thread writes at the same time. As in record::FlightRing, the words of a row
/// are stored with release order, then the count of rows. A copied row is valid if the writer did not overwrite it
/// meanwhile.
class BlackBox final : public RowSource {
 public:
  explicit BlackBox(const std::string& file) : mapped_(file) {}

  Result<void> read() {
    if (!mapped_.error().empty()) return Error{mapped_.error()};
    const std::byte* at = mapped_.at(record::kHeaderAt, sizeof(record::FileHeader));
    if (at == nullptr || std::memcmp(at, record::kRecordingFormat, std::strlen(record::kRecordingFormat)) != 0)
      return Error{"is not the black box of a daemon"};
    header_ = reinterpret_cast<const record::FileHeader*>(at);
    if (header_->ring != 1 || header_->stream_count > record::kMaxStreams) return Error{"is not a black box"};
    const std::byte* about = mapped_.at(header_->about_address, header_->about_bytes);
    if (about == nullptr) return Error{"ends inside its description: it is incomplete or damaged"};
    about_.assign(reinterpret_cast<const char*>(about), header_->about_bytes);
    for (uint32_t i = 0; i < header_->stream_count; ++i) {
      const record::StreamHeader& stream = header_->streams[i];
      if (stream.row_bytes == 0 || stream.row_bytes % 8 != 0 || stream.row_bytes > record::kMaxRowBytes)
        return Error{"has rows of " + std::to_string(stream.row_bytes) + " bytes, expected a multiple of 8 up to " +
                     std::to_string(record::kMaxRowBytes) + ": it is damaged"};
      streams_.push_back({std::string(stream.name, strnlen(stream.name, sizeof stream.name)), stream.row_bytes});
    }
    return readBlocks();
  }

  const std::string& aboutJson() const override { return about_; }
  const std::vector<RowStream>& streams() const override { return streams_; }
  uint64_t end(size_t stream) const override {
    auto& rows = const_cast<uint64_t&>(header_->streams[stream].rows);  // atomic_ref takes no const before C++26
    return std::atomic_ref<uint64_t>(rows).load(std::memory_order_acquire);
  }
  uint64_t begin(size_t stream) const override {
    const uint64_t rows = end(stream), kept = rings_[stream].capacity - 1;  // one slot may be half-written
    return rows > kept ? rows - kept : 0;
  }
  uint64_t copy(size_t stream, uint64_t first, uint64_t count, std::byte* rows) const override {
    const Ring& ring = rings_[stream];
    const uint64_t last = end(stream), words = streams_[stream].row_bytes / 8;
    const auto overwritten = [&](uint64_t head) { return head - first >= ring.capacity; };
    if (first >= last || overwritten(last)) return 0;
    const uint64_t whole = std::min(count, last - first);
    for (uint64_t i = 0; i < whole; ++i) {
      auto* from = reinterpret_cast<uint64_t*>(ring.rows) + (first + i) % ring.capacity * words;
      for (uint64_t w = 0; w < words; ++w) {
        const uint64_t word = std::atomic_ref<uint64_t>(from[w]).load(std::memory_order_acquire);
        std::memcpy(rows + (i * words + w) * 8, &word, 8);
      }
    }
    return overwritten(end(stream)) ? 0 : whole;
  }

 private:
  struct Ring {
    std::byte* rows = nullptr;
    uint64_t capacity = 0;
  };

  Result<void> readBlocks() {
    rings_.resize(streams_.size());
    uint64_t address = header_->blocks_address;
    while (const std::byte* at = mapped_.at(address, sizeof(record::BlockHeader))) {
      record::BlockHeader block;
      std::memcpy(&block, at, sizeof block);
      if (block.magic != record::BlockHeader::kMagic) break;
      const std::byte* rows = mapped_.at(address + sizeof block, block.bytes);
      if (rows == nullptr) break;
      if (block.stream < rings_.size())
        rings_[block.stream] = {const_cast<std::byte*>(rows), block.bytes / streams_[block.stream].row_bytes};
      address += sizeof block + block.bytes;
    }
    for (const Ring& ring : rings_)
      if (ring.capacity < 2) return Error{"has no room for rows: it is incomplete or damaged"};
    return {};
  }

  Mapped mapped_;
  const record::FileHeader* header_ = nullptr;
  std::string about_;
  std::vector<RowStream> streams_;
  std::vector<Ring> rings_;
};

/// A file whose rows do not change.
class RecordingRows final : public RowSource {
 public:
  explicit RecordingRows(std::unique_ptr<record::Recording> recording) : recording_(std::move(recording)) {
    for (const record::RecordedStream& stream : recording_->streams())
      streams_.push_back({stream.name(), stream.rowBytes()});
  }
  const std::string& aboutJson() const override { return recording_->aboutJson(); }
  const std::vector<RowStream>& streams() const override { return streams_; }
  Result<void> unchanged() const override { return recording_->unchanged(); }
  uint64_t begin(size_t) const override { return 0; }
  uint64_t end(size_t stream) const override { return recording_->streams()[stream].rows(); }
  uint64_t copy(size_t stream, uint64_t first, uint64_t count, std::byte* rows) const override {
    const record::RecordedStream& from = recording_->streams()[stream];
    const uint64_t whole = first < from.rows() ? std::min(count, from.rows() - first) : 0;
    for (uint64_t i = 0; i < whole; ++i) std::memcpy(rows + i * from.rowBytes(), from.row(first + i), from.rowBytes());
    return whole;
  }

 private:
  std::unique_ptr<record::Recording> recording_;
  std::vector<RowStream> streams_;
};

}  // namespace

size_t RowSource::find(const std::string& name) const {
  const auto& all = streams();
  const auto it = std::find_if(all.begin(), all.end(), [&](const RowStream& s) { return s.name == name; });
  return static_cast<size_t>(it - all.begin());
}

Result<std::unique_ptr<RowSource>> openBlackBox(const std::string& file) {
  auto box = std::make_unique<BlackBox>(file);
  if (auto read = box->read(); !read) return Error{file + ": " + read.error()};
  return std::unique_ptr<RowSource>(std::move(box));
}

Result<std::unique_ptr<RowSource>> openRecording(const std::string& file) {
  auto recording = record::Recording::open(file);
  if (!recording) return Error{recording.error()};
  return std::unique_ptr<RowSource>(std::make_unique<RecordingRows>(std::move(*recording)));
}

uint64_t firstRowOf(const RowSource& source, size_t stream, uint64_t tick) {
  std::vector<std::byte> row(source.streams()[stream].row_bytes);
  uint64_t low = source.begin(stream), high = source.end(stream);
  while (low < high) {
    const uint64_t middle = low + (high - low) / 2;
    uint64_t at = 0;  // stays 0 if the row was overwritten meanwhile, because the row is then too old
    if (source.copy(stream, middle, 1, row.data()) == 1) std::memcpy(&at, row.data(), sizeof at);
    if (at < tick)
      low = middle + 1;
    else
      high = middle;
  }
  return low;
}

}  // namespace hapticd::view

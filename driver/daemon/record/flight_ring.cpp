// SPDX-License-Identifier: MIT
#include "record/flight_ring.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "record/hdf5.hpp"
#include "record/recording_file.hpp"

namespace hapticd::record {

namespace {

/// Maps a new file of this size, or memory without a file if `file` is empty.
Result<std::byte*> mapMemory(const std::string& file, size_t bytes) {
  void* memory = MAP_FAILED;
  if (file.empty()) {
    memory = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  } else {
    unlink(file.c_str());  // a process that has mapped an older file keeps it
    const int fd = open(file.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, 0640);
    // allocated now, so that a full file system is an error here instead of a bus error in a tick
    const int full = fd < 0 ? errno : posix_fallocate(fd, 0, static_cast<off_t>(bytes));
    if (full == 0) memory = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0);
    if (full != 0) errno = full;
    const int error = errno;
    if (fd >= 0) close(fd);
    errno = error;
  }
  if (memory == MAP_FAILED)
    return Error{"cannot keep the black box" + (file.empty() ? "" : " in " + file) + ": " + std::strerror(errno)};
  return static_cast<std::byte*>(memory);
}

struct Place {
  uint64_t index_address, rows_address;
};

void put(std::byte* memory, uint64_t at, const void* bytes, size_t size) {
  std::memcpy(memory + at, bytes, size);
}

void putText(std::byte* memory, uint64_t at, const std::string& bytes) {
  put(memory, at, bytes.data(), bytes.size());
}

/// Returns the places of the index and the rows of each stream. @param end [bytes] end of the file; it is moved behind
/// these places
std::vector<Place> placesOf(const std::vector<StreamSpec>& streams, const std::vector<uint32_t>& rows, uint64_t& end) {
  std::vector<Place> places;
  for (size_t i = 0; i < streams.size(); ++i) {
    const uint64_t index = end + sizeof(BlockHeader),
                   chunk = index + hdf5::ChunkIndex::kNodeBytes + sizeof(BlockHeader);
    places.push_back({index, chunk});
    end = chunk + uint64_t{rows[i]} * streams[i].layout.rowBytes();
  }
  return places;
}

void writeBlocks(std::byte* memory, uint32_t stream, uint64_t bytes, const Place& place) {
  BlockHeader block;
  block.stream = BlockHeader::kIndex;
  block.bytes = hdf5::ChunkIndex::kNodeBytes;
  put(memory, place.index_address - sizeof block, &block, sizeof block);
  block.stream = stream;
  block.bytes = bytes;
  put(memory, place.rows_address - sizeof block, &block, sizeof block);
}

void writeTable(std::byte* memory, const Skeleton& skeleton, size_t stream, uint32_t rows, uint32_t row_bytes,
                const Place& place) {
  hdf5::ChunkIndex index(rows, uint64_t{rows} * row_bytes);
  for (const auto& node : index.add(place.rows_address, [&] { return place.index_address; }))
    putText(memory, node.address, node.bytes);
  hdf5::TableHeader table;
  table.rows = rows;
  table.index_address = index.root();
  table.chunk_rows = rows;
  table.row_bytes = row_bytes;
  table.description_address = skeleton.descriptions[stream];
  table.description_bytes = skeleton.description_bytes[stream];
  putText(memory, skeleton.tables[stream], table.bytes());
}

}  // namespace

Result<std::unique_ptr<FlightRing>> FlightRing::create(const std::vector<StreamSpec>& streams, const About& about,
                                                       const std::string& file) {
  std::vector<uint32_t> rows;
  for (const StreamSpec& stream : streams)
    rows.push_back(static_cast<uint32_t>(
        std::clamp<uint64_t>(stream.ring_rows, 1, (uint64_t{1} << 31) / stream.layout.rowBytes())));
  const Skeleton skeleton = makeSkeleton(streams, rows, about, true);
  uint64_t end = skeleton.bytes.size();
  const std::vector<Place> places = placesOf(streams, rows, end);
  auto memory = mapMemory(file, end);
  if (!memory) return Error{memory.error()};
  std::unique_ptr<FlightRing> ring(new FlightRing);
  ring->specs_ = streams;
  ring->about_ = about;
  ring->file_ = file;
  ring->memory_ = *memory;
  ring->bytes_ = end;
  std::memset(ring->memory_, 0, end);
  putText(ring->memory_, 0, skeleton.bytes);
  putText(ring->memory_, 0, hdf5::superblock(skeleton.root, end));
  auto* header = reinterpret_cast<FileHeader*>(ring->memory_ + kHeaderAt);
  for (size_t i = 0; i < streams.size(); ++i) {
    const uint32_t row_bytes = streams[i].layout.rowBytes();
    writeBlocks(ring->memory_, static_cast<uint32_t>(i), uint64_t{rows[i]} * row_bytes, places[i]);
    writeTable(ring->memory_, skeleton, i, rows[i], row_bytes, places[i]);
    ring->streams_.push_back({&header->streams[i], ring->memory_ + places[i].rows_address, row_bytes, rows[i], 0, 0,
                              std::vector<uint64_t>(row_bytes / sizeof(uint64_t))});
  }
  return ring;
}

FlightRing::~FlightRing() {
  if (memory_ != nullptr) munmap(memory_, bytes_);
}

uint64_t FlightRing::copy(size_t stream, uint64_t first, uint64_t count, std::byte* rows) const noexcept {
  const Stream& s = streams_[stream];
  const uint64_t end = written(stream);
  // the slot after the newest row may already be partly overwritten
  const auto overwritten = [&](uint64_t row, uint64_t head) { return head - row >= s.capacity; };
  if (first >= end || overwritten(first, end)) return 0;
  const uint64_t whole = std::min(count, end - first);
  for (uint64_t done = 0; done < whole;) {
    const uint64_t at = (first + done) % s.capacity, run = std::min(whole - done, s.capacity - at);
    auto* from = reinterpret_cast<uint64_t*>(s.rows + at * s.row_bytes);
    for (uint64_t i = 0; i < run * s.filled.size(); ++i) {
      const uint64_t word = std::atomic_ref<uint64_t>(from[i]).load(std::memory_order_acquire);
      std::memcpy(rows + done * s.row_bytes + i * sizeof word, &word, sizeof word);
    }
    done += run;
  }
  return overwritten(first, written(stream)) ? 0 : whole;
}

Result<void> FlightRing::dump(const std::string& file) const {
  constexpr uint64_t kAtOnce = 256;
  auto recording = RecordingFile::create(file, specs_, about_);
  if (!recording) return Error{recording.error()};
  for (size_t stream = 0; stream < streams_.size(); ++stream) {
    std::vector<std::byte> rows(kAtOnce * rowBytes(stream));
    const uint64_t end = written(stream), kept = streams_[stream].capacity - 1;
    uint64_t first = end > kept ? end - kept : 0;
    for (uint64_t copied = 0; first < end; first += std::max<uint64_t>(copied, 1)) {
      copied = copy(stream, first, std::min(kAtOnce, end - first), rows.data());
      if (auto done = (*recording)->append(stream, rows.data(), copied); !done) return done;
    }
  }
  return (*recording)->close();
}

void FlightRing::noteEnd() noexcept {
  auto* header = reinterpret_cast<FileHeader*>(memory_ + kHeaderAt);
  std::atomic_ref<uint32_t>(header->closed).store(1, std::memory_order_release);
}

void FlightRing::removeFile() {
  if (!file_.empty()) unlink(file_.c_str());
  file_.clear();
}

}  // namespace hapticd::record

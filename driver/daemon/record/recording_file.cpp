// SPDX-License-Identifier: MIT
#include "record/recording_file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstring>

#include "base/regular_file.hpp"

namespace hapticd::record {

Result<std::unique_ptr<RecordingFile>> RecordingFile::create(const std::string& file,
                                                             const std::vector<StreamSpec>& streams, const About& about,
                                                             uint64_t chunk_bytes) {
  const int fd = open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  if (fd < 0) return Error{file + ": cannot be written: " + std::strerror(errno)};
  std::unique_ptr<RecordingFile> recording(new RecordingFile(file, fd));
  // The lock is held while the file is open, because two writers would make the file unreadable.
  if (flock(fd, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
    return Error{file +
                 ": another run records into it, or a program that reads it keeps it open; expected the name of "
                 "another file"};
  std::vector<uint32_t> chunk_rows;
  for (const StreamSpec& stream : streams) {
    const uint32_t bytes = stream.layout.rowBytes();
    const auto rows = static_cast<uint32_t>(std::max<uint64_t>(chunk_bytes / bytes, 1));
    chunk_rows.push_back(rows);
    recording->streams_.push_back({bytes, rows, hdf5::ChunkIndex(rows, uint64_t{rows} * bytes)});
  }
  recording->skeleton_ = makeSkeleton(streams, chunk_rows, about, false);
  struct stat there{};
  if (fstat(fd, &there) != 0 || there.st_size == 0) recording->begin();
  if (recording->error_ == 0) return recording;
  removeIncomplete(file);
  return Error{file + ": cannot be written: " + std::strerror(recording->error_)};
}

/// Replaces what is in the file by the skeleton, once.
void RecordingFile::begin() {
  if (begun_) return;
  begun_ = true;
  if (ftruncate(fd_, 0) != 0 && errno != EINVAL) error_ = errno;
  write(0, skeleton_.bytes);
  end_ = skeleton_.bytes.size();
  skeleton_.bytes.clear();
}

void RecordingFile::discard() {
  if (begun_) removeIncomplete(file_);
}

RecordingFile::~RecordingFile() {
  if (fd_ >= 0) ::close(fd_);
}

Result<void> RecordingFile::append(size_t number, const std::byte* rows, uint64_t count) {
  Stream& stream = streams_[number];
  begin();
  while (count > 0) {
    const uint64_t in_chunk = stream.rows % stream.chunk_rows;
    if (in_chunk == 0)
      if (auto begun = beginChunk(stream, static_cast<uint32_t>(number)); !begun) return begun;
    const uint64_t now = std::min<uint64_t>(count, stream.chunk_rows - in_chunk);
    write(stream.chunk_address + in_chunk * stream.row_bytes, rows, now * stream.row_bytes);
    if (error_ != 0) return state();
    stream.rows += now;
    rows += now * stream.row_bytes;
    count -= now;
  }
  return {};
}

/// Begins a chunk. It writes first the space, then the new end of the file in the superblock, then the index. So the
/// file is valid after each of these writes.
Result<void> RecordingFile::beginChunk(Stream& stream, uint32_t number) {
  stream.chunk_address = newBlock(number, uint64_t{stream.chunk_rows} * stream.row_bytes);
  const auto writes = stream.index.add(stream.chunk_address,
                                       [&] { return newBlock(BlockHeader::kIndex, hdf5::ChunkIndex::kNodeBytes); });
  if (error_ == 0 && ftruncate(fd_, static_cast<off_t>(end_)) != 0) error_ = errno;
  write(0, hdf5::superblock(skeleton_.root, end_));
  for (const auto& node : writes) write(node.address, node.bytes);
  return state();
}

uint64_t RecordingFile::newBlock(uint32_t stream, uint64_t bytes) {
  BlockHeader block;
  block.stream = stream;
  block.bytes = (bytes + 7) / 8 * 8;
  write(end_, &block, sizeof block);
  const uint64_t address = end_ + sizeof block;
  end_ = address + block.bytes;
  return address;
}

Result<void> RecordingFile::publish() {
  begin();
  for (size_t i = 0; i < streams_.size() && error_ == 0; ++i) {
    Stream& stream = streams_[i];
    const uint64_t at = kHeaderAt + offsetof(FileHeader, streams) + i * sizeof(StreamHeader);
    write(at + offsetof(StreamHeader, lost), &stream.lost, sizeof stream.lost);
    if (stream.rows == stream.published) continue;
    hdf5::TableHeader table;
    table.rows = stream.rows;
    table.index_address = stream.index.root();
    table.chunk_rows = stream.chunk_rows;
    table.row_bytes = stream.row_bytes;
    table.description_address = skeleton_.descriptions[i];
    table.description_bytes = skeleton_.description_bytes[i];
    write(skeleton_.tables[i], table.bytes());
    write(at + offsetof(StreamHeader, rows), &stream.rows, sizeof stream.rows);
    stream.published = stream.rows;
  }
  return state();
}

Result<void> RecordingFile::close() {
  if (auto published = publish(); !published) return published;
  const uint32_t closed = 1;
  write(kHeaderAt + offsetof(FileHeader, closed), &closed, sizeof closed);
  if (::close(fd_) != 0 && error_ == 0) error_ = errno;
  fd_ = -1;
  return state();
}

void RecordingFile::write(uint64_t address, const void* bytes, size_t size) {
  const char* from = static_cast<const char*>(bytes);
  while (size > 0 && error_ == 0) {
    const ssize_t done = pwrite(fd_, from, size, static_cast<off_t>(address));
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) {
      error_ = done < 0 ? errno : ENOSPC;
      return;
    }
    from += done;
    address += static_cast<uint64_t>(done);
    size -= static_cast<size_t>(done);
  }
}

Result<void> RecordingFile::state() const {
  if (error_ == 0) return {};
  return Error{file_ + ": cannot be written: " + std::strerror(error_) + "; the file ends with its last complete row"};
}

}  // namespace hapticd::record

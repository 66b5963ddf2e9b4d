// SPDX-License-Identifier: MIT
#include "record/recording_file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "base/regular_file.hpp"

namespace hapticd::record {

namespace {

bool isSame(const struct stat& a, const struct stat& b) {
  return a.st_dev == b.st_dev && a.st_ino == b.st_ino;
}

/// True if a name is that of an open file.
bool isNameOf(const std::string& file, int fd) {
  struct stat named{}, opened{};
  return stat(file.c_str(), &named) == 0 && fstat(fd, &opened) == 0 && isSame(named, opened);
}

/// True if messages of this process go into the file: they would overwrite its first rows.
bool takesMessages(const struct stat& file) {
  struct stat output{};
  const auto goes = [&](int fd) { return fstat(fd, &output) == 0 && isSame(file, output); };
  return S_ISREG(file.st_mode) && (goes(STDOUT_FILENO) || goes(STDERR_FILENO));
}

/// True if an open file begins as recordings do.
bool isRecording(int fd) {
  FileHeader header;
  return pread(fd, &header, sizeof header, kHeaderAt) == static_cast<ssize_t>(sizeof header) &&
         std::strncmp(header.magic, kRecordingFormat, sizeof header.magic) == 0;
}

/// Locks a file while it is open, because two writers would make it unreadable. Returns false if another one has it.
bool lockFile(const std::string& file, int fd) {
  if (flock(fd, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) return false;
  return isNameOf(file, fd);  // else another run has just put its recording in this place
}

}  // namespace

Result<std::unique_ptr<RecordingFile>> RecordingFile::create(const std::string& file,
                                                             const std::vector<StreamSpec>& streams, const About& about,
                                                             uint64_t chunk_bytes) {
  const int fd = open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  if (fd < 0) return Error{file + ": cannot be written: " + std::strerror(errno)};
  std::unique_ptr<RecordingFile> recording(new RecordingFile(file, fd));
  if (!lockFile(file, fd))
    return Error{file +
                 ": another run records into it, or a program that reads it keeps it open; "
                 "expected the name of another file"};
  struct stat there{};
  const bool known = fstat(fd, &there) == 0;
  if (known && takesMessages(there))
    return Error{file + ": the messages of this run go into it, too; expected the name of another file"};
  std::vector<uint32_t> chunk_rows;
  for (const StreamSpec& stream : streams) {
    const uint32_t bytes = stream.layout.rowBytes();
    const auto rows = static_cast<uint32_t>(std::max<uint64_t>(chunk_bytes / bytes, 1));
    chunk_rows.push_back(rows);
    recording->streams_.push_back({bytes, rows, hdf5::ChunkIndex(rows, uint64_t{rows} * bytes)});
  }
  recording->skeleton_ = makeSkeleton(streams, chunk_rows, about, false);
  const bool former = known && S_ISREG(there.st_mode) && there.st_size > 0;
  if (former && there.st_nlink == 1) recording->writeBeside();
  if (!former || !recording->part_.empty()) recording->begin();
  if (recording->error_ == 0) return recording;
  if (!former) removeIncomplete(file);
  return Error{file + ": cannot be written: " + std::strerror(recording->error_)};
}

/// Writes into a file beside the former recording, if its folder allows one. Else begin() writes over the former one.
void RecordingFile::writeBeside() {
  char* resolved = realpath(file_.c_str(), nullptr);
  if (resolved == nullptr) return;
  const std::string target = resolved, part = target + ".part";
  std::free(resolved);
  const int fd = open(part.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0644);
  if (fd < 0) return;
  struct stat there{}, former{};
  const bool usable = fstat(fd, &there) == 0 && S_ISREG(there.st_mode) && there.st_nlink == 1 &&
                      (there.st_size == 0 || isRecording(fd));  // else it is somebody's
  if (!usable || !lockFile(part, fd)) {
    ::close(fd);
    return;
  }
  if (fstat(fd_, &former) == 0 && fchmod(fd, former.st_mode & 0777) != 0) error_ = errno;
  former_fd_ = fd_;
  fd_ = fd;
  part_ = part;
  target_ = target;
}

/// Gives the recording its name, and drops the former one.
void RecordingFile::takePlace() {
  if (part_.empty() || error_ != 0) return;
  if (std::rename(part_.c_str(), target_.c_str()) != 0) {
    error_ = errno;
    return;
  }
  part_.clear();
  ::close(former_fd_);
  former_fd_ = -1;
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
  if (begun_ && part_.empty()) removeIncomplete(file_);
}

RecordingFile::~RecordingFile() {
  if (!part_.empty()) removeIncomplete(part_);
  if (fd_ >= 0) ::close(fd_);
  if (former_fd_ >= 0) ::close(former_fd_);
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
  if (std::any_of(streams_.begin(), streams_.end(), [](const Stream& stream) { return stream.rows > 0; })) takePlace();
  return state();
}

Result<void> RecordingFile::close() {
  if (auto published = publish(); !published) return published;
  const uint32_t closed = 1;
  write(kHeaderAt + offsetof(FileHeader, closed), &closed, sizeof closed);
  takePlace();
  if (auto there = isThere(); !there && error_ == 0) return there;
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

/// Fails if the file was removed, moved, replaced or cut while it was written, as nobody would notice that otherwise.
Result<void> RecordingFile::isThere() const {
  struct stat there{};
  if (fstat(fd_, &there) != 0 || !S_ISREG(there.st_mode)) return {};
  if (!isNameOf(file_, fd_))
    return Error{file_ + ": this recording is not there any more: it was moved, replaced or removed during the run" +
                 (there.st_nlink > 0 ? "; where it was moved, it is complete" : "; its rows are lost")};
  // its header is written once: later rows do not bring it back
  if (isRecording(fd_) && static_cast<uint64_t>(there.st_size) >= end_) return {};
  return Error{file_ + ": another program cut this recording during the run; its first rows are lost"};
}

Result<void> RecordingFile::state() const {
  if (error_ == 0) return {};
  if (!part_.empty())
    return Error{file_ + ": cannot be written: " + std::strerror(error_) + "; the former recording of this name stays"};
  return Error{file_ + ": cannot be written: " + std::strerror(error_) + "; the file ends with its last complete row"};
}

}  // namespace hapticd::record

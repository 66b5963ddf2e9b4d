// SPDX-License-Identifier: MIT
#include "record/recorded_bytes.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "base/regular_file.hpp"
#include "record/live_writer.hpp"

namespace hapticd::record {

namespace {

int64_t changeOf(const struct stat& info) {
  return info.st_mtim.tv_sec * int64_t{1'000'000'000} + info.st_mtim.tv_nsec;
}

}  // namespace

Result<std::unique_ptr<RecordedBytes>> RecordedBytes::open(const std::string& file) {
  const auto fd = openRegular(file);
  if (!fd) return Error{fd.error()};
  std::unique_ptr<RecordedBytes> bytes(new RecordedBytes);
  bytes->fd_ = *fd;
  bytes->writer_ = writerOf(*fd);  // before reading: the writer may end at any time
  struct stat info{};
  if (fstat(*fd, &info) != 0) return Error{std::string("cannot be read: ") + std::strerror(errno)};
  bytes->size_ = static_cast<uint64_t>(info.st_size);
  bytes->changed_ns_ = changeOf(info);
  return bytes;
}

RecordedBytes::~RecordedBytes() {
  if (fd_ >= 0) ::close(fd_);
}

bool RecordedBytes::read(uint64_t address, void* to, size_t bytes) const {
  auto* target = static_cast<std::byte*>(to);
  size_t got = 0;
  if (fd_ < 0 && address < memory_.size()) {
    got = std::min<size_t>(bytes, memory_.size() - address);
    std::memcpy(target, memory_.data() + address, got);
  }
  while (fd_ >= 0 && got < bytes) {
    const ssize_t more = pread(fd_, target + got, bytes - got, static_cast<off_t>(address + got));
    if (more < 0 && errno == EINTR) continue;
    if (more <= 0) break;
    got += static_cast<size_t>(more);
  }
  std::memset(target + got, 0, bytes - got);
  if (got < bytes) cut_ = true;
  return got == bytes;
}

Result<void> RecordedBytes::unchanged() const {
  constexpr const char* kCopy = "; keep other programs from writing it, or read a copy";
  struct stat info{};
  if (fd_ >= 0 && fstat(fd_, &info) == 0 && static_cast<uint64_t>(info.st_size) < size_) cut_ = true;
  if (cut_) return Error{std::string("was cut by another program while it was read") + kCopy};
  if (fd_ >= 0 && !writer_ && changeOf(info) != changed_ns_)
    return Error{std::string("was changed by another program while it was read") + kCopy};
  return {};
}

}  // namespace hapticd::record

// SPDX-License-Identifier: MIT
#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "base/sealed_memory.hpp"

namespace hapticd {

namespace {

#ifndef F_SEAL_FUTURE_WRITE  // from <linux/fcntl.h>, which cannot be included beside <fcntl.h>
constexpr int F_SEAL_FUTURE_WRITE = 0x0010;
#endif

Error cannotShare(size_t bytes, int code) {
  return Error{"cannot share " + std::to_string(bytes) + " bytes of memory: " + std::strerror(code)};
}

}  // namespace

Result<std::unique_ptr<SealedMemory>> SealedMemory::create(const char* name, size_t bytes, Writers writers) {
  const auto page = static_cast<size_t>(sysconf(_SC_PAGESIZE));
  if (bytes > kMostBytes) return cannotShare(bytes, EFBIG);
  const size_t whole = (bytes + page - 1) / page * page;
  Descriptor fd(memfd_create(name, MFD_CLOEXEC | MFD_ALLOW_SEALING));
  if (!fd) return cannotShare(whole, errno);
  // allocated now, so that a lack of memory is an error here instead of a bus error in a tick
  int code = posix_fallocate(fd.get(), 0, static_cast<off_t>(whole));
  void* data = MAP_FAILED;
  if (code == 0) {
    data = mmap(nullptr, whole, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_POPULATE, fd.get(), 0);
    if (data == MAP_FAILED) code = errno;
  }
  const int seals = F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_SEAL | (writers == Writers::kOne ? F_SEAL_FUTURE_WRITE : 0);
  if (code == 0 && fcntl(fd.get(), F_ADD_SEALS, seals) != 0) code = errno;
  if (code != 0) {
    if (data != MAP_FAILED) munmap(data, whole);
    return cannotShare(whole, code);
  }
  (void)mlock(data, whole);  // a refusal was reported at the start of the run
  return std::unique_ptr<SealedMemory>(new SealedMemory(std::move(fd), static_cast<std::byte*>(data), whole));
}

SealedMemory::~SealedMemory() {
  munmap(data_, bytes_);
}

Result<Descriptor> SealedMemory::share() const {
  Descriptor copy(fcntl(fd_.get(), F_DUPFD_CLOEXEC, 0));
  if (!copy) return Error{std::string("cannot pass a descriptor on: ") + std::strerror(errno)};
  return copy;
}

}  // namespace hapticd

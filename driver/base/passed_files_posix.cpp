// SPDX-License-Identifier: MIT
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/vfs.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <utility>

#include "base/passed_files.hpp"
#include "base/regular_file.hpp"

namespace hapticd {

namespace {

/// Magic numbers of statfs(2): file systems that a program serves, and those where the kernel checks at each read who
/// reads.
constexpr long kFuse = 0x65735546, kProc = 0x9fa0, kSys = 0x62656572;

thread_local const PassedFiles* in_force = nullptr;

/// Returns whether a program or the kernel decides at each read what the reader gets.
bool answersReaders(int fd) {
  struct statfs where{};
  const long kind = fstatfs(fd, &where) == 0 ? static_cast<long>(where.f_type) : kFuse;
  return kind == kFuse || kind == kProc || kind == kSys;
}

bool writeAll(int fd, const char* bytes, size_t count) {
  for (size_t done = 0; done < count;) {
    const ssize_t now = write(fd, bytes + done, count - done);
    if (now < 0 && errno != EINTR) return false;
    if (now > 0) done += static_cast<size_t>(now);
  }
  return true;
}

/// Copies a file to memory that cannot be changed. @param room [bytes] how much may be used; the size of the copy is
/// subtracted
Result<Descriptor> copied(int from, size_t& room) {
  Descriptor copy(memfd_create("passed", MFD_CLOEXEC | MFD_ALLOW_SEALING));
  if (!copy) return Error{std::string("cannot be copied: ") + std::strerror(errno)};
  char part[65536];
  off_t at = 0;
  for (;;) {
    const ssize_t got = pread(from, part, sizeof part, at);  // does not move the sender's position in the file
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return Error{std::string("cannot be read: ") + std::strerror(errno)};
    if (got == 0) break;
    if (static_cast<size_t>(got) > room)
      return Error{"the files of the request are too large, expected at most " +
                   std::to_string(PassedFiles::kMostBytes >> 20) + " MiB together"};
    room -= static_cast<size_t>(got);
    at += got;
    if (!writeAll(copy.get(), part, static_cast<size_t>(got)))
      return Error{std::string("cannot be copied: ") + std::strerror(errno)};
  }
  fcntl(copy.get(), F_ADD_SEALS, F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_WRITE | F_SEAL_SEAL);
  return copy;
}

std::string pathTo(const Descriptor& file) {
  return "/proc/self/fd/" + std::to_string(file.get());
}

void replaceAll(std::string& text, const std::string& path, const std::string& name) {
  for (size_t at = 0; (at = text.find(path, at)) != std::string::npos;) {
    const size_t end = at + path.size();
    const bool longer = end < text.size() && text[end] >= '0' && text[end] <= '9';  // such as 12 in place of 1
    if (!longer) text.replace(at, path.size(), name);
    at += longer ? path.size() : name.size();
  }
}

}  // namespace

Result<PassedFiles> PassedFiles::copy(const std::vector<std::string>& names, std::vector<Descriptor> descriptors) {
  if (names.size() != descriptors.size())
    return Error{std::to_string(names.size()) + " files are named, but " + std::to_string(descriptors.size()) +
                 " descriptors came, expected one descriptor for each file"};
  PassedFiles files;
  size_t room = kMostBytes;
  for (size_t i = 0; i < names.size(); ++i) {
    const Descriptor given = std::move(descriptors[i]);
    struct stat info{};
    if (fstat(given.get(), &info) != 0) return Error{names[i] + ": cannot be read"};
    std::error_code ignored;
    const auto type = std::filesystem::status(pathTo(given), ignored).type();
    if (const std::string other = notAFile(type); !other.empty()) return Error{names[i] + ": " + other};
    if (answersReaders(given.get()))
      return Error{
          names[i] +
          ": the file is provided by a program or by the kernel (FUSE, proc), expected a copy of it on a disk"};
    auto copy = copied(given.get(), room);
    if (!copy) return Error{names[i] + ": " + copy.error()};
    if (!files.copies_.emplace(names[i], std::move(*copy)).second) return Error{names[i] + ": is named twice"};
  }
  return files;
}

std::string PassedFiles::pathOf(const std::string& file) const {
  const auto found = copies_.find(file);
  if (found != copies_.end()) return pathTo(found->second);
  return own_.count(file) > 0 ? file : "";
}

std::function<std::string(std::string)> PassedFiles::naming() const {
  std::vector<std::pair<std::string, std::string>> pairs;
  for (const auto& [name, copy] : copies_) pairs.emplace_back(pathTo(copy), name);
  return [pairs](std::string text) {
    for (const auto& [path, name] : pairs) replaceAll(text, path, name);
    return text;
  };
}

PassedFiles::Scope::Scope(const PassedFiles& files) noexcept : before_(std::exchange(in_force, &files)) {}

PassedFiles::Scope::~Scope() {
  in_force = before_;
}

Result<std::string> whereToOpen(const std::string& file) {
  if (in_force == nullptr) return file;
  std::string path = in_force->pathOf(file);
  if (path.empty()) return Error{kNotPassed};
  return path;
}

Result<Descriptor> openToPass(const std::string& file) {
  const auto fd = openRegular(file);
  if (!fd) return Error{fd.error()};
  Descriptor opened(*fd);
  if (!answersReaders(opened.get())) return opened;
  size_t room = PassedFiles::kMostBytes;
  return copied(opened.get(), room);
}

}  // namespace hapticd

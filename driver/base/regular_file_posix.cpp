// SPDX-License-Identifier: MIT
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "base/passed_files.hpp"
#include "base/regular_file.hpp"

namespace hapticd {

namespace {

Error cannotBeRead(int code) {
  return Error{code == ENOENT ? "there is no such file, expected the path of a file"
                              : std::string("cannot be read: ") + std::strerror(code)};
}

std::filesystem::file_type typeOf(mode_t mode) {
  using std::filesystem::file_type;
  if (S_ISREG(mode)) return file_type::regular;
  if (S_ISDIR(mode)) return file_type::directory;
  if (S_ISFIFO(mode)) return file_type::fifo;
  return S_ISSOCK(mode) ? file_type::socket : file_type::unknown;
}

/// Returns 0, or the errno of the failure.
int writeTo(const std::string& file, const std::string& text) {
  const int fd = open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NOCTTY, 0666);
  if (fd < 0) return errno;
  int code = 0;
  for (size_t done = 0; done < text.size() && code == 0;) {
    const ssize_t now = write(fd, text.data() + done, text.size() - done);
    if (now >= 0)
      done += static_cast<size_t>(now);
    else if (errno != EINTR)
      code = errno;
  }
  return close(fd) == 0 || code != 0 ? code : errno;
}

}  // namespace

std::string notAFile(std::filesystem::file_type type) {
  using std::filesystem::file_type;
  if (type == file_type::regular) return "";
  const char* what = type == file_type::directory ? "is a folder"
                     : type == file_type::fifo    ? "is a pipe"
                     : type == file_type::socket  ? "is a socket"
                                                  : "is a device";
  return std::string(what) + ", expected a file";
}

Result<int> openRegular(const std::string& name) {
  const auto where = whereToOpen(name);
  if (!where) return Error{where.error()};
  const std::string& file = *where;
  struct stat info{};
  if (stat(file.c_str(), &info) != 0) return cannotBeRead(errno);
  // Checked before the file is opened: opening a device may already have an effect, and opening a socket gives an error
  // that says less.
  if (std::string other = notAFile(typeOf(info.st_mode)); !other.empty()) return Error{std::move(other)};
  const int fd = open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
  if (fd < 0) return cannotBeRead(errno);
  std::string other = fstat(fd, &info) == 0 ? notAFile(typeOf(info.st_mode)) : "cannot be read";
  if (other.empty()) return fd;
  close(fd);
  return Error{std::move(other)};
}

Result<std::string> readRegular(const std::string& file, size_t max_bytes) {
  const auto fd = openRegular(file);
  if (!fd) return Error{fd.error()};
  std::string text;
  char part[16384];
  ssize_t got = 1;
  while (text.size() <= max_bytes && (got = read(*fd, part, sizeof part)) > 0)
    text.append(part, static_cast<size_t>(got));
  const int code = errno;
  close(*fd);
  if (got < 0) return cannotBeRead(code);
  if (text.size() > max_bytes)
    return Error{"is larger than " + std::to_string(max_bytes >> 20) + " MiB, the most that is read"};
  return text;
}

void removeIncomplete(const std::string& file) noexcept {
  struct stat info{};
  if (lstat(file.c_str(), &info) == 0 && S_ISREG(info.st_mode)) unlink(file.c_str());
}

Result<void> writeWhole(const std::string& file, const std::string& text) {
  struct stat info{};
  const bool special = lstat(file.c_str(), &info) == 0 && !S_ISREG(info.st_mode);
  const std::string part = special ? file : file + ".part";
  int code = writeTo(part, text);
  if (code == 0 && !special && std::rename(part.c_str(), file.c_str()) != 0) code = errno;
  if (code == 0) return {};
  if (!special) unlink(part.c_str());
  return Error{file + ": cannot be written: " + std::strerror(code)};
}

}  // namespace hapticd

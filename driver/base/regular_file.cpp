#include "base/regular_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace hapticd {

namespace {

Error cannotBeRead(int code) {
  return Error{code == ENOENT ? "there is no such file" : std::string("cannot be read: ") + std::strerror(code)};
}

}  // namespace

std::string notAFile(mode_t mode) {
  if (S_ISREG(mode)) return "";
  const char* what = S_ISDIR(mode)    ? "is a folder"
                     : S_ISFIFO(mode) ? "is a pipe"
                     : S_ISSOCK(mode) ? "is a socket"
                                      : "is a device";
  return std::string(what) + ", expected a file";
}

Result<int> openRegular(const std::string& file) {
  struct stat info {};
  if (stat(file.c_str(), &info) != 0) return cannotBeRead(errno);
  // known before it is opened: opening a device may already move something, and a socket has no better message
  if (std::string other = notAFile(info.st_mode); !other.empty()) return Error{std::move(other)};
  const int fd = open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
  if (fd < 0) return cannotBeRead(errno);
  std::string other = fstat(fd, &info) == 0 ? notAFile(info.st_mode) : "cannot be read";
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

}  // namespace hapticd

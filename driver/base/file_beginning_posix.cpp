// SPDX-License-Identifier: MIT
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "base/file_beginning.hpp"
#include "base/regular_file.hpp"

namespace hapticd {

Result<std::string> readBeginning(const std::string& file, size_t count) {
  const auto fd = openRegular(file);
  if (!fd) return Error{fd.error()};
  std::string bytes(count, '\0');
  size_t done = 0;
  ssize_t got = 1;
  while (done < count && ((got = read(*fd, bytes.data() + done, count - done)) > 0 || (got < 0 && errno == EINTR)))
    if (got > 0) done += static_cast<size_t>(got);
  const int code = errno;
  close(*fd);
  if (got < 0) return Error{std::string("cannot be read: ") + std::strerror(code)};
  bytes.resize(done);
  return bytes;
}

}  // namespace hapticd

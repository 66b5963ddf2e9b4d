// SPDX-License-Identifier: MIT
/// Builds text in signal handlers. Nothing here allocates memory.
#pragma once
#include <unistd.h>

#include <cstddef>
#include <cstdint>

namespace hapticd::watch {

constexpr size_t kLongestPath = 1024;

/// A text of limited length that is built without the buffers of the C library.
class Line {
 public:
  Line& add(const char* text) noexcept {
    for (; *text != '\0' && length_ + 1 < sizeof text_; ++text) text_[length_++] = *text;
    text_[length_] = '\0';
    return *this;
  }
  Line& addNumber(uint64_t number) noexcept {
    char digits[24] = "";
    size_t at = sizeof digits - 1;
    do digits[--at] = static_cast<char>('0' + number % 10);
    while ((number /= 10) > 0);
    return add(&digits[at]);
  }
  /// Adds a plugin's name as part of a file name. Characters such as / are replaced, so that the name cannot lead into
  /// another folder.
  Line& addName(const char* name) noexcept {
    for (; *name != '\0' && length_ + 1 < sizeof text_; ++name) {
      const bool plain = (*name >= 'a' && *name <= 'z') || (*name >= 'A' && *name <= 'Z') ||
                         (*name >= '0' && *name <= '9') || *name == '_' || *name == '-';
      text_[length_++] = plain ? *name : '_';
    }
    text_[length_] = '\0';
    return *this;
  }
  const char* text() const noexcept { return text_; }
  bool write(int fd) const noexcept { return ::write(fd, text_, length_) == static_cast<ssize_t>(length_); }

 private:
  char text_[3 * kLongestPath] = "";
  size_t length_ = 0;
};

}  // namespace hapticd::watch

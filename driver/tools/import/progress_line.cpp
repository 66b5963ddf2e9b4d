// SPDX-License-Identifier: MIT
#include "import/progress_line.hpp"

#include <unistd.h>

#include <cstdio>

namespace hapticd::importing {

ProgressLine::ProgressLine() : terminal_(isatty(STDERR_FILENO) == 1) {}

void ProgressLine::show(const std::string& what) {
  if (!terminal_) return;
  std::fprintf(stderr, "\r\033[K%s ...", what.c_str());
  drawn_ = true;
}

void ProgressLine::show(const std::string& what, std::size_t done, std::size_t all) {
  constexpr auto kEvery = std::chrono::milliseconds(100);
  if (!terminal_ || std::chrono::steady_clock::now() < shown_ + kEvery) return;
  shown_ = std::chrono::steady_clock::now();
  std::fprintf(stderr, "\r\033[K%s: %zu %%", what.c_str(), 100 * done / all);
  drawn_ = true;
}

void ProgressLine::clear() {
  if (drawn_) std::fprintf(stderr, "\r\033[K");
  drawn_ = false;
}

}  // namespace hapticd::importing

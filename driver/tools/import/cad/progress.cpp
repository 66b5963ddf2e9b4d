// SPDX-License-Identifier: MIT
#include "cad_import/progress.hpp"

#include <unistd.h>

#include <cstdio>

namespace hapticd::cad {

using Clock = std::chrono::steady_clock;

Progress::Progress(std::string what, double seconds)
    : what_(std::move(what)),
      end_(Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds))),
      limited_(seconds > 0),
      terminal_(isatty(STDERR_FILENO) == 1) {
  if (!terminal_) return;
  std::fprintf(stderr, "\r\033[K%s ...", what_.c_str());
  drawn_ = true;
}

Progress::~Progress() {
  if (drawn_) std::fprintf(stderr, "\r\033[K");
}

Standard_Boolean Progress::UserBreak() {
  if (limited_ && Clock::now() > end_) late_ = true;
  return late_;
}

void Progress::Show(const Message_ProgressScope&, const Standard_Boolean force) {
  constexpr auto kEvery = std::chrono::milliseconds(100);
  if (!terminal_ || (!force && Clock::now() < shown_ + kEvery)) return;
  shown_ = Clock::now();
  std::fprintf(stderr, "\r\033[K%s %.0f %%", what_.c_str(), 100 * GetPosition());
}

}  // namespace hapticd::cad

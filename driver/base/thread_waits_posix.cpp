// SPDX-License-Identifier: MIT
#include <sys/resource.h>

#include "base/thread_waits.hpp"

namespace hapticd::os {

long waitsOfThread() noexcept {
  rusage usage{};
  getrusage(RUSAGE_THREAD, &usage);
  return usage.ru_nvcsw;
}

}  // namespace hapticd::os

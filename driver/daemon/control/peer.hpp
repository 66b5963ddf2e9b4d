// SPDX-License-Identifier: MIT
/// Who asks over the control socket, and what goes back.
#pragma once
#include <sys/types.h>

#include <string>
#include <utility>

#include "base/clock.hpp"
#include "base/descriptors.hpp"

namespace hapticd::control {

/// Who sends a request. The number is never used again.
struct Peer {
  uint64_t id = 0;
  pid_t pid = 0;  ///< of the process that connected
  uid_t uid = 0;
  Nanoseconds asked = 0;  ///< CLOCK_MONOTONIC when the request's turn came
};

/// One line, without its end, and perhaps a descriptor that the client gets along with it.
struct Reply {
  Reply() = default;
  Reply(std::string text) : line(std::move(text)) {}  // NOLINT: implicit by intent
  Reply(std::string text, Descriptor attached) : line(std::move(text)), descriptor(std::move(attached)) {}
  std::string line;
  Descriptor descriptor;
};

/// Why a connection is kept, apart from its requests.
struct Standing {
  bool stays = false;    ///< something depends on it: it is never dropped for being silent
  bool listens = false;  ///< it gets news
};

}  // namespace hapticd::control

/// The other end of the control socket: `hapticd ctl` and tests.
#pragma once
#include <sys/un.h>

#include <string>

#include "base/result.hpp"

namespace hapticd::control {

/// [any] False: the path is too long for a socket.
bool socketAddress(const std::string& file, sockaddr_un& address);

/// [main] True if somebody serves the socket.
bool connectTo(const std::string& file);

/// [main] Sends one line and waits for its answer. @param seconds at most
Result<std::string> ask(const std::string& file, const std::string& line, double seconds = 10);

}  // namespace hapticd::control

// SPDX-License-Identifier: MIT
/// Which daemons run, as their files tell: NAME.lock is held by its daemon for as long as it lives, NAME.sock is there
/// while it serves. What died left both, and holds none.
#pragma once
#include <string>
#include <vector>

namespace hapticd::control {

/// [any] The daemon of this socket lives: it holds the lock on its name.
bool lives(const std::string& socket);

/// [main] Waits until the daemon of this socket has ended and its name is free. @return false if it still lives
bool waitForEnd(const std::string& socket, double seconds);

/// [main] After its connection ended: true if the daemon ended without removing its files. Waits for one that is about
/// to end in order.
bool wasKilled(const std::string& socket);

/// [main] Names of the daemons that live in a folder, sorted.
std::vector<std::string> running(const std::string& folder);

}  // namespace hapticd::control

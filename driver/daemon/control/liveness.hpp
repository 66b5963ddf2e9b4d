// SPDX-License-Identifier: MIT
/// Finds out which daemons run, by their files. A daemon holds a lock on NAME.lock as long as it lives, and NAME.sock
/// exists while it serves. A daemon that was killed leaves both files, but no lock.
#pragma once
#include <functional>
#include <string>
#include <vector>

namespace hapticd::control {

/// [any] True if the daemon of this socket lives, which means that it holds the lock on its name.
bool isAlive(const std::string& socket);

/// [main] Waits until the daemon of this socket has ended and its name is free. @return false if it still lives after
/// `seconds`
bool waitForEnd(const std::string& socket, double seconds);

/// [main] Waits until a daemon answers at a socket. @param socket returns its path, which may depend on folders that
/// the daemon makes @return false if none answers after `seconds`
bool waitForStart(const std::function<std::string()>& socket, double seconds);

/// [main] Called after the connection to a daemon has ended. True if the daemon ended without removing its files. If
/// the daemon is just ending normally, the call waits for its end.
bool wasKilled(const std::string& socket);

/// [main] Returns the names of the living daemons whose files are in a folder, sorted.
std::vector<std::string> runningDaemons(const std::string& folder);

/// [main] Returns which daemons run beside the one of this socket: "none runs in FOLDER", or "in FOLDER these run:
/// ...".
std::string othersText(const std::string& socket);

/// [any] Returns the command that starts a daemon with this socket, such as "hapticd run SCENE --name left".
std::string startText(const std::string& socket);

/// [main] Returns an error for the user: no daemon has this socket, which daemons run, and how to fix it.
std::string noDaemonText(const std::string& socket);

}  // namespace hapticd::control

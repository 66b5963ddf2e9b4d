// SPDX-License-Identifier: MIT
#include "control/liveness.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>

#include "base/happens_within.hpp"
#include "control/client.hpp"

namespace hapticd::control {

namespace {

namespace fs = std::filesystem;

bool fileExists(const std::string& file) {
  std::error_code unknown;
  return fs::exists(fs::symlink_status(file, unknown));
}

/// Calls `done` every 10 ms until it returns true. Returns false if the time ends first.
template <class Done>
bool within(double seconds, Done&& done) {
  constexpr Nanoseconds kPause = 10'000'000;
  return happensWithin(static_cast<Nanoseconds>(seconds * 1e9), kPause, done);
}

}  // namespace

bool isAlive(const std::string& socket) {
  const std::string lock = fs::path(socket).replace_extension(".lock").string();
  const int fd = open(lock.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW);
  // Another user's lock file cannot be opened. Then the socket decides: a daemon removes it at its end.
  if (fd < 0) return errno == EACCES && fileExists(socket);
  const bool held = flock(fd, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  close(fd);
  return held;
}

bool waitForEnd(const std::string& socket, double seconds) {
  return within(seconds, [&] { return !isAlive(socket); });
}

bool waitForStart(const std::function<std::string()>& socket, double seconds) {
  return within(seconds, [&] { return connectTo(socket()); });
}

bool wasKilled(const std::string& socket) {
  constexpr double kAboutToEnd = 2;  // [s]
  within(kAboutToEnd, [&] { return !fileExists(socket) || !isAlive(socket); });
  return fileExists(socket) && !isAlive(socket);
}

std::vector<std::string> runningDaemons(const std::string& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error))
    if (entry.path().extension() == ".sock" && isAlive(entry.path().string()))
      names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

std::string othersText(const std::string& socket) {
  const std::string folder = fs::path(socket).parent_path().string();
  std::string names;
  for (const std::string& name : runningDaemons(folder)) names += (names.empty() ? "" : ", ") + name;
  return names.empty() ? "none runs in " + folder : "in " + folder + " these run: " + names;
}

std::string startText(const std::string& socket) {
  const std::string name = fs::path(socket).stem().string();
  return "hapticd run SCENE" + (name == "hapticd" ? "" : " --name " + name);
}

std::string noDaemonText(const std::string& socket) {
  const fs::path file(socket);
  const bool others = !runningDaemons(file.parent_path().string()).empty();
  return "no daemon named " + file.stem().string() + " runs; " + othersText(socket) + "\n  fix: start it with " +
         startText(socket) + (others ? ", or name one of these with --name" : "");
}

}  // namespace hapticd::control

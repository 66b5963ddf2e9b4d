// SPDX-License-Identifier: MIT
#include "record/live_writer.hpp"

#include <sys/file.h>
#include <sys/stat.h>

#include <cerrno>
#include <fstream>
#include <sstream>
#include <string>

namespace hapticd::record {

namespace {

/// Finds the process that holds a lock on the file with this inode, in lines of /proc/locks such as "1: FLOCK ADVISORY
/// WRITE 4711 08:01:131073 0 EOF". Device numbers are not compared, because layered file systems give other numbers
/// there than fstat(). So if two locked files have this inode, it returns no process.
int holderOf(unsigned long long inode) {
  std::ifstream locks("/proc/locks");
  const std::string ending = ":" + std::to_string(inode);
  int holder = 0;
  for (std::string line; std::getline(locks, line);) {
    std::istringstream words(line);
    std::string number, kind, mode, access, place;
    int process = 0;
    if (!(words >> number >> kind >> mode >> access >> process >> place)) continue;
    if (kind != "FLOCK" || access != "WRITE" || !place.ends_with(ending)) continue;
    if (holder != 0 && holder != process) return 0;
    holder = process;
  }
  return holder > 0 ? holder : 0;
}

}  // namespace

std::optional<int> writerOf(int fd) {
  if (flock(fd, LOCK_SH | LOCK_NB) == 0) {
    flock(fd, LOCK_UN);
    return std::nullopt;
  }
  struct stat info{};
  if (errno != EWOULDBLOCK || fstat(fd, &info) != 0) return std::nullopt;
  return holderOf(info.st_ino);
}

}  // namespace hapticd::record

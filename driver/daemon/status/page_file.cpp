// SPDX-License-Identifier: MIT
#include "status/page_file.hpp"

#include <fcntl.h>
#include <linux/magic.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/vfs.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <new>

namespace hapticd::status {

namespace {

std::string variable(const char* name) {
  const char* value = std::getenv(name);
  return value != nullptr ? value : "";
}

/// Makes a folder to which only its owner may write. Returns false if a link or another user's folder has this name.
bool ownFolder(const std::string& folder) {
  mkdir(folder.c_str(), 0750);
  struct stat info{};
  return lstat(folder.c_str(), &info) == 0 && S_ISDIR(info.st_mode) && info.st_uid == geteuid() &&
         (info.st_mode & S_IWOTH) == 0;
}

/// True if a folder is in a memory file system. The servo writes into the status page, and on a disk each write-back by
/// the kernel causes a page fault in a tick, which may wait for the disk. The folder of a login session is in memory on
/// most machines, but not in every container.
bool inMemory(const std::string& folder) {
  struct statfs info{};
  return statfs(folder.c_str(), &info) == 0 && (info.f_type == TMPFS_MAGIC || info.f_type == RAMFS_MAGIC);
}

Error cannot(const std::string& what, const std::string& file, int code) {
  return Error{file + ": " + what + ": " + std::strerror(code)};
}

}  // namespace

std::string runtimeFolder(bool create) {
  const std::string system = variable("RUNTIME_DIRECTORY"), session = variable("XDG_RUNTIME_DIR");
  if (!system.empty()) return system;
  const std::string own = "/dev/shm/hapticd-" + std::to_string(geteuid());
  std::error_code error;
  if (!create) {
    for (const std::string& folder : {session.empty() ? own : session + "/hapticd", own})
      if (std::filesystem::is_directory(folder, error) && inMemory(folder)) return folder;
    return "/run/hapticd";
  }
  if (!session.empty() && inMemory(session) && ownFolder(session + "/hapticd")) return session + "/hapticd";
  return ownFolder(own) ? own : "";
}

std::string runtimeFolderOf(const std::string& daemon, const std::string& system) {
  const std::string own = runtimeFolder(false), socket = "/" + daemon + ".sock";
  std::error_code error;
  const bool only_there =
      !std::filesystem::exists(own + socket, error) && std::filesystem::exists(system + socket, error);
  return only_there ? system : own;
}

Result<std::unique_ptr<PageFile>> PageFile::create(const std::string& file) {
  std::unique_ptr<PageFile> owner(new PageFile);
  void* memory = MAP_FAILED;
  if (file.empty()) {
    memory = mmap(nullptr, sizeof(Page), PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  } else {
    unlink(file.c_str());
    const int fd = ::open(file.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, 0640);
    if (fd < 0) return cannot("cannot create the status page", file, errno);
    owner->file_ = file;
    const int full = posix_fallocate(fd, 0, sizeof(Page));
    if (full == 0) memory = mmap(nullptr, sizeof(Page), PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0);
    const int code = full != 0 ? full : errno;
    close(fd);
    if (memory == MAP_FAILED) return cannot("cannot create the status page", file, code);
  }
  if (memory == MAP_FAILED) return Error{"cannot create the status page: out of memory"};
  owner->page_ = new (memory) Page;
  owner->page_->bytes = sizeof(Page);
  owner->page_->pid = static_cast<uint32_t>(getpid());
  return owner;
}

Result<std::unique_ptr<PageFile>> PageFile::open(const std::string& file) {
  const int fd = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (fd < 0) return cannot("cannot read the status page", file, errno);
  struct stat info{};
  const bool whole = fstat(fd, &info) == 0 && info.st_size >= static_cast<off_t>(sizeof(Page));
  void* memory = whole ? mmap(nullptr, sizeof(Page), PROT_READ, MAP_SHARED, fd, 0) : MAP_FAILED;
  close(fd);
  if (memory == MAP_FAILED) return Error{file + ": is not a status page of this version"};
  std::unique_ptr<PageFile> reader(new PageFile);
  reader->page_ = static_cast<Page*>(memory);
  if (reader->page_->magic.load(std::memory_order_acquire) != kPageMagic || reader->page_->bytes != sizeof(Page))
    return Error{file + ": is not a status page of this version"};
  return reader;
}

PageFile::~PageFile() {
  if (page_ != nullptr) munmap(page_, sizeof(Page));
  if (!file_.empty()) unlink(file_.c_str());
}

}  // namespace hapticd::status

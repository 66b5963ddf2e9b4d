// SPDX-License-Identifier: MIT
/// The file of a status page, in a memory file system. The daemon that creates it writes it, and other processes map it
/// read-only.
#pragma once
#include <memory>
#include <string>

#include "base/result.hpp"
#include "status/page.hpp"

namespace hapticd::status {

/// Returns the folder of sockets and pages: $RUNTIME_DIRECTORY (set by systemd), else $XDG_RUNTIME_DIR/hapticd, else
/// /run/hapticd if the system's daemon runs there, else /dev/shm/hapticd-UID. @param create true: make it if necessary
std::string runtimeFolder(bool create);

/// Returns the folder that has the socket of a daemon of this name: runtimeFolder(), or the system's folder if the
/// socket is only there; runtimeFolder() if no daemon of this name runs.
std::string runtimeFolderOf(const std::string& daemon, const std::string& system = "/run/hapticd");

class PageFile {
 public:
  /// [main] Creates a page of zeros. @param file "": memory of this process only
  static Result<std::unique_ptr<PageFile>> create(const std::string& file);
  /// [main] Opens the page of a running daemon, read-only.
  static Result<std::unique_ptr<PageFile>> open(const std::string& file);
  ~PageFile();  ///< removes the file, if this object created it
  PageFile(const PageFile&) = delete;
  PageFile& operator=(const PageFile&) = delete;

  Page& page() { return *page_; }  ///< only after create()
  const Page& page() const { return *page_; }

 private:
  PageFile() = default;
  Page* page_ = nullptr;
  std::string file_;  ///< file to remove; "" if this object did not create one
};

}  // namespace hapticd::status

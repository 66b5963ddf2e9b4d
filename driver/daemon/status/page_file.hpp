// SPDX-License-Identifier: MIT
/// Where the page lives: a file in a memory file system that its owner writes and others map read-only.
#pragma once
#include <memory>
#include <string>

#include "base/result.hpp"
#include "status/page.hpp"

namespace hapticd::status {

/// The folder of sockets and pages: $RUNTIME_DIRECTORY (given by systemd), $XDG_RUNTIME_DIR/hapticd, /run/hapticd if
/// the system's daemon is there, or /dev/shm/hapticd-UID.
std::string runtimeFolder(bool create);

class PageFile {
 public:
  /// [main] A new page, zero. @param file "": memory of this process alone
  static Result<std::unique_ptr<PageFile>> create(const std::string& file);
  /// [main] The page of a running daemon, read-only.
  static Result<std::unique_ptr<PageFile>> open(const std::string& file);
  ~PageFile();  ///< the owner removes the file
  PageFile(const PageFile&) = delete;
  PageFile& operator=(const PageFile&) = delete;

  Page& page() { return *page_; }  ///< of a created one
  const Page& page() const { return *page_; }

 private:
  PageFile() = default;
  Page* page_ = nullptr;
  std::string file_;  ///< to be removed
};

}  // namespace hapticd::status

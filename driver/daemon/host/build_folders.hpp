// SPDX-License-Identifier: MIT
/// Folders that were fixed when the program was built.
#pragma once

namespace hapticd::host {

struct BuildFolders {
  const char* source;             ///< the checkout; it need not exist any more
  const char* library;            ///< name of the library folder below an installation, such as "lib/x86_64-linux-gnu"
  const char* installed_modules;  ///< where `make install` puts shape plugins and device modules
  const char* installed_data;     ///< where it puts scenes, device files and templates
};

/// [any] Returns these folders.
const BuildFolders& buildFolders() noexcept;

}  // namespace hapticd::host

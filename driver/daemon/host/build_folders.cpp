// SPDX-License-Identifier: MIT
// The only file whose flags have paths of the checkout: they would keep checkouts from sharing what a compiler made of
// others.
#include "host/build_folders.hpp"

namespace hapticd::host {

const BuildFolders& buildFolders() noexcept {
  static constexpr BuildFolders kFolders{HAPTICD_SOURCE_FOLDER, HAPTICD_INSTALL_LIBDIR, HAPTICD_INSTALL_MODULES,
                                         HAPTICD_INSTALL_DATA};
  return kFolders;
}

}  // namespace hapticd::host

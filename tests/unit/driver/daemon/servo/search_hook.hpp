// SPDX-License-Identifier: MIT
/// Lets a test look on while the proximity search runs: the test shape `searched` has this as an extension, and calls
/// it each time the search asks it for surfaces.
#pragma once

namespace hapticd {

constexpr const char* kSearchHook = "org.hapticd.test.search_hook/1";

struct SearchHook {
  void (*call)(void* with) = nullptr;  ///< nullptr: nobody looks on
  void* with = nullptr;
};

}  // namespace hapticd

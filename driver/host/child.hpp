/// Work that may crash or hang, done by a child process.
#pragma once
#include <functional>
#include <string>

#include "base/result.hpp"

namespace hapticd::host {

/// [main] Runs `work` in a fork of this process, which must have one thread only, and returns its bytes. The error says
/// how the child ended ("crashed: Segmentation fault", "took longer than 5 s") and is meant to follow "it ".
Result<std::string> runInChild(const std::function<std::string()>& work, int limit_ms);

}  // namespace hapticd::host

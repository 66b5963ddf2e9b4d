// SPDX-License-Identifier: MIT
/// Starts `hapticd-view`. It is a program of its own, so that the daemon has no network code.
#pragma once
#include <sys/types.h>

#include <string>
#include <vector>

#include "base/result.hpp"
#include "description/scene.hpp"

namespace hapticd::cli {

/// [main] Returns the path of hapticd-view, in this program's build tree or in the installation. An error says how to
/// get it.
Result<std::string> viewProgram();

/// [main] Starts hapticd-view in a process group of its own, so that Ctrl-C ends only the run, and the page can still
/// show that it has ended. Call it before this process takes real-time rights and locks its memory. @return its process
/// id
Result<pid_t> startView(const std::vector<std::string>& arguments);

/// [main] Replaces this process by hapticd-view; returns only if that fails.
Result<void> becomeView(const std::vector<std::string>& arguments);

/// [main] Lets a program lead the hand of every simulated arm instead of its script. The hand starts outside the
/// object, as far away as a script would begin.
void guideSimulatedHands(scene::Scene& scene);

}  // namespace hapticd::cli

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

/// [main] Starts hapticd-view in a process group of its own. So Ctrl-C ends only the run, and the page can still show
/// that the run has ended. Call it before this process gets real-time priority and locks its memory. @return the
/// process id of hapticd-view
Result<pid_t> startView(const std::vector<std::string>& arguments);

/// [main] Replaces this process by hapticd-view; returns only if that fails.
Result<void> becomeView(const std::vector<std::string>& arguments);

/// [main] Lets a program lead the hand of every simulated arm, in place of its script. The hand starts outside the
/// object, at the same distance as a script would.
void guideSimulatedHands(scene::Scene& scene);

}  // namespace hapticd::cli

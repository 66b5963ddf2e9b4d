// SPDX-License-Identifier: MIT
/// `hapticd-view` as others start it: a program of its own beside this one, so that the daemon has no network code.
#pragma once
#include <sys/types.h>

#include <string>
#include <vector>

#include "base/result.hpp"
#include "description/scene.hpp"

namespace hapticd::cli {

/// [main] The path of hapticd-view, in this program's build tree or in the installation. An error says how to get it.
Result<std::string> viewProgram();

/// [main] Starts it in a process group of its own, so that Ctrl-C ends the run and the page hears of it. Call it before
/// real-time rights and locked memory are taken. @return its process id
Result<pid_t> startView(const std::vector<std::string>& arguments);

/// [main] Replaces this process by hapticd-view; returns only if that fails.
Result<void> becomeView(const std::vector<std::string>& arguments);

/// [main] Lets a program lead the hand of every simulated arm in place of its script. The hand starts off the object,
/// as far away as a script would begin.
void guideSimulatedHands(scene::Scene& scene);

}  // namespace hapticd::cli

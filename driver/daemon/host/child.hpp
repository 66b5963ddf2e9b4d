// SPDX-License-Identifier: MIT
/// Work that may crash or hang, done by a child process.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "base/result.hpp"

namespace hapticd::host {

/// [main] Runs `work` in a fork of this process, which must have one thread only, and returns its bytes. The error says
/// how the child ended ("crashed: Segmentation fault", "took longer than 5 s") and is meant to follow "it ".
Result<std::string> runInChild(const std::function<std::string()>& work, int limit_ms);

/// [any] Starts a program that ends with answerParent() and returns its bytes, with the same errors. Nothing of this
/// process is copied, as a fork does it: that would cost each of its threads a page fault at the next write to a page.
/// @param arguments the program's path first
Result<std::string> runProgram(std::vector<std::string> arguments, int limit_ms);

/// [main] In such a program: what `work` returns goes to the parent, and the program ends.
[[noreturn]] void answerParent(const std::function<std::string()>& work);

}  // namespace hapticd::host

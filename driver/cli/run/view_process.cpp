// SPDX-License-Identifier: MIT
#include "cli/run/view_process.hpp"

#include <spawn.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <filesystem>

#include "cli/support/command.hpp"

extern char** environ;

namespace hapticd::cli {

namespace {

namespace fs = std::filesystem;

std::vector<char*> asArguments(std::vector<std::string>& words) {
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  return arguments;
}

/// Returns the value of a parameter, to be set; adds it if the file does not give it.
scene::Value* valueOf(scene::Device& device, const host::ClassInfo& info, const std::string& id) {
  const int index = info.indexOf(id);
  if (index < 0) return nullptr;
  const auto known = std::find_if(device.parameters.begin(), device.parameters.end(),
                                  [&](const scene::Value& value) { return value.id == id; });
  if (known != device.parameters.end()) return &*known;
  const host::ParamInfo& param = info.params[static_cast<size_t>(index)];
  scene::Value value;
  value.id = id;
  value.index = static_cast<uint32_t>(index);
  value.kind = param.kind;
  value.number = param.def;
  return &device.parameters.emplace_back(value);
}

}  // namespace

Result<std::string> viewProgram() {
  std::error_code error;
  for (const fs::path& folder : {host::executableDir() / ".." / "libexec" / "hapticd", fs::path(HAPTICD_LIBEXEC)})
    if (const fs::path file = (folder / "hapticd-view").lexically_normal(); fs::exists(file, error))
      return file.string();
  return Error{
      "hapticd-view is not installed, so the page cannot be shown\n  fix: build it (cmake --build build/release "
      "--target hapticd-view; it needs libboost-dev), or install the package hapticd"};
}

Result<pid_t> startView(const std::vector<std::string>& arguments) {
  auto program = viewProgram();
  if (!program) return Error{program.error()};
  std::vector<std::string> words{*program};
  words.insert(words.end(), arguments.begin(), arguments.end());
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t none;
  sigemptyset(&none);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setpgroup(&attributes, 0);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK);
  pid_t child = 0;
  const int failed = posix_spawn(&child, words[0].c_str(), nullptr, &attributes, asArguments(words).data(), environ);
  posix_spawnattr_destroy(&attributes);
  if (failed != 0) return Error{words[0] + ": cannot be started: " + std::strerror(failed)};
  return child;
}

Result<void> becomeView(const std::vector<std::string>& arguments) {
  auto program = viewProgram();
  if (!program) return Error{program.error()};
  std::vector<std::string> words{*program};
  words.insert(words.end(), arguments.begin(), arguments.end());
  execv(words[0].c_str(), asArguments(words).data());
  return Error{words[0] + ": cannot be started: " + std::strerror(errno)};
}

void guideSimulatedHands(scene::Scene& scene) {
  for (scene::Device& device : scene.devices) {
    const auto found = catalog().device(device.module);
    if (!found) continue;
    const host::ClassInfo& info = **found;
    const int index = info.indexOf("hand.script");
    if (index < 0) continue;
    const auto& choices = info.params[static_cast<size_t>(index)].choices;
    const auto guided = std::find(choices.begin(), choices.end(), "guided");
    if (guided == choices.end()) continue;
    valueOf(device, info, "hand.script")->number = static_cast<double>(guided - choices.begin());
    const scene::Value* approach = valueOf(device, info, "hand.approach");
    const double off = approach != nullptr ? approach->number : 0;
    if (scene::Value* radius = valueOf(device, info, "hand.radius")) radius->number += off;
  }
}

}  // namespace hapticd::cli

// SPDX-License-Identifier: MIT
#include "cli/import/cad.hpp"

#include <poll.h>
#include <spawn.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <vector>

#include "base/regular_file.hpp"
#include "base/short_number.hpp"
#include "cli/support/command.hpp"

extern char** environ;

namespace hapticd::cli {
namespace {

namespace fs = std::filesystem;

/// Returns the path of the importer, in this program's build tree or in the installation; "" if it is in neither.
std::string importer() {
  std::error_code error;
  for (const fs::path& folder : {host::executableDir() / ".." / "libexec" / "hapticd", fs::path(HAPTICD_LIBEXEC)})
    if (const fs::path file = (folder / "hapticd-import").lexically_normal(); fs::exists(file, error))
      return file.string();
  return "";
}

int failWithoutImporter(const std::string& file) {
  return fail(kBadInput,
              file +
                  ": CAD files are read by hapticd-import, which is not installed\n  fix: install the package "
                  "hapticd-import; or build it: install libocct-data-exchange-dev, configure anew, cmake --build "
                  "build/release --target hapticd-import\n  or export a mesh in a CAD program, then: hapticd import "
                  "PART.stl -o PART.hpart --scale 0.001");
}

std::string whole(double number) {
  return std::to_string(static_cast<long long>(number));
}

std::vector<std::string> wordsOf(const std::string& program, const CadImport& options) {
  std::vector<std::string> words{program, "--memory", whole(options.memory_mb), "--time", whole(options.time_s)};
  if (options.check) words.emplace_back("--check");
  if (options.json) words.emplace_back("--json");
  if (!options.check) words.insert(words.end(), {"--out", options.out});
  if (!options.named.empty()) words.insert(words.end(), {"--named", options.named});
  const importing::Placement& placement = options.placement;
  words.insert(words.end(), {"--scale", withDigits(placement.scale, 17), "--up", std::string(1, placement.up)});
  if (placement.fit > 0) words.insert(words.end(), {"--fit", withDigits(placement.fit, 17)});
  if (placement.center) words.emplace_back("--center");
  words.insert(words.end(), {"--", options.file});
  return words;
}

Result<pid_t> start(std::vector<std::string> words) {
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  pid_t child = 0;
  const int failed = posix_spawn(&child, arguments[0], nullptr, nullptr, arguments.data(), environ);
  if (failed != 0) return Error{words[0] + ": cannot be started: " + std::strerror(failed)};
  return child;
}

/// Waits for the child and ends it when its time is up. @return the status of the child. Sets `late` if the child was
/// ended
int wait(pid_t child, double seconds, bool& late) {
  // A direct system call, because the header of glibc 2.36 lacks extern "C".
  const int handle = static_cast<int>(syscall(SYS_pidfd_open, child, 0));
  pollfd ended{handle, POLLIN, 0};
  const int timeout_ms = static_cast<int>(std::min(1000 * seconds, 2e9));
  late = handle >= 0 && poll(&ended, 1, timeout_ms) == 0;
  if (late) kill(child, SIGKILL);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (handle >= 0) close(handle);
  return status;
}

}  // namespace

bool isCadFile(const std::string& file) {
  std::string ending = fs::path(file).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return std::tolower(c); });
  const char* const known[] = {".step", ".stp", ".iges", ".igs", ".brep", ".brp", ".rle"};
  return std::any_of(std::begin(known), std::end(known), [&](const char* one) { return ending == one; });
}

int importCad(const CadImport& options) {
  if (!options.check && fs::path(options.out).extension() != ".hpart")
    return fail(kBadInput, options.out + ": CAD files become a part, expected a name that ends in .hpart");
  const std::string program = importer();
  if (program.empty()) return failWithoutImporter(options.file);
  const auto readable = openRegular(options.file);
  if (!readable) return fail(kBadInput, options.file + ": " + readable.error());
  close(*readable);
  const auto child = start(wordsOf(program, options));
  if (!child) return fail(kFailed, child.error());
  bool late = false;
  const int status = wait(*child, options.time_s, late);
  if (late || (WIFSIGNALED(status) && (WTERMSIG(status) == SIGXCPU || WTERMSIG(status) == SIGKILL)))
    return fail(kBadInput, options.file + ": was not read within " + whole(options.time_s) +
                               " s, nothing was written\n  fix: for a large file, give more time: --time SECONDS");
  if (WIFSIGNALED(status))
    return fail(kBadInput,
                options.file + ": Open CASCADE crashed or was stopped while reading it (" +
                    strsignal(WTERMSIG(status)) +
                    "), nothing was written: the file or one of its shapes is damaged, or it needs more than " +
                    whole(options.memory_mb) +
                    " MB of memory\n  fix: open and save it in a CAD program, or allow more memory: "
                    "--memory MEGABYTES");
  return WEXITSTATUS(status);
}

}  // namespace hapticd::cli

// SPDX-License-Identifier: MIT
/// `hapticd client`: runs a program of OpenHaptics (HDAPI) on the arm of a running daemon.
#include "control/client.hpp"

#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "base/os.hpp"
#include "cli/support/command.hpp"
#include "status/page_file.hpp"

namespace hapticd::cli {

namespace {

namespace fs = std::filesystem;

struct ClientArguments {
  std::string name = "hapticd", scene;
  bool env = false;
};

/// Returns the folder of hapticd's own libHD.so.
Result<std::string> libraryFolder() {
  std::error_code error;
  const fs::path folder = (host::executableDir() / ".." / "lib" / "hapticd" / "hdapi").lexically_normal();
  if (fs::exists(folder / "libHD.so.3.4", error)) return folder.string();
  return Error{folder.string() +
               ": libHD.so.3.4 is not there, expected it beside this program\n  fix: cmake --build build/release "
               "--target hdapi, or install the package hapticd"};
}

std::string pathWith(const std::string& folder) {
  const char* others = std::getenv("LD_LIBRARY_PATH");
  return others != nullptr && *others != '\0' ? folder + ":" + others : folder;
}

/// Returns why the program cannot be started; "" if it can, as execvp() looks for it.
std::string whyNotStarted(const std::string& program) {
  const char* path = std::getenv("PATH");
  const bool placed = program.find('/') != std::string::npos;
  if (!placed && path == nullptr) return "";
  for (const std::string& folder : placed ? std::vector<std::string>{""} : command_line::split(path, ':')) {
    const fs::path file = fs::path(folder) / program;
    std::error_code error;
    if (access(file.c_str(), X_OK) == 0 && !fs::is_directory(file, error)) return "";
  }
  return program + ": there is no such program that you may start, expected " +
         (placed ? "the path of a program" : "a program in a folder of $PATH, or its path, such as ./" + program);
}

bool isRunning(const std::string& name) {
  const std::string file = "/" + name + ".sock";
  return control::connectTo(status::runtimeFolder(false) + file) || control::connectTo("/run/hapticd" + file);
}

volatile sig_atomic_t program = 0;  ///< process id of the program, for the signal handler

void passOn(int signal) {
  if (program > 0) kill(static_cast<pid_t>(program), signal);
}

/// Called in a child process. Makes the child end when `hapticd client` ends for any reason, even after the child has
/// called execve.
void endWith(pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (getppid() != parent) std::_Exit(kFailed);  // the parent has already ended
}

/// Called in the child, which becomes the program in `words`. If `silent`, its standard output is dropped.
[[noreturn]] void become(std::vector<std::string> words, bool silent) {
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  if (silent && std::freopen("/dev/null", "w", stdout) == nullptr) std::_Exit(kFailed);
  if (silent) setpgid(0, 0);  // Ctrl-C must reach only the program; the daemon ends after the program
  execvp(arguments[0], arguments.data());
  std::fprintf(stderr, "error: %s: cannot be started: %s\n", arguments[0], std::strerror(errno));
  std::_Exit(kBadInput);
}

pid_t start(const std::vector<std::string>& words, bool silent) {
  const pid_t parent = getpid(), child = fork();
  if (child == 0) endWith(parent), become(words, silent);
  return child;
}

int endOf(pid_t child) {
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  constexpr int kBySignal = 128;  // exit code of a program that a signal ended, as in shells
  return WIFEXITED(status) ? WEXITSTATUS(status) : kBySignal + WTERMSIG(status);
}

/// Starts a daemon and waits until it answers requests.
/// @param code receives the exit code if there is an error: for a bad scene that of `hapticd run`
Result<pid_t> startDaemon(const ClientArguments& options, int& code) {
  code = kFailed;
  constexpr int kTries = 600;
  constexpr useconds_t kPauseUs = 50'000;
  std::string scene = options.scene;
  if (scene.empty()) {
    const auto shipped = host::shippedFile("hdapi/simulated.yaml");
    if (!shipped)
      return Error{"no daemon runs as \"" + options.name + "\"\n  fix: hapticd run SCENE, or --scene SCENE"};
    scene = shipped->string();
  }
  std::fprintf(stderr, "no daemon runs as \"%s\": starting one for this program with %s\n", options.name.c_str(),
               scene.c_str());
  const pid_t child = start({(host::executableDir() / "hapticd").string(), "run", scene, "--name", options.name}, true);
  if (child < 0) return Error{std::string("the daemon cannot be started: ") + std::strerror(errno)};
  for (int i = 0; i < kTries; ++i) {
    if (isRunning(options.name)) return child;
    if (int status = 0; waitpid(child, &status, WNOHANG) == child) {
      if (WIFEXITED(status) && WEXITSTATUS(status) == kBadInput) code = kBadInput;
      return Error{"the daemon ended at once, for the reason above"};
    }
    usleep(kPauseUs);
  }
  kill(child, SIGTERM);
  endOf(child);
  return Error{
      "the daemon did not answer within 30 s\n  fix: start the daemon by itself (hapticd run) and read its messages"};
}

int runWithDaemon(const ClientArguments& options, const std::vector<std::string>& words) {
  int code = 0;
  const auto daemon = startDaemon(options, code);
  if (!daemon) return fail(code, daemon.error());
  os::onStopSignal(passOn);
  program = start(words, false);
  code = program > 0 ? endOf(static_cast<pid_t>(program)) : fail(kFailed, std::strerror(errno));
  kill(*daemon, SIGTERM);
  endOf(*daemon);
  return code;
}

int client(const ClientArguments& options, const std::vector<std::string>& words) {
  const auto folder = libraryFolder();
  if (!folder) return fail(kFailed, folder.error());
  const std::string path = pathWith(*folder);
  if (options.env) {
    std::printf("export LD_LIBRARY_PATH='%s'\nexport HAPTICD_NAME='%s'\n", path.c_str(), options.name.c_str());
    return kWorked;
  }
  if (words.empty()) return fail(kBadInput, "no program is named, expected: hapticd client PROGRAM [ARGUMENTS]");
  if (words.front().front() == '-')
    return fail(kBadInput, words.front() +
                               ": unknown option; expected --name, --scene or --env before PROGRAM (the options of "
                               "PROGRAM come after it)");
  if (const std::string wrong = whyNotStarted(words.front()); !wrong.empty()) return fail(kBadInput, wrong);
  setenv("LD_LIBRARY_PATH", path.c_str(), 1);
  setenv("HAPTICD_NAME", options.name.c_str(), 1);
  if (!isRunning(options.name)) return runWithDaemon(options, words);
  if (!options.scene.empty())
    return fail(kBadInput, "a daemon runs as \"" + options.name +
                               "\" already, so --scene would have no effect\n  fix: " +
                               "leave --scene out, or choose another --name");
  become(words, false);
}

}  // namespace

void addClient(const Command& app, int& exit_code) {
  auto options = std::make_shared<ClientArguments>();
  const Command command = app.addSubcommand("client", "Run an OpenHaptics (HDAPI) program on a daemon's arm.");
  command.addOption("--name", options->name, "name of the daemon, as given to `hapticd run --name`; default: hapticd");
  command.addOption("--scene", options->scene, "scene for the daemon that this command starts if none runs");
  command.addFlag("--env", options->env,
                  "print the environment variables that the program needs, as commands of a shell");
  command.takesForeignCommandLine();  // the options after PROGRAM belong to that program
  command.footer(
      "Form: hapticd client [OPTIONS] PROGRAM [ARGUMENTS]\n\n"
      "The program uses hapticd's libHD.so and connects to the daemon of --name. If no such daemon runs, this\n"
      "command starts one with the simulated arm. That daemon ends with the program, even if this command is\n"
      "killed. Options of this command stand before PROGRAM; its exit code is the program's.\n\n"
      "With real-time priority, the program's servo loop does not sleep from 100 us before each tick is due (at\n"
      "most a tenth of the period), but polls for the tick. HAPTICD_LISTEN in the environment sets this time [us],\n"
      "0 to 200.\n\n"
      "Examples:\n  hapticd client ./my_program --its-own option\n  eval \"$(hapticd client --env)\"");
  command.callback([command, options, &exit_code] { exit_code = client(*options, command.foreignCommandLine()); });
}

}  // namespace hapticd::cli

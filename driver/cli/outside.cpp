#include "cli/outside.hpp"

#include <unistd.h>

#include <cstdlib>
#include <filesystem>

#include "cli/command.hpp"
#include "control/client.hpp"
#include "status/page_file.hpp"

namespace hapticd::cli {

namespace {

constexpr uint32_t kSpareModels = 64;
constexpr const char* kGroup = "haptic";

std::string variable(const char* name) {
  const char* value = std::getenv(name);
  return value != nullptr ? value : "";
}

/// Where black boxes are kept: $STATE_DIRECTORY (given by systemd), else the user's own state folder.
std::string stateFolder() {
  if (std::string given = variable("STATE_DIRECTORY"); !given.empty()) return given;
  if (const std::string state = variable("XDG_STATE_HOME"); !state.empty()) return state + "/hapticd";
  if (const std::string home = variable("HOME"); !home.empty()) return home + "/.local/state/hapticd";
  return "/tmp/hapticd-" + std::to_string(geteuid());
}

/// A run that ended in order removes its black box: one that is still there was left by a crash.
void keepCrashed(const std::string& file, const std::string& name) {
  std::error_code error;
  if (!std::filesystem::exists(file, error)) return;
  std::filesystem::create_directories(stateFolder(), error);
  std::string kept;
  for (int i = 1; i < 1000; ++i) {
    kept = stateFolder() + "/blackbox-" + name + "-crash-" + std::to_string(i) + ".h5";
    if (!std::filesystem::exists(kept, error)) break;
  }
  if (std::filesystem::copy_file(file, kept, error))
    std::fprintf(stderr, "warning: the last run did not end in order; its last seconds are in %s\n", kept.c_str());
  std::filesystem::remove(file, error);
}

}  // namespace

Outside::Outside(const std::string& name, servo::RunOptions& how) : folder_(status::runtimeFolder(true)) {
  if (folder_.empty()) return;
  name_ = name.empty() ? "hapticd" : name;
  if (name.empty() && control::connectTo(folder_ + "/" + name_ + ".sock")) {
    name_ = "hapticd-" + std::to_string(getpid());
    std::fprintf(stderr, "another daemon runs as hapticd: this one is %s\n", name_.c_str());
  }
  how.status = folder_ + "/" + name_ + ".status";
  how.black_box = folder_ + "/" + name_ + ".blackbox.h5";
  how.spare_models = kSpareModels;
  keepCrashed(how.black_box, name_);
}

void Outside::serve(servo::Runner& runner, const std::string& device_file) {
  if (folder_.empty()) return;
  runner_ = &runner;
  // A fork would make every page of the servo's memory one that is copied at the next write: a page fault in a tick.
  catalog().describeBy([](const auto& file) { return host::describeByProgram("/proc/self/exe", file); });
  const auto load = [device_file](const std::string& file) -> Result<scene::Scene> {
    catalog().refresh();
    scene::Loaded loaded = scene::load(file, catalog(), {true, device_file});
    if (loaded.scene) return std::move(*loaded.scene);
    std::string text;
    for (const scene::Problem& problem : loaded.problems) text += (text.empty() ? "" : "\n") + problem.text();
    return Error{text};
  };
  steward_ = std::make_unique<servo::Steward>(runner, load, logToTerminal, stateFolder());
  auto server = control::Server::listen(folder_ + "/" + name_ + ".sock", kGroup);
  if (!server) {
    std::fprintf(stderr, "warning: %s\n", server.error().c_str());
    return;
  }
  server_ = std::move(*server);
  server_->start([this](const std::string& line) { return steward_->answer(line); });
}

bool Outside::faulty() const {
  for (const auto& arm : runner_->arms()) {
    const servo::Fault fault = arm->limiter().fault();
    if (fault != servo::Fault::kNone && fault != servo::Fault::kStopped) return true;
  }
  return false;
}

void Outside::look() {
  if (!steward_) return;
  const bool faulty_now = faulty();
  if (faulty_now && !dumped_)
    if (const auto file = steward_->dump("a fault"); !file) std::fprintf(stderr, "warning: %s\n", file.error().c_str());
  dumped_ = faulty_now;
}

void Outside::end() {
  if (runner_ == nullptr) return;
  look();
  server_.reset();
  steward_.reset();
  runner_->endBlackBox();
  runner_ = nullptr;
}

}  // namespace hapticd::cli

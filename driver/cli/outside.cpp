#include "cli/outside.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "cli/command.hpp"
#include "status/page_file.hpp"
#include "watch/quarantine.hpp"

namespace hapticd::cli {

namespace {

constexpr uint32_t kSpareModels = 64;
constexpr const char* kGroup = "haptic";

/// Where black boxes are kept: the state folder, or beside what the run shows.
std::string stateFolder(const std::string& runtime_folder) {
  const std::string folder = watch::stateFolder().string();
  return folder.empty() ? runtime_folder : folder;
}

/// A run that ended in order removes its black box: one that is still there was left by a crash.
void keepCrashed(const std::string& file, const std::string& name, const std::string& runtime_folder) {
  std::error_code error;
  if (!std::filesystem::exists(file, error)) return;
  const std::string folder = stateFolder(runtime_folder);
  std::filesystem::create_directories(folder, error);
  std::string kept;
  for (int i = 1; i < 1000; ++i) {
    kept = folder + "/blackbox-" + name + "-crash-" + std::to_string(i) + ".h5";
    if (!std::filesystem::exists(kept, error)) break;
  }
  if (std::filesystem::copy_file(file, kept, error))
    std::fprintf(stderr, "warning: the last run did not end in order; its last seconds are in %s\n", kept.c_str());
  std::filesystem::remove(file, error);
}

}  // namespace

/// @return false: a run that lives has it. The lock file goes with its holder, so one that was locked after it went is
/// not the one that others see, and is taken anew.
Result<bool> Outside::take(const std::string& name) {
  lock_file_ = folder_ + "/" + name + ".lock";
  for (;;) {
    lock_ = ::open(lock_file_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0600);
    const bool locked = lock_ >= 0 && flock(lock_, LOCK_EX | LOCK_NB) == 0;
    const int code = errno;
    struct stat mine {
    }, seen{};
    if (locked && fstat(lock_, &mine) == 0 && stat(lock_file_.c_str(), &seen) == 0 && mine.st_ino == seen.st_ino) {
      name_ = name;
      return true;
    }
    if (lock_ >= 0) close(lock_);
    lock_ = -1;
    if (!locked && code == EWOULDBLOCK) return false;
    if (!locked) return Error{lock_file_ + ": cannot be written: " + std::strerror(code)};
  }
}

Result<std::unique_ptr<Outside>> Outside::open(const std::string& name, servo::RunOptions& how) {
  std::unique_ptr<Outside> outside(new Outside);
  outside->folder_ = status::runtimeFolder(true);
  if (outside->folder_.empty()) {
    std::fprintf(
        stderr,
        "warning: /dev/shm/hapticd-%u is not a folder of yours: this run can be neither watched nor changed from "
        "outside, and a crash leaves no black box\n  fix: remove it, or export RUNTIME_DIRECTORY, a folder in "
        "memory that only you may write to\n",
        geteuid());
    return outside;
  }
  auto taken = outside->take(name.empty() ? "hapticd" : name);
  if (taken && !*taken && !name.empty())
    return Error{"--name " + name + ": another daemon runs as " + name + ", expected a name of its own"};
  if (taken && !*taken) {
    taken = outside->take("hapticd-" + std::to_string(getpid()));
    std::fprintf(stderr, "another daemon runs as hapticd: this one is %s\n", outside->name_.c_str());
  }
  if (!taken) return Error{taken.error()};
  const std::string base = outside->folder_ + "/" + outside->name_;
  how.status = base + ".status";
  how.black_box = base + ".blackbox.h5";
  how.spare_models = kSpareModels;
  keepCrashed(how.black_box, outside->name_, outside->folder_);
  return outside;
}

Outside::~Outside() {
  end();
  if (lock_ < 0) return;
  unlink(lock_file_.c_str());
  close(lock_);
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
  steward_ = std::make_unique<servo::Steward>(runner, load, logToTerminal, stateFolder(folder_));
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

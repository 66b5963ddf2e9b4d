// SPDX-License-Identifier: MIT
#include "session/requests/run_files.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <vector>

#include "base/clock.hpp"
#include "document/suggestion.hpp"
#include "log/log.hpp"
#include "scene/load.hpp"
#include "status/page_file.hpp"
#include "watch/quarantine.hpp"

namespace hapticd::servo {

namespace {

constexpr uint32_t kSpareModels = 64;
constexpr const char* kGroup = "haptic";
constexpr const char* kDefaultName = "hapticd";

/// Returns the folder for black boxes: the state folder, or that of the run's own files.
std::string stateFolder(const std::string& runtime_folder) {
  const std::string folder = watch::stateFolder().string();
  return folder.empty() ? runtime_folder : folder;
}

/// Saves a black box that a crash left. A run that ends in order removes its black box.
void keepCrashed(const std::string& file, const std::string& name, const std::string& runtime_folder,
                 const std::string& run = "the last run") {
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
    log::write(HSP_LOG_WARNING, "", run + " was killed or crashed; its last seconds are in " + kept);
  std::filesystem::remove(file, error);
}

/// True for a name such as "hapticd-123", which a run gets if "hapticd" is in use. No other run will use it again.
bool isAutomatic(const std::string& name) {
  const std::string begin = std::string(kDefaultName) + "-";
  return name.size() > begin.size() && name.compare(0, begin.size(), begin) == 0 &&
         name.find_first_not_of("0123456789", begin.size()) == std::string::npos;
}

/// Removes the files of killed runs with automatic names, and saves their black boxes.
void clearDead(const std::string& folder) {
  namespace fs = std::filesystem;
  std::error_code error;
  std::vector<fs::path> locks;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error))
    if (entry.path().extension() == ".lock" && isAutomatic(entry.path().stem().string())) locks.push_back(entry.path());
  for (const fs::path& lock : locks) {
    const int fd = ::open(lock.c_str(), O_RDWR | O_CLOEXEC | O_NOFOLLOW);
    if (fd < 0) continue;
    if (flock(fd, LOCK_EX | LOCK_NB) == 0) {  // no living run has this name
      const std::string name = lock.stem().string(), base = folder + "/" + name;
      keepCrashed(base + ".blackbox.h5", name, folder, "the run " + name);
      for (const char* ending : {".status", ".sock", ".lock"}) unlink((base + ending).c_str());
    }
    close(fd);
  }
}

/// Describes a scene, such as "models teapot, floor on simulated Premium 1.5; programs may push (clients: add)".
std::string contents(const scene::Scene& scene) {
  std::vector<std::string> models, devices;
  for (const scene::Model& model : scene.models) models.push_back(model.name + (model.enabled ? "" : " (disabled)"));
  for (const scene::Device& device : scene.devices) devices.push_back(device.name);
  std::string text = models.empty() ? "no model" : models.size() == 1 ? "model " : "models ";
  text += document::listed(models, 6) + " on " + document::listed(devices) + "; ";
  switch (scene.clients.mode) {
    case scene::ClientMode::kOff:
      return text + "no program may push (clients: off)";
    case scene::ClientMode::kAdd:
      return text + "programs may push (clients: add)";
    default:
      return text + "programs may push (clients: instead)";
  }
}

}  // namespace

/// Takes a name for this run. @return false if a living run has it. A run that ends removes its lock file: if the file
/// was removed before it was locked, other runs see another file, so it is opened and locked again.
Result<bool> RunFiles::take(const std::string& name) {
  lock_file_ = folder_ + "/" + name + ".lock";
  for (;;) {
    lock_ = ::open(lock_file_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0600);
    const bool locked = lock_ >= 0 && flock(lock_, LOCK_EX | LOCK_NB) == 0;
    const int code = errno;
    struct stat mine{}, seen{};
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

/// Like take(), but waits for a run that is about to end: such a run no longer serves its socket, but keeps its name
/// until its report is written.
Result<bool> RunFiles::takeOrWait(const std::string& name) {
  constexpr Nanoseconds kPatience = 1'000'000'000, kPause = 10'000'000;
  const std::string socket = folder_ + "/" + name + ".sock";
  RealClock clock(0);
  const Nanoseconds end = clock.now() + kPatience;
  for (;;) {
    auto taken = take(name);
    std::error_code unknown;
    if (!taken || *taken || clock.now() > end || std::filesystem::exists(socket, unknown)) return taken;
    clock.waitUntil(clock.now() + kPause);
  }
}

Result<std::unique_ptr<RunFiles>> RunFiles::open(const std::string& name, RunOptions& how) {
  std::unique_ptr<RunFiles> outside(new RunFiles);
  outside->folder_ = status::runtimeFolder(true);
  if (outside->folder_.empty()) {
    log::write(HSP_LOG_WARNING, "",
               "the folder /dev/shm/hapticd-" + std::to_string(geteuid()) +
                   " does not belong to you: no other program can watch or change this run, and a crash leaves no "
                   "black box\n"
                   "  fix: remove it, or set RUNTIME_DIRECTORY to a folder in memory that only you may write to");
    return outside;
  }
  clearDead(outside->folder_);
  auto taken = outside->takeOrWait(name.empty() ? kDefaultName : name);
  if (taken && !*taken && !name.empty())
    return Error{"--name " + name + ": another daemon has the name " + name + "; expected another name"};
  if (taken && !*taken) {
    taken = outside->take(kDefaultName + ("-" + std::to_string(getpid())));
    log::write(HSP_LOG_WARNING, "",
               "another daemon runs as hapticd; this one has the name " + outside->name_ +
                   "\n  programs find it only by this name: hapticd ctl --name " + outside->name_);
  }
  if (!taken) return Error{taken.error()};
  const std::string base = outside->folder_ + "/" + outside->name_;
  how.status = base + ".status";
  how.black_box = base + ".blackbox.h5";
  how.spare_models = kSpareModels;
  keepCrashed(how.black_box, outside->name_, outside->folder_);
  return outside;
}

RunFiles::~RunFiles() {
  const bool began = runner_ != nullptr || ended_;
  try {
    end();
  } catch (...) {  // without memory, the black box may stay behind; the name must not
    ended_ = true;
  }
  if (lock_ < 0) return;
  // Removes files that the set-up made for a run that was then refused.
  if (!began)
    for (const char* ending : {".blackbox.h5", ".status"}) unlink((folder_ + "/" + name_ + ending).c_str());
  unlink(lock_file_.c_str());
  close(lock_);
}

void RunFiles::serve(Runner& runner, const RequestHandler::LoadScene& load, host::Catalog& catalog,
                     RequestHandler::Advise advise, const host::Services::Log& log) {
  if (folder_.empty()) return;
  runner_ = &runner;
  // Plugins are described in another program: after a fork, every first write to a page of the servo's memory would be
  // a page fault in a tick.
  catalog.describeBy([](const auto& file) { return host::describeByProgram("/proc/self/exe", file); });
  handler_ = std::make_unique<RequestHandler>(runner, load, log, stateFolder(folder_));
  handler_->adviseBy(std::move(advise));
  const std::string socket = folder_ + "/" + name_ + ".sock";
  handler_->knownAs(name_, socket);
  auto server = control::Server::listen(socket, kGroup);
  if (!server) {
    log::write(HSP_LOG_WARNING, "", server.error());
    return;
  }
  server_ = std::move(*server);
  control::Server::Service service;
  service.answer = [this](const control::Peer& peer, const std::string& line, std::vector<Descriptor> files) {
    return handler_->answer(peer, line, std::move(files));
  };
  service.keep_alive = [this](const control::Peer& peer) { return handler_->keepAlive(peer); };
  service.news = [this](const control::Peer& peer) { return handler_->news(peer); };
  service.urgent = [this](const control::Peer& peer, const std::string& line) { return handler_->urgent(peer, line); };
  service.left = [this](const control::Peer& peer) { handler_->left(peer); };
  if (const std::error_code code = server_->start(std::move(service))) {
    server_.reset();
    log::write(HSP_LOG_WARNING, "", socket + ": cannot be served, so nothing can watch this run: " + code.message());
    return;
  }
  log::write(HSP_LOG_INFO, "", "runs as " + name_ + ": " + contents(runner.scene()) + "; socket " + socket);
}

bool RunFiles::faulty() const {
  for (const auto& arm : runner_->arms()) {
    const Fault fault = arm->limiter().fault();
    if (fault != Fault::kNone && fault != Fault::kStopped) return true;
  }
  return false;
}

void RunFiles::look() {
  if (!handler_) return;
  const bool faulty_now = faulty();
  if (faulty_now && !dumped_)
    if (const auto file = handler_->dump("a fault"); !file) log::write(HSP_LOG_WARNING, "", file.error());
  dumped_ = faulty_now;
}

void RunFiles::end() {
  if (runner_ == nullptr) return;
  look();
  runner_->noteEnd();  // before the socket closes, so that a program that sees its connection end knows why
  server_.reset();
  handler_.reset();
  runner_->endBlackBox();
  runner_ = nullptr;
  ended_ = true;
}

}  // namespace hapticd::servo

// SPDX-License-Identifier: MIT
#include "base/code_owner.hpp"

#include <array>
#include <mutex>
#include <string>
#include <unordered_map>

namespace hapticd {

namespace {

thread_local bool t_works = false;

/// For each worker, a pointer to the variable that names the owner of the code that the worker runs; nullptr if no
/// thread is this worker.
std::atomic<std::atomic<const Owner*>*> workers[kWorkerCount];

struct Code {
  std::atomic<const void*> begin{nullptr}, end{nullptr};
  std::atomic<const Owner*> owner{nullptr};
};
constexpr size_t kMostLibraries = 256;  // libraries that are loaded later have no known owner
std::array<Code, kMostLibraries> libraries;
std::atomic<size_t> library_count{0};

Code* libraryAt(const void* address) noexcept {
  for (size_t i = 0; i < library_count.load(); ++i)
    if (address >= libraries[i].begin.load() && address < libraries[i].end.load()) return &libraries[i];
  return nullptr;
}

}  // namespace

const Owner* ownerOf(const std::string& module, const std::string& name, bool device) {
  static std::mutex mutex;
  // The map is never destroyed, because signal handlers may read an owner until the process ends. A key consists of
  // module, name and kind.
  static auto& known = *new std::unordered_map<std::string, Owner>;
  const std::lock_guard lock(mutex);
  const std::string key = module + '\0' + name + '\0' + (device ? 'd' : 's');
  return &known.try_emplace(key, Owner{module, name, device}).first->second;
}

WorkerScope::WorkerScope(Worker worker) noexcept : worker_(worker) {
  t_works = true;
  workers[static_cast<int>(worker)].store(&detail::t_called);
}

WorkerScope::~WorkerScope() {
  t_works = false;
  workers[static_cast<int>(worker_)].store(nullptr);
}

const Owner* ownerOfWorker(Worker worker) noexcept {
  const std::atomic<const Owner*>* called = workers[static_cast<int>(worker)].load();
  return called != nullptr ? called->load(std::memory_order_relaxed) : nullptr;
}

bool isWorker() noexcept {
  return t_works;
}

void registerCode(const void* begin, const void* end) {
  static std::mutex mutex;
  const std::lock_guard lock(mutex);
  const size_t count = library_count.load();
  if (count == libraries.size() || libraryAt(begin) != nullptr) return;
  libraries[count].begin.store(begin);
  libraries[count].end.store(end);
  library_count.store(count + 1);
}

void setCodeOwner(const void* address, const Owner* owner) {
  if (Code* found = libraryAt(address)) found->owner.store(owner);
}

const Owner* ownerOfCode(const void* address) noexcept {
  const Code* found = libraryAt(address);
  return found != nullptr ? found->owner.load() : nullptr;
}

}  // namespace hapticd

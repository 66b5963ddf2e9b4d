// SPDX-License-Identifier: MIT
#include "base/owner_file.hpp"

#include <atomic>
#include <mutex>
#include <unordered_map>

namespace hapticd {

namespace {

/// An entry of a linked list. The list only grows, at its head, and is never destroyed, because signal handlers may
/// read it at any moment.
struct FileOfOwner {
  const Owner* owner;
  std::string identity;
  bool foreign;
  const FileOfOwner* next;
};
std::atomic<const FileOfOwner*> newest_file{nullptr};

/// Tells whether a later entry of the same module replaces this entry.
bool isRepeated(const FileOfOwner* entry) noexcept {
  for (const FileOfOwner* later = newest_file.load(); later != entry; later = later->next)
    if (later->foreign && later->owner->module == entry->owner->module) return true;
  return false;
}

}  // namespace

void setFileOfOwner(const Owner* owner, const std::string& identity, bool foreign) {
  static std::mutex mutex;
  static auto& last = *new std::unordered_map<const Owner*, const FileOfOwner*>;  // newest entry of each owner
  const std::lock_guard lock(mutex);
  const FileOfOwner*& kept = last[owner];
  if ((kept != nullptr ? kept->identity : "") == identity) return;
  kept = new FileOfOwner{owner, identity, foreign, newest_file.load()};
  newest_file.store(kept);
}

const char* fileOf(const Owner* owner) noexcept {
  for (const FileOfOwner* entry = newest_file.load(); entry != nullptr; entry = entry->next)
    if (entry->owner == owner) return entry->identity.c_str();
  return "";
}

const Owner* foreignOwner(size_t number) noexcept {
  for (const FileOfOwner* entry = newest_file.load(); entry != nullptr; entry = entry->next)
    if (entry->foreign && !isRepeated(entry) && number-- == 0) return entry->owner;
  return nullptr;
}

}  // namespace hapticd

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
  OwnersFile file;
  const FileOfOwner* next;
};
std::atomic<const FileOfOwner*> newest_file{nullptr};

/// Returns whether a later entry of the same module replaces this entry.
bool isRepeated(const FileOfOwner* entry) noexcept {
  for (const FileOfOwner* later = newest_file.load(); later != entry; later = later->next)
    if (later->file.foreign && later->owner->module == entry->owner->module) return true;
  return false;
}

/// Returns the newest entry of an owner; nullptr if there is none.
const FileOfOwner* entryOf(const Owner* owner) noexcept {
  const FileOfOwner* entry = newest_file.load();
  while (entry != nullptr && entry->owner != owner) entry = entry->next;
  return entry;
}

}  // namespace

void setFileOfOwner(const Owner* owner, const OwnersFile& file) {
  static std::mutex mutex;
  static auto& last = *new std::unordered_map<const Owner*, const FileOfOwner*>;  // newest entry of each owner
  const std::lock_guard lock(mutex);
  const FileOfOwner*& kept = last[owner];
  if ((kept != nullptr ? kept->file.identity : "") == file.identity) return;
  kept = new FileOfOwner{owner, file, newest_file.load()};
  newest_file.store(kept);
}

const char* pathOf(const Owner* owner) noexcept {
  const FileOfOwner* entry = entryOf(owner);
  return entry != nullptr ? entry->file.path.c_str() : "";
}

const char* fileOf(const Owner* owner) noexcept {
  const FileOfOwner* entry = entryOf(owner);
  return entry != nullptr ? entry->file.identity.c_str() : "";
}

const Owner* foreignOwner(size_t number) noexcept {
  for (const FileOfOwner* entry = newest_file.load(); entry != nullptr; entry = entry->next)
    if (entry->file.foreign && !isRepeated(entry) && number-- == 0) return entry->owner;
  return nullptr;
}

}  // namespace hapticd

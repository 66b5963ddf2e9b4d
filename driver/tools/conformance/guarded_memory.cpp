// SPDX-License-Identifier: MIT
#include "conformance/guarded_memory.hpp"

#include <sys/mman.h>

#include <algorithm>

#include "base/allocation_count.hpp"

namespace hapticd::conformance {
namespace {

constexpr size_t kPage = 4096;
constexpr size_t kPages = size_t{1} << 18;  ///< 1 GiB of addresses, of which only the blocks have memory
constexpr size_t kMostBlocks = 20'000;  ///< [blocks] each takes two of the 65,530 mappings that Linux allows a process
constexpr size_t kMostUsed = size_t{1} << 16;  ///< [pages] 256 MiB

/// The block that begins on a page.
struct Page {
  size_t size;  ///< [bytes] size of the block; 0 if none begins here
  size_t room;  ///< [bytes] from the beginning of the block to the unreadable page
  bool freed;
};

char* arena = nullptr;
Page* pages = nullptr;
size_t next_page = 0, used_pages = 0, blocks = 0;

size_t pageOf(const void* address) {
  return static_cast<size_t>(static_cast<const char*>(address) - arena) / kPage;
}

void* take(size_t size, size_t alignment) {
  const size_t step = std::max(alignment, alignof(max_align_t)), asked = std::max<size_t>(size, 1);
  if (step > kPage || asked > kMostUsed * kPage || blocks == kMostBlocks) return nullptr;
  const size_t room = (asked + step - 1) / step * step, count = (room + kPage - 1) / kPage;
  if (used_pages + count > kMostUsed || next_page + count + 1 > kPages) return nullptr;
  char* first = arena + next_page * kPage;
  if (mprotect(first, count * kPage, PROT_READ | PROT_WRITE) != 0) return nullptr;
  pages[next_page] = {asked, room, false};
  next_page += count + 1;
  used_pages += count;
  ++blocks;
  return first + count * kPage - room;
}

size_t sizeOf(const void* block) {
  return pages[pageOf(block)].size;
}

/// Frees a block. Its addresses are never used again, so that code which still uses them is found.
void giveBack(void* block) {
  Page& page = pages[pageOf(block)];
  const size_t count = (page.size + kPage - 1) / kPage;
  char* first = arena + pageOf(block) * kPage;
  madvise(first, count * kPage, MADV_DONTNEED);
  mprotect(first, count * kPage, PROT_NONE);
  used_pages -= std::min(used_pages, count);
  page.freed = true;
}

template <class T>
T* reserve(size_t bytes, int protection) {
  void* at = mmap(nullptr, bytes, protection, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  return at == MAP_FAILED ? nullptr : static_cast<T*>(at);
}

}  // namespace

GuardedMemory::GuardedMemory() noexcept : works_(false) {
  static OtherAllocator allocator{};
  if (arena == nullptr) {
    pages = reserve<Page>(kPages * sizeof(Page), PROT_READ | PROT_WRITE);
    arena = pages != nullptr ? reserve<char>(kPages * kPage, PROT_NONE) : nullptr;
    allocator = {arena, arena + kPages * kPage, &take, &giveBack, &sizeOf};
  }
  works_ = arena != nullptr && allocateFrom(&allocator);
}

GuardedMemory::~GuardedMemory() {
  allocateFrom(nullptr);
}

Overrun overrunAt(const void* address) noexcept {
  const auto* at = static_cast<const char*>(address);
  if (arena == nullptr || at < arena || at >= arena + kPages * kPage) return {};
  for (size_t i = pageOf(address) + 1; i-- > 0;) {
    if (pages[i].size == 0) continue;
    const size_t count = (pages[i].room + kPage - 1) / kPage;
    const char* begin = arena + (i + count) * kPage - pages[i].room;
    return {pages[i].size, at < begin ? 0 : static_cast<size_t>(at - begin), pages[i].freed};
  }
  return {};
}

}  // namespace hapticd::conformance

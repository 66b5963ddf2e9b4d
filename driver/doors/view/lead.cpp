// SPDX-License-Identifier: MIT
#include "lead.hpp"

#include <sys/mman.h>
#include <sys/stat.h>

#include <atomic>
#include <cstring>

namespace hapticd::view {

namespace {

/// Maps the daemon's memory. Returns nullptr if the file is too short, because a record beyond its end would kill this
/// process.
hapticd_lead_page* mapLead(int fd) {
  struct stat info{};
  if (fd < 0 || fstat(fd, &info) != 0 || info.st_size < static_cast<off_t>(sizeof(hapticd_lead_page))) return nullptr;
  void* memory = mmap(nullptr, HAPTICD_LEAD_BYTES, PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0);
  return memory == MAP_FAILED ? nullptr : static_cast<hapticd_lead_page*>(memory);
}

}  // namespace

std::unique_ptr<Lead> Lead::ask(boost::asio::io_context& io, const std::string& socket, const Json& request,
                                Taken taken) {
  std::unique_ptr<Lead> lead(new Lead);
  lead->daemon_ = Daemon::at(io, socket);
  lead->daemon_->connect();
  lead->daemon_->ask(request, [self = lead.get(), taken](const Json& answer, const Descriptor& memory) {
    if (answer.value("ok", false)) self->page_ = mapLead(memory.get());
    self->refused_ = self->page_ == nullptr;
    const bool failed = answer.value("ok", false) && self->page_ == nullptr;
    taken(failed ? Json({{"ok", false}, {"error", "the daemon gave no memory for the lead"}}) : answer);
  });
  return lead;
}

Lead::~Lead() {
  daemon_.reset();  // destroyed first, because a pending answer could still set `page_`
  if (page_ != nullptr) munmap(page_, HAPTICD_LEAD_BYTES);
}

bool Lead::put(std::span<const std::byte> record) {
  constexpr size_t kWords = sizeof(hapticd_target) / sizeof(uint64_t);
  if (page_ == nullptr || record.size() != sizeof(hapticd_target)) return false;
  std::atomic_ref<uint64_t> count(page_->count);
  const uint64_t even = (count.load(std::memory_order_relaxed) + 1) & ~uint64_t{1};
  count.store(even + 1, std::memory_order_relaxed);
  for (size_t i = 0; i < kWords; ++i) {
    uint64_t word = 0;
    std::memcpy(&word, record.data() + i * sizeof word, sizeof word);
    std::atomic_ref<uint64_t>(page_->words[i]).store(word, std::memory_order_release);
  }
  count.store(even + 2, std::memory_order_release);
  return true;
}

}  // namespace hapticd::view

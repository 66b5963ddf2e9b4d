// SPDX-License-Identifier: MIT
#include "host/services.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <new>

namespace hapticd::host {
namespace {

constexpr size_t kCacheLine = 64;  ///< [bytes] alignment, so that blocks of two instances never share a cache line
constexpr size_t kLargestAlign = 1 << 21;  ///< [bytes] size of a huge page
constexpr size_t kLargestBlock = std::min<uint64_t>(uint64_t{1} << 40, SIZE_MAX / 2);
constexpr size_t kLongestMessage = 4096;  ///< [bytes] limit, in case a plugin forgets the terminating zero

thread_local bool t_servo_thread = false;

/// A message from the servo thread; longer messages are cut.
struct Record {
  int32_t level;
  std::array<char, 48> who;
  std::array<char, 204> text;
};
constexpr size_t kRecords = 64;  ///< messages in the ring, which is read five times a second
std::atomic<uint32_t> lost_records{0};

/// The ring of messages of the servo thread. A process has only one servo thread, so it needs only one ring.
SpscRing<Record>& servoRecords() {
  static SpscRing<Record> ring(kRecords);
  return ring;
}

template <size_t N>
void copyText(const char* from, std::array<char, N>& to) noexcept {
  const size_t length = strnlen(from, N - 1);
  std::memcpy(to.data(), from, length);
  to[length] = '\0';
}

}  // namespace

Services::Services(std::string who, Log log) : who_(std::move(who)), log_(std::move(log)) {
  abi_.struct_size = sizeof abi_;
  abi_.abi_minor = HSP_ABI_MINOR;
  abi_.ctx = this;
  abi_.log = [](const hsp_host* host, int32_t level, const char* utf8) { of(host).write(level, utf8); };
  abi_.trace = [](const hsp_host* host, uint32_t event, double a, double b) noexcept HSP_RT {
    of(host).events_.push({event, a, b});
  };
  abi_.alloc = [](const hsp_host* host, size_t bytes, size_t align) { return of(host).allocate(bytes, align); };
  abi_.release = [](const hsp_host* host, void* block) { of(host).release(block); };
  abi_.is_rt_thread = [](const hsp_host*) -> int32_t { return t_servo_thread ? 1 : 0; };
  abi_.request_restart = [](const hsp_host*) {};  // a host may ignore it
  abi_.extension = [](const hsp_host*, const char*) -> const void* { return nullptr; };
}

Services::~Services() {
  for (const auto& [block, size] : blocks_) ::operator delete(block, std::align_val_t{size.align});
}

std::string Services::lastError() const {
  const std::lock_guard lock(mutex_);
  return last_error_;
}

void Services::forgetError() {
  const std::lock_guard lock(mutex_);
  last_error_.clear();
}

void Services::markServoThread() {
  (void)servoRecords();  // allocates the ring before the thread's first tick
  t_servo_thread = true;
}

void Services::keep(int level, const char* utf8) const noexcept {
  Record record{level, {}, {}};
  copyText(who_.c_str(), record.who);
  copyText(utf8, record.text);
  if (!servoRecords().push(record)) lost_records.fetch_add(1, std::memory_order_relaxed);
}

void Services::passOn(const Log& log) {
  Record record{};
  while (servoRecords().pop(record)) log(record.level, record.who.data(), record.text.data());
  if (const uint32_t lost = lost_records.exchange(0, std::memory_order_relaxed); lost > 0)
    log(HSP_LOG_WARNING, "log", std::to_string(lost) + " messages of the servo thread came too fast and were lost");
}

void Services::write(int level, const char* utf8) {
  if (utf8 == nullptr) return;
  level = std::clamp<int>(level, HSP_LOG_DEBUG, HSP_LOG_ERROR);
  if (t_servo_thread) return keep(level, utf8);
  const std::string text(utf8, strnlen(utf8, kLongestMessage));
  const std::lock_guard lock(mutex_);
  if (level == HSP_LOG_ERROR) last_error_ = text;
  if (log_) log_(level, who_, text);
}

void* Services::allocate(size_t bytes, size_t align) {
  align = std::max(align, kCacheLine);
  if (bytes == 0 || bytes > kLargestBlock || align > kLargestAlign || !std::has_single_bit(align)) return nullptr;
  const size_t rounded = (bytes + align - 1) / align * align;
  void* block = ::operator new(rounded, std::align_val_t{align}, std::nothrow);
  if (block == nullptr) return nullptr;
  std::memset(block, 0, rounded);  // touches every page too, so that none faults in the servo thread
  blocks_.emplace(block, Block{rounded, align});
  locked_bytes_ += rounded;
  return block;
}

void Services::release(void* block) {
  const auto found = blocks_.find(block);
  if (found == blocks_.end()) return;  // foreign, or released before: freeing it would corrupt the heap
  locked_bytes_ -= found->second.bytes;
  ::operator delete(block, std::align_val_t{found->second.align});
  blocks_.erase(found);
}

}  // namespace hapticd::host

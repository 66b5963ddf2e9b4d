// SPDX-License-Identifier: MIT
#include "base/blame.hpp"

#include <sys/uio.h>
#include <ucontext.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <deque>
#include <mutex>

namespace hapticd {

namespace {

thread_local bool t_works = false;

/// Where each worker keeps whose code it runs.
std::atomic<std::atomic<const Owner*>*> workers[kWorkerCount];

struct Code {
  std::atomic<const void*> begin{nullptr}, end{nullptr};
  std::atomic<const Owner*> owner{nullptr};
};
constexpr size_t kMostLibraries = 256;  // of more, the rest is blamed on nobody
std::array<Code, kMostLibraries> code;
std::atomic<size_t> code_count{0};

Code* codeAt(const void* address) noexcept {
  for (size_t i = 0; i < code_count.load(); ++i)
    if (address >= code[i].begin.load() && address < code[i].end.load()) return &code[i];
  return nullptr;
}

struct Interrupted {
  const void* instruction = nullptr;
  const void* stack = nullptr;
};

Interrupted readContext(const void* context) noexcept {
  Interrupted at;
  if (context == nullptr) return at;
  const mcontext_t& machine = static_cast<const ucontext_t*>(context)->uc_mcontext;
#if defined(__x86_64__)
  at.instruction = reinterpret_cast<const void*>(machine.gregs[REG_RIP]);
  at.stack = reinterpret_cast<const void*>(machine.gregs[REG_RSP]);
#elif defined(__aarch64__)
  at.instruction = reinterpret_cast<const void*>(machine.pc);
  at.stack = reinterpret_cast<const void*>(machine.sp);
#else
  (void)machine;
#endif
  return at;
}

}  // namespace

const Owner* ownerOf(const std::string& module, const std::string& name, bool device) {
  static std::mutex mutex;
  static std::deque<Owner>& known = *new std::deque<Owner>;  // never destroyed: handlers may read it at the very end
  const std::lock_guard lock(mutex);
  for (const Owner& owner : known)
    if (owner.module == module && owner.name == name && owner.device == device) return &owner;
  return &known.emplace_back(Owner{module, name, device});
}

Working::Working(Worker worker) noexcept : worker_(worker) {
  t_works = true;
  workers[static_cast<int>(worker)].store(&detail::t_called);
}

Working::~Working() {
  t_works = false;
  workers[static_cast<int>(worker_)].store(nullptr);
}

const Owner* calledBy(Worker worker) noexcept {
  const std::atomic<const Owner*>* called = workers[static_cast<int>(worker)].load();
  return called != nullptr ? called->load(std::memory_order_relaxed) : nullptr;
}

bool isWorker() noexcept {
  return t_works;
}

void keepCode(const void* begin, const void* end) {
  static std::mutex mutex;
  const std::lock_guard lock(mutex);
  const size_t count = code_count.load();
  if (count == code.size() || codeAt(begin) != nullptr) return;
  code[count].begin.store(begin);
  code[count].end.store(end);
  code_count.store(count + 1);
}

void ownCode(const void* address, const Owner* owner) {
  if (Code* found = codeAt(address)) found->owner.store(owner);
}

const Owner* ownerOfCode(const void* address) noexcept {
  const Code* found = codeAt(address);
  return found != nullptr ? found->owner.load() : nullptr;
}

const Owner* ownerInterrupted(const void* context) noexcept {
  const Interrupted at = readContext(context);
  const Owner* owner = ownerOfCode(at.instruction);
  return owner != nullptr ? owner : ownerOnStack(at.stack);
}

const Owner* ownerOnStack(const void* from) noexcept {
  constexpr size_t kPiece = 128, kPieces = 64;  // words: 64 KiB of the stack at most
  const auto* stack = static_cast<const uintptr_t*>(from);
  for (size_t piece = 0; stack != nullptr && piece < kPieces; ++piece, stack += kPiece) {
    std::array<uintptr_t, kPiece> words{};
    iovec to{words.data(), sizeof words}, of{const_cast<uintptr_t*>(stack), sizeof words};
    // The kernel copies: beyond the end of the stack that is an error instead of another fault.
    const ssize_t got = process_vm_readv(getpid(), &to, 1, &of, 1, 0);
    if (got <= 0) return nullptr;
    for (size_t i = 0; i < static_cast<size_t>(got) / sizeof(uintptr_t); ++i)
      if (const Owner* owner = ownerOfCode(reinterpret_cast<const void*>(words[i]))) return owner;
  }
  return nullptr;
}

}  // namespace hapticd

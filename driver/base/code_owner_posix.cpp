// SPDX-License-Identifier: MIT
/// Finds the code that a signal interrupted, from the processor's registers and the thread's stack.
#include <sys/uio.h>
#include <ucontext.h>
#include <unistd.h>

#include <array>
#include <cstdint>

#include "base/code_owner.hpp"

namespace hapticd {

namespace {

struct InterruptedContext {
  const void* instruction = nullptr;
  const void* stack = nullptr;
};

InterruptedContext readContext(const void* context) noexcept {
  InterruptedContext at;
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

const Owner* interruptedOwner(const void* context) noexcept {
  const InterruptedContext at = readContext(context);
  const Owner* owner = ownerOfCode(at.instruction);
  return owner != nullptr ? owner : ownerOnStack(at.stack);
}

const Owner* ownerOnStack(const void* from) noexcept {
  constexpr size_t kPiece = 128, kPieces = 64;  // [words] the stack is read in pieces, at most 64 KiB in all
  const auto* stack = static_cast<const uintptr_t*>(from);
  for (size_t piece = 0; stack != nullptr && piece < kPieces; ++piece, stack += kPiece) {
    std::array<uintptr_t, kPiece> words{};
    iovec to{words.data(), sizeof words}, of{const_cast<uintptr_t*>(stack), sizeof words};
    // The kernel copies the stack, so that reading beyond its end is an error instead of another fault.
    const ssize_t got = process_vm_readv(getpid(), &to, 1, &of, 1, 0);
    if (got <= 0) return nullptr;
    for (size_t i = 0; i < static_cast<size_t>(got) / sizeof(uintptr_t); ++i)
      if (const Owner* owner = ownerOfCode(reinterpret_cast<const void*>(words[i]))) return owner;
  }
  return nullptr;
}

}  // namespace hapticd

// SPDX-License-Identifier: MIT
#include "watch/culprit.hpp"

#include <dlfcn.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <iterator>

#include "base/owner_file.hpp"
#include "watch/signal_names.hpp"

namespace hapticd::watch {

namespace {

/// The C library's last message before it aborted the process: a length, and then the text. nullptr if the C library
/// does not keep this message.
const char* const* last_words = nullptr;

/// True if malloc() or free() aborted because its own data were overwritten. The code that overwrote them has returned
/// long ago. Most likely it is code that does not ship with hapticd.
bool allocatorAborted() noexcept {
  constexpr const char* kItsWords[] = {"free", "alloc", "corrupt", "chunk"};
  const char* said = last_words != nullptr ? *last_words : nullptr;
  if (said == nullptr) return false;
  return std::any_of(std::begin(kItsWords), std::end(kItsWords),
                     [said](const char* word) { return std::strstr(said + sizeof(unsigned), word) != nullptr; });
}

bool isForeign(const Owner& owner) noexcept {
  for (size_t i = 0; const Owner* foreign = foreignOwner(i); ++i)
    if (foreign->module == owner.module) return true;
  return false;
}

}  // namespace

void prepareBlame() noexcept {
  last_words = static_cast<const char* const*>(dlsym(RTLD_DEFAULT, "__abort_msg"));
}

bool sentByOther(const siginfo_t& info) noexcept {
  return info.si_code <= 0 && info.si_code != SI_TIMER && info.si_pid != 0 && info.si_pid != getpid();
}

const Owner* culpritOf(int signal, const siginfo_t& info, const void* context) noexcept {
  const bool own_fault = crashName(signal) != nullptr && info.si_code > 0;
  const bool raised = info.si_code == SI_TKILL && info.si_pid == getpid();
  if (!own_fault && !raised) return nullptr;
  if (const Owner* called = currentOwner()) return called;
  return isWorker() ? nullptr : interruptedOwner(context);  // perhaps a thread that a plugin or module started
}

Blame blameFor(int signal, const siginfo_t& info, const void* context) noexcept {
  const Owner* culprit = culpritOf(signal, info, context);
  const bool torn = signal == SIGABRT && allocatorAborted();
  // Shipped code may only free the memory that other code overwrote, so code that does not ship is the likelier cause.
  if (torn && culprit != nullptr && foreignOwner(0) != nullptr && !isForeign(*culprit)) culprit = nullptr;
  const bool own = info.si_code > 0 || (info.si_code == SI_TKILL && info.si_pid == getpid());
  if (culprit != nullptr || !own) return {culprit, Suspicion::kNone};
  return {nullptr, torn ? Suspicion::kTorn : Suspicion::kCrash};
}

}  // namespace hapticd::watch

// SPDX-License-Identifier: MIT
#include "device_check/overrun_note.hpp"

#include <signal.h>
#include <sys/mman.h>

#include <new>

#include "conformance/guarded_memory.hpp"

namespace hapticd::device_check {
namespace {

constexpr size_t kPage = 4096;

struct Note {
  conformance::Overrun block;
  bool beyond_sample;
  size_t at;  ///< [bytes] from the beginning of the sample
};
Note unshared{};
Note* note = &unshared;
char* sample_end = nullptr;

/// Notes what was overrun, and removes the handler. Then the same access happens again and ends the process.
void onFault(int signal, siginfo_t* info, void*) {
  const auto* at = static_cast<const char*>(info->si_addr);
  note->beyond_sample = sample_end != nullptr && at >= sample_end && at < sample_end + kPage;
  if (note->beyond_sample) note->at = static_cast<size_t>(at - sample_end) + sizeof(hdv_sample);
  note->block = conformance::overrunAt(info->si_addr);
  ::signal(signal, SIG_DFL);
}

}  // namespace

void shareOverrun() {
  if (note == &unshared) {
    void* page = mmap(nullptr, sizeof(Note), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (page != MAP_FAILED) note = new (page) Note;
  }
  *note = {};
}

void noteOverruns() {
  struct sigaction action{};
  action.sa_sigaction = &onFault;
  action.sa_flags = SA_SIGINFO;
  sigaction(SIGSEGV, &action, nullptr);
}

hdv_sample* guardedSample() {
  void* pages = mmap(nullptr, 2 * kPage, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (pages == MAP_FAILED || mprotect(static_cast<char*>(pages) + kPage, kPage, PROT_NONE) != 0) return nullptr;
  sample_end = static_cast<char*>(pages) + kPage;
  static_assert(sizeof(hdv_sample) % alignof(hdv_sample) == 0 && sizeof(hdv_sample) <= kPage);
  return new (sample_end - sizeof(hdv_sample)) hdv_sample{};
}

std::string overrunWords() {
  if (note->beyond_sample)
    return ": it writes byte " + std::to_string(note->at) + " of the hdv_sample, which has " +
           std::to_string(sizeof(hdv_sample)) + ": position, velocity and torque have room for " +
           std::to_string(HDV_MAX_JOINTS) + " joints each";
  const conformance::Overrun& over = note->block;
  if (over.block == 0) return "";
  const std::string block = "a block of " + std::to_string(over.block) + " bytes that the module allocated";
  return over.freed ? ": it uses " + block + " and has freed"
                    : ": it reads or writes byte " + std::to_string(over.at) + " of " + block;
}

}  // namespace hapticd::device_check

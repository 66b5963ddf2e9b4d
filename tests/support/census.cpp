// SPDX-License-Identifier: MIT
#include "census.hpp"

#if defined(__x86_64__) && !defined(HAPTICD_SANITIZED)
#include <cxxabi.h>
#include <elf.h>
#include <fcntl.h>
#include <link.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <ucontext.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <vector>

namespace hapticd::test {
namespace {

constexpr uint8_t kBreakpoint = 0xCC;

struct Entry {
  uint8_t* address;
  uint8_t first;  ///< byte that the breakpoint replaced
  bool entered = false;
  std::string function;  ///< "object function"
};

std::vector<Entry> entries;  // sorted by address; its size does not change while breakpoints are set
struct sigaction before{};

/// Handles a breakpoint: restores the byte and continues there. It must not call functions that may have a breakpoint
/// themselves.
void onBreakpoint(int, siginfo_t*, void* context) {
  auto& at = static_cast<ucontext_t*>(context)->uc_mcontext.gregs[REG_RIP];
  auto* const reached = reinterpret_cast<uint8_t*>(at - 1);
  size_t low = 0, high = entries.size();
  while (low + 1 < high) {
    const size_t middle = (low + high) / 2;
    (entries[middle].address <= reached ? low : high) = middle;
  }
  if (entries[low].address != reached) _exit(70);  // a breakpoint that this program did not set
  *reached = entries[low].first;
  entries[low].entered = true;
  at -= 1;
}

std::string demangled(const char* name) {
  int status = 0;
  char* text = abi::__cxa_demangle(name, nullptr, nullptr, &status);
  std::string result = status == 0 && text != nullptr ? text : name;
  std::free(text);
  return result;
}

/// Adds the functions of namespace hapticd in a loaded ELF file, including those with internal linkage.
void addFunctions(const std::string& file, uintptr_t base) {
  const int descriptor = open(file.c_str(), O_RDONLY | O_CLOEXEC);
  struct stat facts{};
  if (descriptor < 0 || fstat(descriptor, &facts) != 0) return;
  const auto size = static_cast<size_t>(facts.st_size);
  void* mapped = mmap(nullptr, size, PROT_READ, MAP_PRIVATE, descriptor, 0);
  close(descriptor);
  if (mapped == MAP_FAILED) return;
  const char* start = static_cast<const char*>(mapped);
  const auto& header = *reinterpret_cast<const ElfW(Ehdr)*>(start);
  const auto* sections = reinterpret_cast<const ElfW(Shdr)*>(start + header.e_shoff);
  const std::string object = std::filesystem::path(file).filename();
  for (size_t i = 0; i < header.e_shnum; ++i) {
    if (sections[i].sh_type != SHT_SYMTAB) continue;
    const char* names = start + sections[sections[i].sh_link].sh_offset;
    const auto* symbols = reinterpret_cast<const ElfW(Sym)*>(start + sections[i].sh_offset);
    for (size_t k = 0; k < sections[i].sh_size / sizeof(ElfW(Sym)); ++k) {
      if ((symbols[k].st_info & 15) != STT_FUNC || symbols[k].st_size == 0) continue;
      const std::string name = demangled(names + symbols[k].st_name);
      if (name.find("hapticd::") == std::string::npos || name.find("hapticd::test::") != std::string::npos) continue;
      auto* address = reinterpret_cast<uint8_t*>(base + symbols[k].st_value);
      entries.push_back({address, *address, false, object + " " + name});
    }
  }
  munmap(mapped, size);
}

void makeWritable(uintptr_t base, const dl_phdr_info& info, bool writable) {
  const auto page = static_cast<uintptr_t>(sysconf(_SC_PAGESIZE));
  for (int i = 0; i < info.dlpi_phnum; ++i) {
    const auto& part = info.dlpi_phdr[i];
    if (part.p_type != PT_LOAD || (part.p_flags & PF_X) == 0) continue;
    const uintptr_t begin = (base + part.p_vaddr) & ~(page - 1), end = base + part.p_vaddr + part.p_memsz;
    if (mprotect(reinterpret_cast<void*>(begin), end - begin, PROT_READ | PROT_EXEC | (writable ? PROT_WRITE : 0)) != 0)
      throw std::runtime_error("code cannot be made writable here");
  }
}

/// True for this program (which has no name here) and for the project's own libraries.
bool ours(const std::string& file) {
  return file.empty() || file.find("/hapticd/") != std::string::npos;
}

int openCode(dl_phdr_info* info, size_t, void* writable) {
  if (!ours(info->dlpi_name)) return 0;
  makeWritable(info->dlpi_addr, *info, *static_cast<bool*>(writable));
  if (*static_cast<bool*>(writable))
    addFunctions(info->dlpi_name[0] != 0 ? info->dlpi_name : std::filesystem::read_symlink("/proc/self/exe").string(),
                 info->dlpi_addr);
  return 0;
}

}  // namespace

void Census::begin() {
  entries.clear();
  bool writable = true;
  dl_iterate_phdr(openCode, &writable);
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) { return a.address < b.address; });
  entries.erase(std::unique(entries.begin(), entries.end(),
                            [](const Entry& a, const Entry& b) { return a.address == b.address; }),
                entries.end());
  struct sigaction action{};
  action.sa_sigaction = onBreakpoint;
  action.sa_flags = SA_SIGINFO;
  sigaction(SIGTRAP, &action, &before);
  for (Entry& entry : entries) *entry.address = kBreakpoint;
}

Census Census::end() {
  for (Entry& entry : entries) *entry.address = entry.first;
  sigaction(SIGTRAP, &before, nullptr);
  bool writable = false;
  dl_iterate_phdr(openCode, &writable);
  Census census;
  for (const Entry& entry : entries)
    if (entry.entered) census.functions_.insert(entry.function);
  return census;
}

}  // namespace hapticd::test
#else
namespace hapticd::test {
void Census::begin() {}
Census Census::end() {
  return {};
}
}  // namespace hapticd::test
#endif

namespace hapticd::test {

std::string Census::text(const std::string& object, const std::string& part) const {
  std::string lines;
  for (const std::string& function : functions_) {
    const size_t space = function.find(' ');
    if (function.substr(0, space).find(object) == std::string::npos) continue;
    if (function.find(part, space) != std::string::npos) lines += function + "\n";
  }
  return lines;
}

}  // namespace hapticd::test

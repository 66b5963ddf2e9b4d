// SPDX-License-Identifier: MIT
#include "conformance/allocation_place.hpp"

#include <cxxabi.h>
#include <dlfcn.h>
#include <elf.h>
#include <execinfo.h>
#include <link.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <vector>

#include "base/allocation_count.hpp"

namespace hapticd::conformance {
namespace {

std::array<void*, 32> stack;  ///< return addresses, the newest first
int stack_depth = 0;
bool watching = false;

void keepStack() {
  if (stack_depth == 0) stack_depth = backtrace(stack.data(), static_cast<int>(stack.size()));
}

template <class T>
bool readAt(std::ifstream& in, uint64_t offset, std::vector<T>& to, uint64_t bytes) {
  constexpr uint64_t kMost = 1u << 30;
  if (bytes > kMost) return false;
  to.resize(bytes / sizeof(T));
  return static_cast<bool>(in.seekg(static_cast<std::streamoff>(offset))
                               .read(reinterpret_cast<char*>(to.data()), static_cast<std::streamsize>(bytes)));
}

/// Returns the function at an address of a shared object, from the symbol names in its file.
std::string functionAt(const std::string& file, uint64_t address) {
  std::ifstream in(file, std::ios::binary);
  std::vector<ElfW(Ehdr)> header;
  std::vector<ElfW(Shdr)> sections;
  if (!readAt(in, 0, header, sizeof(ElfW(Ehdr))) || std::memcmp(header[0].e_ident, ELFMAG, SELFMAG) != 0) return "";
  if (header[0].e_shentsize != sizeof(ElfW(Shdr))) return "";
  if (!readAt(in, header[0].e_shoff, sections, uint64_t{header[0].e_shnum} * sizeof(ElfW(Shdr)))) return "";
  for (const ElfW(Shdr) & section : sections) {
    std::vector<ElfW(Sym)> symbols;
    std::vector<char> names;
    if ((section.sh_type != SHT_SYMTAB && section.sh_type != SHT_DYNSYM) || section.sh_link >= sections.size())
      continue;
    const ElfW(Shdr) & strings = sections[section.sh_link];
    if (!readAt(in, section.sh_offset, symbols, section.sh_size) ||
        !readAt(in, strings.sh_offset, names, strings.sh_size))
      return "";
    for (const ElfW(Sym) & symbol : symbols)
      if (address >= symbol.st_value && address < symbol.st_value + symbol.st_size && symbol.st_name < names.size() &&
          names.back() == '\0')
        return &names[symbol.st_name];
  }
  return "";
}

/// Returns the name as its author wrote it, without arguments.
std::string readable(const std::string& name) {
  int status = 0;
  char* words = abi::__cxa_demangle(name.c_str(), nullptr, nullptr, &status);
  std::string said = status == 0 ? words : name;
  std::free(words);
  const std::string nobody = "(anonymous namespace)::";
  for (size_t at = said.find(nobody); at != std::string::npos; at = said.find(nobody)) said.erase(at, nobody.size());
  int inside = 0;  // depth of template arguments, which may contain brackets
  for (size_t i = 0; i < said.size(); ++i) {
    inside += said[i] == '<' ? 1 : said[i] == '>' ? -1 : 0;
    if (said[i] == '(' && inside == 0) return said.substr(0, i);
  }
  return said;
}

}  // namespace

AllocationWatch::AllocationWatch() noexcept {
  if (watching && stack_depth == 0) onAllocation(&keepStack);
}

AllocationWatch::~AllocationWatch() {
  onAllocation(nullptr);
}

void watchAllocations() {
  void* ahead[1];
  backtrace(ahead, 1);  // the first call loads a library
  watching = true;
}

std::string firstAllocationIn(const std::string& file) {
  std::error_code none;
  for (size_t i = 0; i < static_cast<size_t>(stack_depth); ++i) {
    Dl_info found{};
    if (dladdr(stack[i], &found) == 0 || !std::filesystem::equivalent(found.dli_fname, file, none)) continue;
    const uint64_t address = reinterpret_cast<uintptr_t>(stack[i]) - reinterpret_cast<uintptr_t>(found.dli_fbase) - 1;
    const std::string name = readable(functionAt(file, address));
    // skip functions of the standard library: their caller is wanted
    if (name.rfind("std::", 0) == 0 || name.find(" std::") != std::string::npos) continue;
    char line[32];
    std::snprintf(line, sizeof line, "0x%llx", static_cast<unsigned long long>(address));
    return (name.empty() ? "" : " in " + name) + " (for the line, with -g: addr2line -Cfie " + file + " " + line + ")";
  }
  return "";
}

}  // namespace hapticd::conformance

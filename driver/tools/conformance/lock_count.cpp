// SPDX-License-Identifier: MIT
#include "conformance/lock_count.hpp"

#include <dlfcn.h>
#include <elf.h>
#include <link.h>
#include <pthread.h>
#include <semaphore.h>
#include <sys/mman.h>
#include <unistd.h>

#include <atomic>
#include <cstring>

namespace hapticd::conformance {

namespace {

std::atomic<uint64_t> counted{0};

template <class Argument, int (*Function)(Argument*)>
int counting(Argument* argument) {
  ++counted;
  return Function(argument);
}

struct Replacement {
  const char* name;
  void* function;
};
const Replacement kReplacements[] = {
    {"pthread_mutex_lock", reinterpret_cast<void*>(&counting<pthread_mutex_t, &pthread_mutex_lock>)},
    {"pthread_mutex_trylock", reinterpret_cast<void*>(&counting<pthread_mutex_t, &pthread_mutex_trylock>)},
    {"pthread_rwlock_rdlock", reinterpret_cast<void*>(&counting<pthread_rwlock_t, &pthread_rwlock_rdlock>)},
    {"pthread_rwlock_wrlock", reinterpret_cast<void*>(&counting<pthread_rwlock_t, &pthread_rwlock_wrlock>)},
    {"sem_wait", reinterpret_cast<void*>(&counting<sem_t, &sem_wait>)},
};

/// Replaces a function address, although the loader has made the resolved addresses read-only.
bool put(void** slot, void* function) {
  const auto page_size = static_cast<uintptr_t>(sysconf(_SC_PAGESIZE));
  void* page = reinterpret_cast<void*>(reinterpret_cast<uintptr_t>(slot) & ~(page_size - 1));
  if (mprotect(page, page_size, PROT_READ | PROT_WRITE) != 0) return false;
  *slot = function;
  return true;
}

struct Dynamic {
  const char* strings = nullptr;
  const ElfW(Sym) * symbols = nullptr;
  const ElfW(Rela) * tables[2] = {nullptr, nullptr};
  size_t sizes[2] = {0, 0};
};

Dynamic read(const link_map& map) {
  Dynamic found;
  for (const ElfW(Dyn)* d = map.l_ld; d->d_tag != DT_NULL; ++d) {
    if (d->d_tag == DT_STRTAB) found.strings = reinterpret_cast<const char*>(d->d_un.d_ptr);
    if (d->d_tag == DT_SYMTAB) found.symbols = reinterpret_cast<const ElfW(Sym)*>(d->d_un.d_ptr);
    if (d->d_tag == DT_JMPREL) found.tables[0] = reinterpret_cast<const ElfW(Rela)*>(d->d_un.d_ptr);
    if (d->d_tag == DT_PLTRELSZ) found.sizes[0] = d->d_un.d_val / sizeof(ElfW(Rela));
    if (d->d_tag == DT_RELA) found.tables[1] = reinterpret_cast<const ElfW(Rela)*>(d->d_un.d_ptr);
    if (d->d_tag == DT_RELASZ) found.sizes[1] = d->d_un.d_val / sizeof(ElfW(Rela));
  }
  return found;
}

}  // namespace

bool countLocksOf(const std::string& file) {
  void* handle = dlopen(file.c_str(), RTLD_NOW | RTLD_NOLOAD);
  link_map* map = nullptr;
  if (handle == nullptr || dlinfo(handle, RTLD_DI_LINKMAP, &map) != 0) return false;
  const Dynamic dynamic = read(*map);
  bool any = false;
  for (int table = 0; table < 2; ++table)
    for (size_t i = 0; dynamic.tables[table] != nullptr && i < dynamic.sizes[table]; ++i) {
      const ElfW(Rela) & relocation = dynamic.tables[table][i];
      const size_t symbol = ELF64_R_SYM(relocation.r_info);
      const char* name = symbol != 0 ? dynamic.strings + dynamic.symbols[symbol].st_name : "";
      for (const Replacement& replacement : kReplacements)
        if (std::strcmp(name, replacement.name) == 0)
          any |= put(reinterpret_cast<void**>(map->l_addr + relocation.r_offset), replacement.function);
    }
  dlclose(handle);
  return any;
}

uint64_t locksCounted() {
  return counted.load();
}

}  // namespace hapticd::conformance

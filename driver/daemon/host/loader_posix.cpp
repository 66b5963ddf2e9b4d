// SPDX-License-Identifier: MIT
#include <dlfcn.h>
#include <link.h>

#include <string>

#include "base/code_owner.hpp"
#include "host/loader.hpp"

namespace hapticd::host {
namespace {

std::string loaderReason() {
  const char* reason = dlerror();
  return reason != nullptr ? reason : "no reason given by the loader";
}

/// Notes the addresses of a library's code, so that a crash in a thread of the library can be blamed on it.
void registerCodeOf(void* handle) {
  link_map* loaded = nullptr;
  if (dlinfo(handle, RTLD_DI_LINKMAP, &loaded) != 0 || loaded == nullptr) return;
  const auto keep = [](dl_phdr_info* info, size_t, void* wanted) {
    if (info->dlpi_addr != static_cast<link_map*>(wanted)->l_addr) return 0;
    for (int i = 0; i < info->dlpi_phnum; ++i) {
      const ElfW(Phdr) & part = info->dlpi_phdr[i];
      if (part.p_type != PT_LOAD || (part.p_flags & PF_X) == 0) continue;
      const auto* begin = reinterpret_cast<const char*>(info->dlpi_addr + part.p_vaddr);
      registerCode(begin, begin + part.p_memsz);
    }
    return 1;
  };
  dl_iterate_phdr(keep, loaded);
}

}  // namespace

Result<void*> loadFile(const std::filesystem::path& file) {
  void* handle = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (handle == nullptr) return Error{loaderReason()};
  registerCodeOf(handle);
  return handle;
}

Result<const void*> symbolOf(void* handle, const char* symbol) {
  dlerror();
  const void* address = dlsym(handle, symbol);
  if (address == nullptr) return Error{loaderReason()};
  return address;
}

}  // namespace hapticd::host

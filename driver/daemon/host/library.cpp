// SPDX-License-Identifier: MIT
#include "host/library.hpp"

#include <dlfcn.h>
#include <link.h>

#include <map>
#include <mutex>
#include <string>

#include "base/blame.hpp"

namespace hapticd::host {
namespace {

constexpr uint32_t kMaxClasses = 1024;  ///< more in one file is a table that was misread

/// What is loaded now, by the file's real path: two spellings of one file give one library.
struct Registry {
  std::mutex mutex;
  std::map<std::filesystem::path, std::weak_ptr<Library>> loaded;
};

Registry& registry() {
  static Registry instance;
  return instance;
}

std::string loaderReason() {
  const char* reason = dlerror();
  return reason != nullptr ? reason : "no reason given by the loader";
}

/// Keeps where the code of a library lies, so that a crash in a thread of its own finds its name.
void keepCodeOf(void* handle) {
  link_map* loaded = nullptr;
  if (dlinfo(handle, RTLD_DI_LINKMAP, &loaded) != 0 || loaded == nullptr) return;
  const auto keep = [](dl_phdr_info* info, size_t, void* wanted) {
    if (info->dlpi_addr != static_cast<link_map*>(wanted)->l_addr) return 0;
    for (int i = 0; i < info->dlpi_phnum; ++i) {
      const ElfW(Phdr) & part = info->dlpi_phdr[i];
      if (part.p_type != PT_LOAD || (part.p_flags & PF_X) == 0) continue;
      const auto* begin = reinterpret_cast<const char*>(info->dlpi_addr + part.p_vaddr);
      keepCode(begin, begin + part.p_memsz);
    }
    return 1;
  };
  dl_iterate_phdr(keep, loaded);
}

/// Magic and version of an entry; hsp_entry and hdv_entry have the same members.
template <class Entry>
Result<const Entry*> checkedEntry(void* handle, const std::filesystem::path& file, const char* symbol, uint32_t magic,
                                  const char* what) {
  dlerror();
  const auto* entry = static_cast<const Entry*>(dlsym(handle, symbol));
  if (entry == nullptr)
    return Error{file.string() + " is not a " + what + ": it does not export " + symbol +
                 "\n  the loader says: " + loaderReason()};
  if (entry->magic != magic)
    return Error{file.string() + " is not a " + what + ": the data at " + symbol +
                 " does not begin with the expected mark"};
  if (entry->abi_major != HSP_ABI_MAJOR)
    return Error{file.string() + ": built for version " + std::to_string(entry->abi_major) + "." +
                 std::to_string(entry->abi_minor) + " of the interface; this hapticd speaks version " +
                 std::to_string(HSP_ABI_MAJOR) + "\n  fix: rebuild it against the headers of this hapticd"};
  if (entry->class_count == 0 || entry->class_count > kMaxClasses || entry->classes == nullptr)
    return Error{file.string() + ": its entry lists " + std::to_string(entry->class_count) +
                 " classes, expected 1 to " + std::to_string(kMaxClasses)};
  return entry;
}

}  // namespace

Result<std::shared_ptr<Library>> Library::open(const std::filesystem::path& file) {
  std::error_code error;
  const std::filesystem::path real = std::filesystem::canonical(file, error);
  if (error) return Error{"cannot load " + file.string() + ": " + error.message()};

  Registry& all = registry();
  const std::lock_guard lock(all.mutex);
  std::weak_ptr<Library>& slot = all.loaded[real];
  if (std::shared_ptr<Library> loaded = slot.lock()) return loaded;

  void* handle = dlopen(real.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (handle == nullptr) return Error{"cannot load " + real.string() + "\n  the loader says: " + loaderReason()};
  keepCodeOf(handle);
  std::shared_ptr<Library> loaded(new Library(real, handle));
  slot = loaded;
  return loaded;
}

std::shared_ptr<Library> Library::loaded(const std::filesystem::path& file) {
  std::error_code error;
  const std::filesystem::path real = std::filesystem::canonical(file, error);
  Registry& all = registry();
  const std::lock_guard lock(all.mutex);
  const auto found = error ? all.loaded.end() : all.loaded.find(real);
  return found != all.loaded.end() ? found->second.lock() : nullptr;
}

Result<const hsp_entry*> Library::shapes() const {
  return checkedEntry<hsp_entry>(handle_, file_, "hsp_plugin_entry", HSP_MAGIC, "shape plugin");
}

Result<const hdv_entry*> Library::devices() const {
  return checkedEntry<hdv_entry>(handle_, file_, "hdv_module_entry", HDV_MAGIC, "device module");
}

}  // namespace hapticd::host

// SPDX-License-Identifier: MIT
#include "host/library.hpp"

#include <map>
#include <mutex>
#include <optional>
#include <string>

#include "host/built_in.hpp"
#include "host/file_stamp.hpp"
#include "host/loader.hpp"
#include "host/replaced_library.hpp"

namespace hapticd::host {
namespace {

constexpr uint32_t kMaxClasses = 1024;  ///< a file whose table claims more is damaged

/// The libraries that are loaded now, by their real paths, so that two spellings of a path give the same library. The
/// code of a library that is no longer used stays in memory: if the library is opened again, the system's loader
/// returns this code, even if the file has changed.
struct Registry {
  std::mutex mutex;
  std::map<std::filesystem::path, std::weak_ptr<Library>> loaded;
  std::map<std::filesystem::path, std::optional<FileStamp>> first;  ///< identities of the files whose code is in memory
};

Registry& registry() {
  static Registry instance;
  return instance;
}

/// Returns the entry of a built-in plugin or module. It is an error if it has none of the wanted kind.
Result<const void*> linked(const void* entry) {
  if (entry == nullptr)
    return Error{
        "this built-in class is of the wrong kind: a shape plugin where a device module is expected, or the reverse"
        "\n  fix: name a class of the right kind"};
  return entry;
}

/// Checks the magic number and the version of an entry. hsp_entry and hdv_entry have the same members.
template <class Entry>
Result<const Entry*> checkedEntry(const Result<const void*>& symbol_at, const std::filesystem::path& file,
                                  const char* symbol, uint32_t magic, const char* what) {
  if (!symbol_at)
    return Error{file.string() + " is not a " + what + ": it does not export " + symbol +
                 "\n  the loader says: " + symbol_at.error()};
  const auto* entry = static_cast<const Entry*>(*symbol_at);
  if (entry->magic != magic)
    return Error{file.string() + " is not a " + what + ": the data at " + symbol +
                 " does not begin with the magic number of the interface\n"
                 "  fix: define it with HAPTICD_SHAPES or HAPTICD_DEVICES"};
  if (entry->abi_major != HSP_ABI_MAJOR)
    return Error{file.string() + ": built for version " + std::to_string(entry->abi_major) + "." +
                 std::to_string(entry->abi_minor) + " of the interface; this hapticd supports version " +
                 std::to_string(HSP_ABI_MAJOR) + "\n  fix: rebuild it against the headers of this hapticd"};
  if (entry->class_count == 0 || entry->class_count > kMaxClasses || entry->classes == nullptr)
    return Error{file.string() + ": its entry lists " + std::to_string(entry->class_count) +
                 " classes, expected 1 to " + std::to_string(kMaxClasses)};
  return entry;
}

/// Returns what to do about a file that the system's loader refuses, judged by what the loader says.
std::string remedyOf(const std::string& told, const std::filesystem::path& file) {
  const auto says = [&told](const char* words) { return told.find(words) != std::string::npos; };
  if (says("undefined symbol")) return "define this symbol in the plugin, or link it with the library that does";
  if (says("cannot open shared object file"))
    return "install the library that the loader names, or add its folder to LD_LIBRARY_PATH; ldd " + file.string() +
           " lists all that it needs";
  if (says("version `")) return "build it on this machine: it needs a newer system library than this one has";
  return "build it again, for this machine and as a shared object (-shared -fPIC)";
}

}  // namespace

Result<std::shared_ptr<Library>> Library::open(const std::filesystem::path& file) {
  if (findBuiltIn(file) != nullptr) return std::shared_ptr<Library>(new Library(file, nullptr));
  std::error_code error;
  const std::filesystem::path real = std::filesystem::canonical(file, error);
  if (error) return Error{"cannot load " + file.string() + ": " + error.message()};

  Registry& all = registry();
  const std::lock_guard lock(all.mutex);
  std::weak_ptr<Library>& slot = all.loaded[real];
  if (std::shared_ptr<Library> loaded = slot.lock()) return loaded;

  const auto stamp = stampOf(real);  // before loading: a file replaced in between is at worst taken for a new one
  const auto handle = loadFile(real);
  if (!handle)
    return Error{"cannot load " + real.string() + "\n  the loader says: " + handle.error() +
                 "\n  fix: " + remedyOf(handle.error(), real)};
  all.first.emplace(real, stamp);
  std::shared_ptr<Library> loaded(new Library(real, *handle));
  slot = loaded;
  return loaded;
}

std::shared_ptr<Library> Library::loaded(const std::filesystem::path& file) {
  if (findBuiltIn(file) != nullptr) return std::shared_ptr<Library>(new Library(file, nullptr));
  std::error_code error;
  const std::filesystem::path real = std::filesystem::canonical(file, error);
  Registry& all = registry();
  const std::lock_guard lock(all.mutex);
  const auto found = error ? all.loaded.end() : all.loaded.find(real);
  return found != all.loaded.end() ? found->second.lock() : nullptr;
}

std::string identityText(const std::filesystem::path& real, const std::optional<FileStamp>& stamp) {
  if (!stamp) return real.string();
  return std::to_string((*stamp)[2]) + " bytes of " + std::to_string((*stamp)[3]) + "." + std::to_string((*stamp)[4]) +
         " " + real.string();
}

std::string identityOnDisk(const std::filesystem::path& file) {
  std::error_code error;
  const std::filesystem::path real = std::filesystem::canonical(file, error);
  return error ? file.string() : identityText(real, stampOf(real));
}

std::string identityLoaded(const std::filesystem::path& file) {
  std::error_code error;
  const std::filesystem::path real = std::filesystem::canonical(file, error);
  Registry& all = registry();
  const std::lock_guard lock(all.mutex);
  const auto first = error ? all.first.end() : all.first.find(real);
  return first != all.first.end() ? identityText(real, first->second) : "";
}

bool replacedSinceLoaded(const std::filesystem::path& file) {
  std::error_code error;
  const std::filesystem::path real = std::filesystem::canonical(file, error);
  Registry& all = registry();
  const std::lock_guard lock(all.mutex);
  const auto first = error ? all.first.end() : all.first.find(real);
  return first != all.first.end() && stampOf(real) != first->second;
}

bool Library::exports(const char* symbol) const {
  return handle_ != nullptr && static_cast<bool>(symbolOf(handle_, symbol));
}

Result<const hsp_entry*> Library::shapes() const {
  constexpr const char* kSymbol = "hsp_plugin_entry";
  const BuiltIn* built_in = findBuiltIn(file_);
  const auto at = built_in != nullptr ? linked(built_in->shapes) : symbolOf(handle_, kSymbol);
  return checkedEntry<hsp_entry>(at, file_, kSymbol, HSP_MAGIC, "shape plugin");
}

Result<const hdv_entry*> Library::devices() const {
  constexpr const char* kSymbol = "hdv_module_entry";
  const BuiltIn* built_in = findBuiltIn(file_);
  const auto at = built_in != nullptr ? linked(built_in->devices) : symbolOf(handle_, kSymbol);
  return checkedEntry<hdv_entry>(at, file_, kSymbol, HDV_MAGIC, "device module");
}

}  // namespace hapticd::host

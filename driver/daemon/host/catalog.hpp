// SPDX-License-Identifier: MIT
/// Finds shape plugins and device modules, and keeps their descriptions. Built-in ones are found first. A file is
/// described in a child process, and only when its description is needed. So for a scene that names one plugin, this
/// process loads only that plugin.
#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/result.hpp"
#include "description/class_info.hpp"
#include "host/describe.hpp"
#include "host/file_stamp.hpp"

namespace hapticd::host {

/// The folders in which files are searched. The first match counts.
struct SearchPath {
  std::vector<std::filesystem::path> plugins, devices;

  /// [main] Returns the standard path: the folders of HAPTICD_PLUGIN_PATH (separated by colons, for both kinds), then
  /// ../lib/hapticd/{plugins,devices} relative to the executable (build tree or moved installation), then the folders
  /// of the installation.
  static SearchPath standard();

  /// [main] Puts folders before all others, for --plugin-path and the daemon file.
  void prepend(const std::vector<std::filesystem::path>& dirs);
};

/// [main] True if the library is built in, or is a file in a folder of shipped modules. Other files are foreign.
bool ships(const std::filesystem::path& library);

/// A file that looks like a plugin or module, with its description, or the reason why it has none.
struct CatalogFile {
  std::filesystem::path path;
  std::optional<FileStamp> stamp;  ///< stamp of the file that was described; nothing if the library was loaded
  std::vector<ClassInfo> classes;
  std::string error;  ///< why there is no description; "" if there is one
};

class Catalog {
 public:
  /// A function that describes a file that is not loaded.
  using Describe = std::function<Result<std::vector<ClassInfo>>(const std::filesystem::path&)>;

  explicit Catalog(SearchPath path = SearchPath::standard()) : path_(std::move(path)), describe_(describeInChild) {}

  /// [main] Sets the function by which files are described from now on.
  void describeBy(Describe describe) { describe_ = std::move(describe); }

  /// [main] Forgets the descriptions of files that have changed, that could not be described, or that were loaded when
  /// they were described. Forgets also in which file each name was found. A process that runs for days calls it before
  /// it searches again. Pointers that were returned earlier become invalid.
  void refresh();

  /// [main] Returns the plugin with that name or id. NAME.so is tried first; only if that fails, all files are
  /// described. The error says why NAME.so could not be used, and contains the nearest names and the search path.
  Result<const ClassInfo*> shape(const std::string& name) { return find(Kind::kShape, name); }
  Result<const ClassInfo*> device(const std::string& name) { return find(Kind::kDevice, name); }

  /// [main] Returns every .so file of the search path with its description, or with an error.
  std::vector<const CatalogFile*> files(Kind kind);

  /// [main] Returns the names of all classes of a kind.
  std::vector<std::string> names(Kind kind);

  const SearchPath& searchPath() const { return path_; }
  /// Returns the number of files described so far. Tests use it to see that no other file was touched.
  size_t described() const { return files_.size(); }

 private:
  Result<const ClassInfo*> find(Kind kind, const std::string& name);
  const CatalogFile& describeOnce(const std::filesystem::path& file);
  std::string notFound(Kind kind, const std::string& name, const std::string& reason);
  const std::vector<std::filesystem::path>& dirs(Kind kind) const {
    return kind == Kind::kShape ? path_.plugins : path_.devices;
  }

  SearchPath path_;
  Describe describe_;
  std::map<std::filesystem::path, CatalogFile> files_;              // a map, so that pointers to elements stay valid
  std::map<std::pair<Kind, std::string>, const ClassInfo*> found_;  // a cache, for scenes with many models of one class
};

/// [main] Returns the folder of the running executable.
std::filesystem::path executableDir();

/// [main] Returns the path of a file of the shipped configuration, such as "devices/simulated-premium15.yaml". It
/// searches beside the executable's tree, in the sources from which it was built, and in the installation: a program in
/// its build folder uses its own sources even if another version is installed. Returns nothing if the file is in none
/// of them.
std::optional<std::filesystem::path> shippedFile(const std::filesystem::path& relative);

/// [main] Returns the path of a file that came with this program: `installed`, below the folder into which it was
/// installed, else `source`, below the sources from which it was built. Returns nothing if neither is there.
std::optional<std::filesystem::path> ownFile(const std::filesystem::path& installed,
                                             const std::filesystem::path& source);

}  // namespace hapticd::host

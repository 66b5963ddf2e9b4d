// SPDX-License-Identifier: MIT
/// Finds shape plugins and device modules and knows what they say of themselves. Built-in ones come first. Files are
/// described in child processes and only when asked for: a scene that names one plugin makes this process load no
/// other.
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

/// Where files are looked for, first match wins.
struct SearchPath {
  std::vector<std::filesystem::path> plugins, devices;

  /// [main] HAPTICD_PLUGIN_PATH (a colon list, both kinds), then ../lib/hapticd/{plugins,devices} seen from the
  /// executable (build tree or relocated installation), then the directory of the installation.
  static SearchPath standard();

  /// [main] Puts directories before all others, as --plugin-path and the daemon file do.
  void prepend(const std::vector<std::filesystem::path>& dirs);
};

/// [main] True for what is built in, and for a file in a folder of shipped modules. Other files are foreign.
bool ships(const std::filesystem::path& library);

/// A file that looks like a plugin or module: its description, or the reason why there is none.
struct CatalogFile {
  std::filesystem::path path;
  std::optional<FileStamp> stamp;  ///< of the file that was described; nothing if the library was loaded
  std::vector<ClassInfo> classes;
  std::string error;  ///< "": none
};

class Catalog {
 public:
  /// How a file that is not loaded is described.
  using Describe = std::function<Result<std::vector<ClassInfo>>(const std::filesystem::path&)>;

  explicit Catalog(SearchPath path = SearchPath::standard()) : path_(std::move(path)), describe_(describeInChild) {}

  /// [main] Describes files in another way from now on.
  void describeBy(Describe describe) { describe_ = std::move(describe); }

  /// [main] Forgets files that changed, failed, or were loaded when they were described, and where names were found. A
  /// process that runs for days calls it before it looks again. Pointers given out before become invalid.
  void refresh();

  /// [main] The plugin of that name or id. NAME.so is tried first; only if that fails, all files are described. The
  /// message says why a NAME.so could not be used, and has the nearest names and the search path.
  Result<const ClassInfo*> shape(const std::string& name) { return find(Kind::kShape, name); }
  Result<const ClassInfo*> device(const std::string& name) { return find(Kind::kDevice, name); }

  /// [main] Every .so of the search path, described; those that failed carry an error.
  std::vector<const CatalogFile*> files(Kind kind);

  /// [main] Names of all classes of a kind.
  std::vector<std::string> names(Kind kind);

  const SearchPath& searchPath() const { return path_; }
  /// Files described so far; tests use it to see that no other file was touched.
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
  std::map<std::filesystem::path, CatalogFile> files_;  // its nodes stay in place: pointers to them are given out
  std::map<std::pair<Kind, std::string>, const ClassInfo*> found_;  // a scene of 10,000 models asks for one name often
};

/// [main] The folder of the running executable.
std::filesystem::path executableDir();

/// [main] A file of the shipped configuration ("devices/simulated-premium15.yaml"): beside the executable's tree, in
/// the installation, or in the sources it was built from. Nothing if it is in none of them.
std::optional<std::filesystem::path> shippedFile(const std::filesystem::path& relative);

}  // namespace hapticd::host

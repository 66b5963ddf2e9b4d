// SPDX-License-Identifier: MIT
#include "host/catalog.hpp"

#include <algorithm>
#include <cstdlib>
#include <sstream>

#include "document/suggestion.hpp"
#include "host/build_folders.hpp"
#include "host/built_in.hpp"
#include "host/library.hpp"

namespace hapticd::host {
namespace fs = std::filesystem;
namespace {

const char* noun(Kind kind) {
  return kind == Kind::kShape ? "shape plugin" : "device module";
}

const ClassInfo* classIn(const CatalogFile& file, Kind kind, const std::string& name) {
  for (const ClassInfo& info : file.classes)
    if (info.kind == kind && (info.name == name || info.id == name)) return &info;
  return nullptr;
}

std::vector<fs::path> sharedObjects(const fs::path& dir) {
  std::vector<fs::path> found;
  std::error_code error;
  for (fs::directory_iterator entry(dir, error), end; !error && entry != end; entry.increment(error))
    if (entry->path().extension() == ".so") found.push_back(entry->path());
  std::sort(found.begin(), found.end());
  return found;
}

/// True for a name without a path: a name from a file must not lead out of the searched folders.
bool plainName(const std::string& name) {
  return !name.empty() && name.find('/') == std::string::npos && name.size() < 200 && name[0] != '.';
}

std::string folderLines(const std::vector<fs::path>& dirs) {
  std::string text;
  for (const fs::path& dir : dirs) {
    std::error_code error;
    const bool there = fs::is_directory(dir, error);
    text += "\n    " + dir.string() + (there ? "" : error ? " (" + error.message() + ")" : " (not a folder)");
  }
  return text;
}

}  // namespace

bool shipsName(Kind kind, const std::string& name) {
  constexpr const char* kShapes[] = {"mat_deformable", "nurbs_rigid", "pendulum", "push_button", "template"};
  constexpr const char* kDevices[] = {"simulated",    "usb_hid",    "usb_bulk", "vme",
                                      "template_arm", "vendor_dhd", "vendor_hd"};
  const auto is = [&](const char* one) { return name == one; };
  return kind == Kind::kShape ? std::any_of(std::begin(kShapes), std::end(kShapes), is)
                              : std::any_of(std::begin(kDevices), std::end(kDevices), is);
}

fs::path executableDir() {
  std::error_code error;
  const fs::path self = fs::read_symlink("/proc/self/exe", error);
  return error ? fs::current_path(error) : self.parent_path();
}

std::optional<fs::path> shippedFile(const fs::path& relative) {
  const BuildFolders& folders = buildFolders();
  std::error_code error;
  for (const fs::path& root : {executableDir() / ".." / "share" / "hapticd", fs::path(folders.source) / "config",
                               fs::path(folders.installed_data)})
    if (fs::exists(root / relative, error)) return (root / relative).lexically_normal();
  return std::nullopt;
}

std::optional<fs::path> ownFile(const fs::path& installed, const fs::path& source) {
  std::error_code error;
  for (const fs::path& file : {executableDir() / ".." / installed, fs::path(buildFolders().source) / source})
    if (fs::exists(file, error)) return file.lexically_normal();
  return std::nullopt;
}

namespace {

/// Returns the folders with the modules that ship with this program: beside the program, and in the installation.
std::vector<fs::path> shippedRoots() {
  const BuildFolders& folders = buildFolders();
  const fs::path beside = executableDir() / "..";
  std::vector<fs::path> roots;
  for (const fs::path& root :
       {beside / "lib" / "hapticd", beside / folders.library / "hapticd", fs::path(folders.installed_modules)})
    roots.push_back(root.lexically_normal());
  return roots;
}

}  // namespace

bool ships(const fs::path& library) {
  if (findBuiltIn(library) != nullptr) return true;
  std::error_code error;
  const fs::path folder = fs::weakly_canonical(library, error).parent_path();
  const auto roots = shippedRoots();
  return std::any_of(roots.begin(), roots.end(), [&](const fs::path& root) {
    return fs::weakly_canonical(root / "plugins", error) == folder ||
           fs::weakly_canonical(root / "devices", error) == folder;
  });
}

SearchPath SearchPath::standard() {
  SearchPath path;
  if (const char* listed = std::getenv("HAPTICD_PLUGIN_PATH")) {
    std::stringstream dirs(listed);
    for (std::string dir; std::getline(dirs, dir, ':');)
      if (!dir.empty()) path.plugins.emplace_back(dir), path.devices.emplace_back(dir);
  }
  for (const fs::path& normal : shippedRoots()) {
    if (std::find(path.plugins.begin(), path.plugins.end(), normal / "plugins") != path.plugins.end()) continue;
    path.plugins.push_back(normal / "plugins");
    path.devices.push_back(normal / "devices");
  }
  return path;
}

void SearchPath::prepend(const std::vector<fs::path>& dirs) {
  plugins.insert(plugins.begin(), dirs.begin(), dirs.end());
  devices.insert(devices.begin(), dirs.begin(), dirs.end());
}

const CatalogFile& Catalog::describeOnce(const fs::path& file) {
  if (const auto known = files_.find(file); known != files_.end()) return known->second;
  CatalogFile& entry = files_[file];
  entry.path = file;
  // A loaded library is described in this process, even if its file has changed since: the loaded code will be used,
  // and its constructors have run already. Any other library is described in a child process.
  const std::shared_ptr<Library> loaded = Library::loaded(file);
  if (!loaded) entry.stamp = stampOf(file);
  auto classes = loaded ? describe(file) : describe_(file);
  if (classes)
    entry.classes = *std::move(classes);
  else
    entry.error = classes.error();
  return entry;
}

void Catalog::refresh() {
  found_.clear();
  std::erase_if(files_, [](const auto& entry) {
    const CatalogFile& file = entry.second;
    return !file.error.empty() || !file.stamp || file.stamp != stampOf(file.path);
  });
}

std::vector<const CatalogFile*> Catalog::files(Kind kind) {
  std::vector<const CatalogFile*> all;
  for (const fs::path& path : builtIns(kind)) all.push_back(&describeOnce(path));
  for (const fs::path& dir : dirs(kind))
    for (const fs::path& file : sharedObjects(dir)) all.push_back(&describeOnce(file));
  return all;
}

std::vector<std::string> Catalog::names(Kind kind) {
  std::vector<std::string> all;
  for (const CatalogFile* file : files(kind))
    for (const ClassInfo& info : file->classes)
      if (info.kind == kind && std::find(all.begin(), all.end(), info.name) == all.end()) all.push_back(info.name);
  return all;
}

Result<const ClassInfo*> Catalog::find(Kind kind, const std::string& name) {
  const ClassInfo*& known = found_[{kind, name}];
  if (known != nullptr) return known;
  std::string reason;
  std::error_code error;
  for (const fs::path& path : builtIns(kind))
    if (const ClassInfo* info = classIn(describeOnce(path), kind, name)) return known = info;
  if (plainName(name)) {
    for (const fs::path& dir : dirs(kind)) {
      const fs::path file = dir / (name + ".so");
      if (!fs::exists(file, error)) continue;
      const CatalogFile& entry = describeOnce(file);
      if (const ClassInfo* info = classIn(entry, kind, name)) return known = info;
      if (!entry.error.empty()) reason += "\n  " + entry.error;
    }
  }
  for (const CatalogFile* file : files(kind))
    if (const ClassInfo* info = classIn(*file, kind, name)) return known = info;
  return Error{notFound(kind, name, reason)};
}

std::string Catalog::notFound(Kind kind, const std::string& name, const std::string& reason) {
  const std::vector<std::string> known = names(kind);
  std::string text =
      std::string("there is no usable ") + noun(kind) + " \"" + name + "\"" + document::suggestionOfName(name, known);
  if (!known.empty()) text += ", expected one of " + document::listedFor(name, known);
  text += reason;
  if (reason.empty())
    for (const CatalogFile* file : files(kind))
      if (!file->error.empty()) text += "\n  not usable: " + file->error;
  text += "\n  searched:" + folderLines(dirs(kind)) + "\n  fix: ";
  if (!reason.empty()) return text + "correct this file as it says above, or write another name";
  if (shipsName(kind, name))  // happens only in a source checkout, since the packages contain all of them
    return text + "it is part of hapticd but is not built here: run cmake --build build/release --target modules";
  text += "write an existing name, or add the folder of the missing file to HAPTICD_PLUGIN_PATH";
  if (name.find('/') == name.npos && !name.ends_with(".so")) return text;
  return text + "; write the name of the class, such as " + fs::path(name).stem().string() +
         ", not of the file, and give the file's folder by --plugin-path";
}

}  // namespace hapticd::host

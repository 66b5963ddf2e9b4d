// SPDX-License-Identifier: MIT
#include "scene/load.hpp"

#include "base/nearest_word.hpp"
#include "document/suggestion.hpp"
#include "scene/device_draft.hpp"
#include "scene/loader.hpp"

namespace hapticd::scene {

using namespace document;
namespace {

void checkRoot(const Node& root, Reader& in, host::Catalog& catalog, std::optional<Scene>* scene) {
  const Format* format = detail::formatOf(root);
  if (detail::isMeantAsDevice(root)) {
    detail::hasFormat(root, "hapticd-device", in);
    detail::loadMeantDevice(root, in, {.file = in.file()}, catalog);
  } else if (format == nullptr) {
    detail::hasFormat(root, nullptr, in);
    const Node* models = root.isMap() ? root.find("models") : nullptr;
    if (models == nullptr || !models->isSequence()) return;
    Problems others;  // only a scene has a list of models, so the rest of the file is judged as a scene
    Reader rest(in.file(), others);
    detail::loadScene(root, rest, catalog, {.default_device = root.find("hand") != nullptr, .device_file = {}});
    for (Problem& one : others)
      if (nearestWord(one.key, {"hapticd"}).empty()) in.problems().push_back(std::move(one));
  } else if (format->table == &kSceneTable) {
    // If the scene names no arm, its hand is checked against the default arm of `hapticd run`.
    const bool default_arm = root.find("hand") != nullptr;
    auto loaded = detail::loadScene(root, in, catalog, {.default_device = default_arm, .device_file = {}});
    if (scene != nullptr) *scene = std::move(loaded);
  } else if (format->table == &kDeviceTable) {
    detail::loadDevice(root, in, {.file = in.file()}, catalog, nullptr, nullptr, nullptr);
  } else {
    detail::loadDaemon(root, in);
  }
}

}  // namespace

const Format* detail::formatOf(const Node& root) {
  for (const Format& format : kFormats)
    if (root.isMap() && root.find(format.key) != nullptr) return &format;
  return nullptr;
}

bool detail::isMeantAsDevice(const Node& root) {
  if (!root.isMap() || root.find("models") != nullptr || root.find("format") != nullptr) return false;
  const Format* format = formatOf(root);
  if (format != nullptr && format->table != &kSceneTable) return false;
  return root.find("module") != nullptr || root.find("parameters") != nullptr;
}

/// Reports that the key `hapticd-device` is missing in a file that can only be a device file. If a similar key was
/// given instead, the report stands at that key.
static void reportNoDeviceVersion(const Node& root, Reader& in) {
  for (const Entry& entry : root.entries) {
    if (entry.key.scalar == "hapticd")
      return in.problem(entry.key, "hapticd",
                        "this is the key of a scene, but the file has no models, and a module or parameters, so it "
                        "describes a device; expected hapticd-device: 1");
    if (!nearestWord(entry.key.scalar, {"hapticd-device"}).empty())
      return in.problem(entry.key, entry.key.scalar, "unknown key, expected hapticd-device: 1");
  }
  in.problem(root, "hapticd-device",
             "missing: this file describes a device, as it has a module or parameters; expected the first line "
             "hapticd-device: 1");
}

bool detail::hasFormat(const Node& root, const char* wanted, Reader& in) {
  if (!root.isMap()) {
    in.problem(root, "",
               describe(root) + ", expected a mapping that begins with " + (wanted ? wanted : "hapticd") + ": 1");
    return false;
  }
  const Format* format = formatOf(root);
  if (format != nullptr && (wanted == nullptr || std::string_view(format->key) == wanted)) return true;
  if (wanted != nullptr && std::string_view(wanted) == "hapticd-device" && isMeantAsDevice(root)) {
    reportNoDeviceVersion(root, in);
    return false;
  }
  std::string expected, name = "scene";
  for (const Format& known : kFormats) {
    if (wanted != nullptr && std::string_view(known.key) == wanted) name = known.name;
    expected += std::string(expected.empty() ? "" : ", ") + "\"" + known.key + ": 1\" (a " + known.name + ")";
  }
  if (format != nullptr) {
    in.problem(root, format->key, std::string("this is a ") + format->name + " file, expected a " + name + " file");
  } else if (root.find("format") != nullptr) {
    in.problem(root, "format",
               "this looks like a model file, which only its plugin reads; expected a " +
                   (wanted ? name : "scene, device or daemon") + " file that names it");
  } else {
    std::vector<std::string> keys;
    for (const Format& known : kFormats) keys.emplace_back(known.key);
    std::string meant;
    for (const Entry& entry : root.entries)
      if (meant.empty()) meant = document::suggestion(entry.key.scalar, keys);
    const std::string line = wanted ? "\"" + std::string(wanted) + ": 1\"" : "one of " + expected;
    in.problem(root, wanted ? wanted : "hapticd",
               "missing: the kind of this file is unknown, expected " + line + meant);
  }
  return false;
}

Loaded load(const std::filesystem::path& file, host::Catalog& catalog, const LoadOptions& options) {
  Loaded loaded;
  Reader in(file, loaded.problems);
  const auto root = readFileOn(file, loaded.problems);
  if (root && detail::hasFormat(*root, "hapticd", in)) loaded.scene = detail::loadScene(*root, in, catalog, options);
  if (!loaded.problems.empty()) loaded.scene.reset();
  dropFollowUps(loaded.problems);
  sortByPlace(loaded.problems);
  return loaded;
}

LoadedDevice loadDevice(const std::filesystem::path& file, host::Catalog& catalog) {
  LoadedDevice loaded;
  loaded.device = detail::loadDeviceFile({.file = file}, catalog, loaded.problems, nullptr, nullptr, nullptr);
  if (!loaded.problems.empty()) loaded.device.reset();
  dropFollowUps(loaded.problems);
  sortByPlace(loaded.problems);
  return loaded;
}

std::optional<Device> deviceDraft(const std::filesystem::path& file, host::Catalog& catalog) {
  Problems known;
  return detail::loadDeviceFile({.file = file}, catalog, known, nullptr, nullptr, nullptr);
}

std::optional<Scene> sceneDraft(const std::filesystem::path& file, host::Catalog& catalog) {
  Problems known;
  Reader in(file, known);
  const auto root = readFileOn(file, known);
  if (!root) return std::nullopt;
  const Format* format = detail::formatOf(*root);
  if (format == nullptr || format->table != &kSceneTable) return std::nullopt;
  return detail::loadScene(*root, in, catalog, {.default_device = true, .device_file = {}});
}

LoadedDaemon loadDaemon(const std::filesystem::path& file) {
  LoadedDaemon loaded;
  Reader in(file, loaded.problems);
  const auto root = readFileOn(file, loaded.problems);
  if (root && detail::hasFormat(*root, "hapticd-daemon", in)) loaded.daemon = detail::loadDaemon(*root, in);
  if (!loaded.problems.empty()) loaded.daemon.reset();
  dropFollowUps(loaded.problems);
  sortByPlace(loaded.problems);
  return loaded;
}

Problems checkFile(const std::filesystem::path& file, host::Catalog& catalog, std::optional<Scene>* scene) {
  Problems problems;
  const auto text = readFile(file, kMaxFileBytes, problems);
  return text ? checkText(*text, file, catalog, scene) : problems;
}

Problems checkText(const std::string& text, const std::filesystem::path& file, host::Catalog& catalog,
                   std::optional<Scene>* scene) {
  Problems problems;
  Reader in(file, problems);
  const auto root = readOn(text, file.string(), problems);
  if (root) checkRoot(*root, in, catalog, scene);
  if (scene != nullptr && !problems.empty()) scene->reset();
  dropFollowUps(problems);
  sortByPlace(problems);
  return problems;
}

}  // namespace hapticd::scene

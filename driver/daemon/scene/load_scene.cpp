// SPDX-License-Identifier: MIT
#include <algorithm>
#include <map>
#include <set>
#include <span>
#include <unordered_map>

#include "base/nearest_word.hpp"
#include "hapticd/shape.h"
#include "scene/kinematic_path.hpp"
#include "scene/loader.hpp"
#include "scene/parameters.hpp"

namespace hapticd::scene::detail {

using namespace document;
namespace {

constexpr std::string_view kMotions[] = {"static", "kinematic", "dynamic"};

std::vector<std::string> wordsOf(std::span<const std::string_view> words) {
  return {words.begin(), words.end()};
}

class SceneLoader {
 public:
  SceneLoader(Reader& in, host::Catalog& catalog, const LoadOptions& options)
      : in_(in), catalog_(catalog), options_(options) {}

  std::optional<Scene> load(const Node& root) {
    in_.object(root, "", kSceneTable, &text_);
    scene_.file = in_.file();
    scene_.servo = text_.servo;
    adoptParameters(root);
    scene_.models.reserve(text_.models.size());
    for (size_t i = 0; i < text_.models.size(); ++i) addModel(text_.models[i], "models[" + std::to_string(i) + "]");
    if (text_.clients != nullptr) readClients(*text_.clients);
    addDevices(root);
    return std::move(scene_);
  }

 private:
  /// Reads parameters at the top of the scene as those of the only model that has none. Their key was reported before.
  void adoptParameters(const Node& root) {
    const Node* parameters = root.find("parameters");
    const auto lacks = [](const ModelText& text) { return text.node->isMap() && text.parameters == nullptr; };
    const auto model = std::find_if(text_.models.begin(), text_.models.end(), lacks);
    if (parameters == nullptr || model == text_.models.end() || std::count_if(model, text_.models.end(), lacks) > 1)
      return;
    model->parameters = parameters;
  }

  void addModel(const ModelText& text, const std::string& key) {
    Model model;
    model.name = text.name;
    model.plugin = text.plugin;
    model.pose = text.pose;
    model.enabled = text.enabled;
    model.place = in_.place(*text.node);
    // This mistake was reported before. The empty model keeps the indices of the other models right.
    if (!text.node->isMap()) return scene_.models.push_back(std::move(model));
    checkName(text, key);
    if (const host::ClassInfo* info = pluginOf(text, key)) {
      model.plugin = info->name;  // for a misspelt plugin the nearest name, so that its parameters are judged too
      model.library = info->file;
      addParameters(text, key, *info, model);
    }
    scene_.models.push_back(std::move(model));
  }

  /// Returns the value of a key; the whole model if the key is misspelt.
  static const Node* valueOf(const ModelText& text, const char* key) {
    const Node* at = text.node->find(key);
    return at != nullptr ? at : text.node;
  }

  void checkName(const ModelText& text, const std::string& key) {
    if (text.name.empty()) return;
    const Node* at = valueOf(text, "name");
    const auto [first, is_new] = names_.emplace(text.name, at->line);
    if (!is_new)
      in_.problem(*at, key + ".name",
                  "\"" + text.name + "\" is the name of another model (line " + std::to_string(first->second) +
                      "), expected each name once");
  }

  /// Returns the plugin's table. Each name is looked up only once, so that ten thousand models of an unknown plugin
  /// give only one long message.
  const host::ClassInfo* pluginOf(const ModelText& text, const std::string& key) {
    if (text.plugin.empty()) return nullptr;
    const Node* at = valueOf(text, "plugin");
    const auto [known, is_new] = plugins_.try_emplace(text.plugin);
    if (is_new) {
      known->second.line = at->line;
      auto found = catalog_.shape(text.plugin);
      known->second.info = found ? *found : nearestPlugin(text.plugin);
      known->second.is_misspelt = !found;
      if (!found) in_.problem(*at, key + ".plugin", found.error());
    } else if (known->second.is_misspelt) {
      in_.problem(*at, key + ".plugin",
                  "there is no usable shape plugin \"" + text.plugin + "\" (see line " +
                      std::to_string(known->second.line) + ")");
    }
    return known->second.info;
  }

  /// Returns the plugin that a misspelt name probably means; nullptr if there is none.
  const host::ClassInfo* nearestPlugin(const std::string& name) {
    std::vector<std::string> names;
    for (const host::CatalogFile* file : catalog_.files(host::Kind::kShape))
      for (const host::ClassInfo& info : file->classes)
        if (info.kind == host::Kind::kShape) names.push_back(info.name);
    const std::string meant = nearestWord(name, names);
    const auto found = meant.empty() ? Result<const host::ClassInfo*>(nullptr) : catalog_.shape(meant);
    return found ? *found : nullptr;
  }

  void addParameters(const ModelText& text, const std::string& key, const host::ClassInfo& info, Model& model) {
    const std::string params_key = key + ".parameters";
    const Node* params = text.parameters != nullptr && text.parameters->isMap() ? text.parameters : nullptr;
    const int motion_index = info.indexOf("motion");
    const bool takes_path = motion_index >= 0 && info.indexOf("path") < 0;
    ParameterReader reader(in_, info);
    if (text.parameters != nullptr) reader.read(*text.parameters, params_key, "", takes_path ? "path" : "");
    readMisplaced(*text.node, key, info, reader);
    if (text.motion != nullptr) readMotion(*text.motion, key + ".motion", info, reader);
    if (text.parameters == nullptr || text.parameters->isMap())  // otherwise it is unknown what is missing
      reader.requireAll(text.parameters != nullptr ? *text.parameters : *text.node, params_key);
    model.parameters = reader.take();

    const Node* motion = text.motion;
    if (motion == nullptr && params != nullptr && motion_index >= 0) motion = params->find("motion");
    const Node* path = text.path;
    if (path == nullptr && params != nullptr && motion_index >= 0) path = params->find("path");
    model.kinematic = motion != nullptr && motion->isScalar() &&
                      (motion->scalar == "kinematic" ||
                       nearestWord(motion->scalar, {"dynamic", "kinematic", "static"}) == "kinematic");
    addPath(key, path, motion, model);
  }

  /// Reads the parameters of the plugin that stand beside `parameters`, as if they stood below it. Their keys were
  /// reported before; so their values are judged, too, and none of them is said to be missing.
  void readMisplaced(const Node& model, const std::string& key, const host::ClassInfo& info, ParameterReader& reader) {
    for (const Entry& entry : model.entries) {
      const int index = info.indexOf(entry.key.scalar);
      if (index < 0 || entry.value.isNull() || kModelTable.find(entry.key.scalar) != nullptr) continue;
      if (model.find(entry.key.scalar) == &entry.value)
        reader.readOne(entry.value, key + "." + entry.key.scalar, static_cast<uint32_t>(index));
    }
  }

  /// Reads the model's key `motion`. It is meant for the host, and also for the plugin if it has such a parameter.
  void readMotion(const Node& node, const std::string& key, const host::ClassInfo& info, ParameterReader& reader) {
    const int index = info.indexOf("motion");
    if (index >= 0) return reader.readOne(node, key, static_cast<uint32_t>(index));
    const auto choice = in_.choice(node, key, wordsOf(kMotions));
    if (choice && kMotions[*choice] != "dynamic" && (info.flags & HSP_C_MOVES) != 0)
      return in_.problem(node, key,
                         "plugin " + info.name + " moves the model by itself, so it is not " +
                             std::string(kMotions[*choice]) + "; expected no motion" +
                             (kMotions[*choice] == "kinematic" ? " and no path" : ""));
    if (choice && kMotions[*choice] == "dynamic" && (info.flags & HSP_C_MOVES) == 0)
      in_.problem(node, key,
                  "plugin " + info.name +
                      " does not move its models, so motion cannot be dynamic; expected static or kinematic");
  }

  /// Reads the file of a path, also for a model that does not follow it yet: the mistakes of both are reported.
  void addPath(const std::string& key, const Node* path, const Node* motion, Model& model) {
    if (path == nullptr) return;  // without a path, a kinematic model rests until a program leads it
    const bool dynamic = motion != nullptr && motion->scalar == "dynamic";
    if (!model.kinematic)
      in_.problem(*path, key + ".path",
                  "the model does not follow its path, because it is not kinematic; " +
                      (motion == nullptr ? "add motion: kinematic to the model"
                                         : "write motion: kinematic in line " + std::to_string(motion->line)),
                  ProblemKind::kUnusedValue);
    const auto file = in_.existingFile(*path, key + ".path");
    if (!file) return;
    std::vector<PathPoint> points = readKinematicPath(*file, in_.problems());
    if (dynamic) return;
    model.kinematic = true;  // as its path says; the scene is not used with this mistake
    model.path = std::move(points);
  }

  /// Reads `clients`: a mode alone, or a mapping that contains the mode.
  void readClients(const Node& node) {
    if (node.isMap()) return in_.object(node, "clients", kClientsTable, &scene_.clients);
    if (const auto mode = in_.choice(node, "clients", wordsOf(kClientModes)))
      scene_.clients.mode = static_cast<ClientMode>(*mode);
  }

  void addDevices(const Node& root) {
    if (!options_.device_file.empty()) {
      addDevice({.file = options_.device_file});
      return;
    }
    if (text_.device != nullptr && text_.devices == nullptr) addNamed(*text_.device, "device");
    if (text_.devices != nullptr) addList(*text_.devices);
    if (text_.device != nullptr && text_.devices != nullptr) refuseBoth(*text_.device);
    if (text_.device == nullptr && text_.devices == nullptr && options_.default_device) addDefault(root);
    if (text_.hand != nullptr && !scene_.devices.empty() && !hand_used_)
      in_.problem(*text_.hand, "hand",
                  "none of the scene's devices has a simulated hand; remove this key, or use a device whose module has "
                  "hand.* parameters");
    if (text_.hand != nullptr && scene_.devices.empty() && !hand_used_) checkHandAlone(*text_.hand);
  }

  /// Refuses a device beside a list of devices, and reports the problems of its file, unless the list names it too.
  void refuseBoth(const Node& node) {
    in_.problem(node, "device", "both device and devices are given, expected one of them");
    const DeviceReference reference = readReference(node, "device");
    if (reference.file.empty() || device_files_.contains(reference.file)) return;
    const size_t count = scene_.devices.size();
    addDevice(reference);
    scene_.devices.erase(scene_.devices.begin() + static_cast<std::ptrdiff_t>(count), scene_.devices.end());
  }

  /// Checks the hand of a scene whose device could not be read. Only simulated arms have a hand.
  void checkHandAlone(const Node& hand) {
    const auto simulated = catalog_.device("simulated");
    if (!simulated) return;
    ParameterReader reader(in_, **simulated);
    reader.read(hand, "hand", "hand");
  }

  void addList(const Node& list) {
    const std::vector<const Node*> elements = elementsOf(list);
    if (!list.isSequence() || elements.empty() || elements.size() > kMaxDevices)
      in_.problem(list, "devices",
                  (list.isSequence() ? "a list of " + std::to_string(elements.size()) : describe(list)) +
                      ", expected a list of 1 to " + std::to_string(kMaxDevices) + " device files" +
                      (list.isMap() ? "; begin each of them with \"- \", as an element of a list" : ""));
    for (size_t i = 0; i < std::min<size_t>(elements.size(), kMaxDevices); ++i)
      addNamed(*elements[i], "devices[" + std::to_string(i) + "]");
  }

  /// Adds a device: the node is a path, or a mapping with a path and the settings that this scene replaces.
  void addNamed(const Node& node, const std::string& key) {
    const DeviceReference reference = readReference(node, key);
    std::string name = reference.name;
    // A wrong key of the reference, such as its mount, hides nothing about the file.
    if (!reference.file.empty()) name = addDevice(reference);
    if (name.empty()) name = reference.name;
    if (!name.empty()) checkDeviceName(name, node, key);
  }

  /// Reads the path of a device file, or a mapping with it; the reference has no file if there is none.
  DeviceReference readReference(const Node& node, const std::string& key) {
    DeviceReference reference;
    if (node.isMap()) {
      in_.object(node, key, kDeviceReferenceTable, &reference);
      reference.named_at = node.find("file");
      reference.key = key + ".file";
    } else if (const auto file = in_.existingFile(node, key)) {
      reference.file = *file;
      reference.named_at = &node;
      reference.key = key;
    }
    return reference;
  }

  void checkDeviceName(const std::string& name, const Node& node, const std::string& key) {
    if (!device_names_.insert(name).second)
      in_.problem(node, key,
                  "another device is named \"" + name +
                      "\" too, expected different names: write {file: FILE, name: NAME} in place of one path");
  }

  void addDefault(const Node& root) {
    const auto file = host::shippedFile(kDefaultDevice);
    if (!file)
      return in_.problem(root, "device",
                         std::string("the scene names no device, and the default device file (") + kDefaultDevice +
                             ") is not installed; add device: FILE");
    addDevice({.file = *file});
    if (!scene_.devices.empty()) scene_.devices.back().chosen_by_default = true;
  }

  /// Adds a device. @return its name; "" if its file has problems
  std::string addDevice(const DeviceReference& reference) {
    bool has_hand = false;
    device_files_.insert(reference.file);
    auto device = loadDeviceFile(reference, catalog_, in_.problems(), &in_, text_.hand, &has_hand);
    hand_used_ = hand_used_ || has_hand;
    if (!device) return "";
    scene_.devices.push_back(*std::move(device));
    return scene_.devices.back().name;
  }

  struct Known {
    const host::ClassInfo* info = nullptr;
    bool is_misspelt = false;  ///< true if info belongs to the nearest name, or is nullptr
    int line = 0;
  };
  Reader& in_;
  host::Catalog& catalog_;
  const LoadOptions& options_;
  SceneText text_;
  Scene scene_;
  std::unordered_map<std::string, int> names_;
  std::map<std::string, Known> plugins_;
  std::set<std::string> device_names_;            ///< also of devices that have problems
  std::set<std::filesystem::path> device_files_;  ///< also of these
  bool hand_used_ = false;
};

}  // namespace

std::optional<Scene> loadScene(const Node& root, Reader& in, host::Catalog& catalog, const LoadOptions& options) {
  return SceneLoader(in, catalog, options).load(root);
}

}  // namespace hapticd::scene::detail

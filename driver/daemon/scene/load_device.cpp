// SPDX-License-Identifier: MIT
#include <algorithm>

#include "base/nearest_word.hpp"
#include "document/suggestion.hpp"
#include "hapticd/device.h"
#include "host/shipped.hpp"
#include "scene/loader.hpp"
#include "scene/misplaced_parameters.hpp"
#include "scene/parameters.hpp"

namespace hapticd::scene::detail {

using namespace document;
namespace {

constexpr std::string_view kHand = "hand.";

bool hasHand(const host::ClassInfo& info) {
  return std::any_of(info.params.begin(), info.params.end(),
                     [](const host::ParamInfo& p) { return p.id.compare(0, kHand.size(), kHand) == 0; });
}

void readHand(const Node& node, const std::string& key, const host::ClassInfo& info, Reader& in,
              ParameterReader& reader) {
  if (hasHand(info))
    reader.read(node, key, "hand");
  else
    in.problem(
        node, key,
        "module " + info.name +
            " has no simulated hand; remove this key, or use a module with hand.* parameters, such as simulated");
}

constexpr size_t kHdJoints = 6, kHdButtons = 32;

/// Reads [joint, sign, offset]; sign and offset may be left out.
HdJoint readHdJoint(const Node& node, const std::string& key, Reader& in) {
  HdJoint joint;
  if (!node.isSequence() || node.items.empty() || node.items.size() > 3) {
    in.problem(node, key, describe(node) + ", expected [joint, sign, offset], such as [0, -1, 0]");
    return joint;
  }
  if (const auto index = in.whole(node.items[0], key + "[0]", {0, HDV_MAX_JOINTS - 1}))
    joint.joint = static_cast<uint32_t>(*index);
  if (node.items.size() > 1)
    if (const auto sign = in.whole(node.items[1], key + "[1]", {-1, 1})) joint.sign = *sign;
  if (joint.sign == 0) in.problem(node.items[1], key + "[1]", "0, expected 1 or -1");
  if (node.items.size() > 2)
    if (const auto offset = in.number(node.items[2], key + "[2]", {-10, 10, "rad"})) joint.offset = *offset;
  return joint;
}

/// Reports a problem and returns false if the node is not a list of at most `most` items.
bool isShortList(const Node& list, const std::string& key, size_t most, const char* of, Reader& in) {
  if (list.isSequence() && list.items.size() <= most) return true;
  in.problem(list, key,
             (list.isSequence() ? "a list of " + std::to_string(list.items.size()) : describe(list)) +
                 ", expected a list of up to " + std::to_string(most) + " " + of);
  return false;
}

HdArm readHd(const HdText& text, Reader& in) {
  HdArm arm{text.model, text.vendor, text.serial, {}, {}};
  if (text.joints != nullptr && isShortList(*text.joints, "hd.joints", kHdJoints, "lists [joint, sign, offset]", in))
    for (size_t i = 0; i < text.joints->items.size(); ++i)
      arm.joints.push_back(readHdJoint(text.joints->items[i], "hd.joints[" + std::to_string(i) + "]", in));
  if (text.buttons != nullptr && isShortList(*text.buttons, "hd.buttons", kHdButtons, "buttons", in))
    for (size_t i = 0; i < text.buttons->items.size(); ++i)
      if (const auto button = in.whole(text.buttons->items[i], "hd.buttons[" + std::to_string(i) + "]",
                                       {0, static_cast<double>(kHdButtons - 1)}))
        arm.buttons.push_back(static_cast<uint32_t>(*button));
  return arm;
}

/// Refuses a limit of 0 N, because it may mean "no force", while 0 means "no limit" for other limits.
void refuseNoForce(const Node& root, Reader& in) {
  const Node* limits = root.find("limits");
  const Node* force = limits != nullptr && limits->isMap() ? limits->find("force") : nullptr;
  if (force == nullptr || !force->isScalar() || document::toNumber(force->scalar) != 0.0) return;
  in.problem(*force, "limits.force",
             "0 N is not a limit that an arm can keep; expected a number above 0, such as 0.5 to begin with. Leave "
             "the key out for the device's own maximum. To run without any force, write models: [] in the scene");
}

/// Counts the values below `node` whose keys are parameters of a module.
size_t knownKeys(const Node& node, const std::string& key, const host::ClassInfo& info) {
  if (!key.empty() && info.indexOf(key) >= 0) return 1;
  size_t count = 0;
  if (node.isMap())
    for (const Entry& entry : node.entries)
      count += knownKeys(entry.value, key.empty() ? entry.key.scalar : key + "." + entry.key.scalar, info);
  return count;
}

/// Returns whether one name is the beginning or the end of the other: hid means usb_hid, and vme_bus means vme.
bool partOf(const std::string& a, const std::string& b) {
  const std::string &part = a.size() < b.size() ? a : b, &whole = a.size() < b.size() ? b : a;
  return part.size() > 2 && (whole.starts_with(part) || whole.ends_with(part));
}

/// Returns the module that an unknown name probably stands for, so that the other problems of the file are found too.
/// It is the module with the nearest name. Otherwise it is the module that has most of the given parameters, at least
/// three, and among these one that shares a part of its name. Otherwise it is any module that shares a part of its
/// name.
std::string suggestModule(const std::string& name, const Node* parameters, host::Catalog& catalog) {
  constexpr size_t kEnough = 3, kAlike = 1000;  // known parameters; more than any module has
  const std::vector<std::string> names = catalog.names(host::Kind::kDevice);
  std::string best = nearestWord(name, names);
  if (!best.empty() || parameters == nullptr) return best;
  size_t most = 0;
  for (const std::string& one : names) {
    const auto info = catalog.device(one);
    if (!info) continue;
    const bool alike = partOf(name, one);
    size_t known = knownKeys(*parameters, "", **info);
    if (known < kEnough) known = alike ? 1 : 0;
    if (alike && known >= kEnough) known += kAlike;
    if (known > most) best = one, most = known;
  }
  return best;
}

/// Adds the names of the available modules to the message that the key `module` is missing.
void nameModules(const std::string& as, host::Catalog& catalog, Reader& in) {
  for (Problem& one : in.problems())
    if (one.key == "module" && one.place.file == in.file().string())
      one.what += ": one of " + document::listed(catalog.names(host::Kind::kDevice)) + as;
}

/// Says what the workspace is, if a file gives a box or a sphere for it.
void explainWorkspace(const Node& root, Reader& in) {
  const Node* limits = root.find("limits");
  const Node* given = limits != nullptr && limits->isMap() ? limits->find("workspace") : nullptr;
  if (given == nullptr || given->isScalar()) return;
  for (Problem& one : in.problems())
    if (one.key == "limits.workspace" && one.place.file == in.file().string())
      one.what += ": one radius about the origin of the device frame, outside of which forces fade";
}

/// Returns how many of the keys of `parameters` a module knows.
size_t knownOf(const Node& parameters, const host::ClassInfo& info) {
  return static_cast<size_t>(
      std::count_if(parameters.entries.begin(), parameters.entries.end(), [&info](const auto& entry) {
        const std::string id = entry.key.scalar, group = id + ".";
        return std::any_of(info.params.begin(), info.params.end(),
                           [&](const host::ParamInfo& param) { return param.id == id || param.id.starts_with(group); });
      }));
}

/// Warns once that the parameters are those of a simulated arm, as in the file of a twin whose module was replaced.
void tellOfSimulated(const Node& root, const Node& parameters, const host::ClassInfo& info, host::Catalog& catalog,
                     Reader& in) {
  const Node* module = root.find("module");
  if (module == nullptr || !parameters.isMap() || parameters.find("wire") != nullptr) return;
  const size_t all = parameters.entries.size();
  if (knownOf(parameters, info) == all && (root.find("hand") == nullptr || hasHand(info))) return;
  const auto simulated = catalog.device("simulated");
  if (!simulated || *simulated == &info || knownOf(parameters, **simulated) != all) return;
  in.problem(*module, "module",
             "is " + info.name + ", but these are parameters of simulated; expected module: simulated");
}

/// Finds the module of a device file. If its name is unknown or missing, this function reports that, and returns the
/// module that is probably meant, so that the other problems are found too. @return nullptr if there is none
const host::ClassInfo* moduleOf(const Node& root, const DeviceText& text, Reader& in, host::Catalog& catalog) {
  std::string unknown;
  if (!text.module.empty()) {
    const auto found = catalog.device(text.module);
    if (found) return *found;
    unknown = found.error();
  }
  // If hapticd has this module but it is not built here, its parameters cannot be judged; no other module fits them.
  const std::string meant =
      host::shipsName(host::Kind::kDevice, text.module) ? "" : suggestModule(text.module, text.parameters, catalog);
  const std::string as = meant.empty() ? "" : "\n  the parameters are judged as those of " + meant;
  const Node* at = root.find("module");  // nullptr if the key is misspelt
  if (text.module.empty())
    nameModules(as, catalog, in);
  else
    in.problem(at != nullptr ? *at : root, "module", unknown + as);
  const auto found = meant.empty() ? Result<const host::ClassInfo*>(nullptr) : catalog.device(meant);
  return found ? *found : nullptr;
}

}  // namespace

std::optional<Device> loadDevice(const Node& root, Reader& in, const DeviceReference& reference, host::Catalog& catalog,
                                 Reader* scene_in, const Node* hand, bool* has_hand) {
  DeviceText text;
  in.object(root, "", kDeviceTable, &text);
  Device device;
  device.file = in.file();
  device.place = in.place(root);
  device.name = !reference.name.empty() ? reference.name : !text.name.empty() ? text.name : in.file().stem().string();
  device.mount = reference.mount.value_or(text.mount);
  device.limits = text.limits;
  refuseNoForce(root, in);
  explainWorkspace(root, in);
  device.admittance = reference.admittance ? reference.admittance : text.admittance;
  if (text.hd) device.hd = readHd(*text.hd, in);
  const host::ClassInfo* found = moduleOf(root, text, in, catalog);
  if (found == nullptr) return std::nullopt;
  const host::ClassInfo& info = *found;
  device.module = info.name;
  device.library = info.file;
  if (has_hand != nullptr) *has_hand = hasHand(info);
  ParameterReader reader(in, info);
  placeParameters(root, info, in);
  if (text.parameters != nullptr) tellOfSimulated(root, *text.parameters, info, catalog, in);
  if (text.parameters != nullptr) reader.read(*text.parameters, "parameters");
  if (text.hand != nullptr) readHand(*text.hand, "hand", info, in, reader);
  if (scene_in != nullptr && hand != nullptr && hasHand(info)) {
    reader.overrideFrom(*scene_in);
    reader.read(*hand, "hand", "hand");
  }
  if (scene_in != nullptr && reference.hand != nullptr) {
    reader.overrideFrom(*scene_in);
    readHand(*reference.hand, "hand", info, *scene_in, reader);
  }
  reader.requireAll(text.parameters != nullptr ? *text.parameters : root, "parameters");
  device.parameters = reader.take();
  return device;
}

std::optional<Device> loadMeantDevice(const Node& root, Reader& in, const DeviceReference& reference,
                                      host::Catalog& catalog) {
  Problems others;
  Reader rest(in.file(), others);
  std::optional<Device> device = loadDevice(root, rest, reference, catalog, nullptr, nullptr, nullptr);
  for (Problem& one : others)  // the version itself is reported already
    if (nearestWord(one.key, {"hapticd-device"}).empty() && one.key != "hapticd")
      in.problems().push_back(std::move(one));
  return device;
}

/// Reports that a scene names a file of another kind as its device. The mistake is in the scene, not in that file.
static bool refuseOtherKind(const Node& root, const DeviceReference& reference, Reader& scene_in) {
  const Format* format = formatOf(root);
  const bool model = root.isMap() && format == nullptr && root.find("format") != nullptr;
  if (!model && (format == nullptr || format->table == &kDeviceTable || isMeantAsDevice(root))) return false;
  scene_in.problem(*reference.named_at, reference.key,
                   reference.file.filename().string() + " is a " + (model ? "model" : format->name) +
                       " file, expected a device file" +
                       (model ? "; a plugin reads a model file: parameters: {geometry: FILE} of a model" : ""));
  return true;
}

std::optional<Device> loadDeviceFile(const DeviceReference& reference, host::Catalog& catalog, Problems& problems,
                                     Reader* scene_in, const Node* hand, bool* has_hand) {
  Reader in(reference.file, problems);
  const auto root = readFileOn(reference.file, problems);
  if (!root) return std::nullopt;
  if (scene_in != nullptr && reference.named_at != nullptr && refuseOtherKind(*root, reference, *scene_in))
    return std::nullopt;
  if (!hasFormat(*root, "hapticd-device", in))
    return isMeantAsDevice(*root) ? loadMeantDevice(*root, in, reference, catalog) : std::nullopt;
  return loadDevice(*root, in, reference, catalog, scene_in, hand, has_hand);
}

std::optional<Daemon> loadDaemon(const Node& root, Reader& in) {
  DaemonText text;
  in.object(root, "", kDaemonTable, &text);
  text.daemon.file = in.file();
  if (text.plugin_path == nullptr) return text.daemon;
  if (!text.plugin_path->isSequence()) {
    in.problem(*text.plugin_path, "plugin_path", describe(*text.plugin_path) + ", expected a list of folders");
    return text.daemon;
  }
  for (size_t i = 0; i < text.plugin_path->items.size(); ++i) {
    const Node& item = text.plugin_path->items[i];
    std::error_code error;
    const auto full = std::filesystem::absolute(in.file().parent_path() / item.scalar, error).lexically_normal();
    if (!item.isScalar() || !std::filesystem::is_directory(full, error))
      in.problem(
          item, "plugin_path[" + std::to_string(i) + "]",
          (item.isScalar() ? full.string() + " is not a folder" : describe(item)) + ", expected the path of a folder");
    else
      text.daemon.plugin_path.push_back(full);
  }
  return text.daemon;
}

}  // namespace hapticd::scene::detail

// SPDX-License-Identifier: MIT
/// The tables of the keys of the three file formats, and the plain structs into which the reader writes the values.
/// load.cpp checks what the values mean.
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "description/scene.hpp"
#include "document/table.hpp"
#include "scene/daemon.hpp"

namespace hapticd::scene {

using document::Node;
using document::Table;

/// Largest numbers of models and of arms (one probe each) in one scene.
constexpr uint32_t kMaxModels = 20000, kMaxDevices = 8;

struct ModelText {
  const Node* node = nullptr;
  std::string name, plugin;
  Pose pose;
  bool enabled = true;
  const Node *parameters = nullptr, *motion = nullptr, *path = nullptr;
};

/// An arm in a scene file: the path of its device file, and the settings that the scene replaces.
struct DeviceReference {
  std::filesystem::path file{};
  std::string name{};
  std::optional<Pose> mount = std::nullopt;
  const Node* hand = nullptr;
  std::optional<Admittance> admittance = std::nullopt;
  const Node* named_at = nullptr;  ///< where the scene names the file; nullptr if no scene names it
  std::string key{};               ///< key of that place
};

struct SceneText {
  int version = 0;
  Servo servo;
  const Node *device = nullptr, *devices = nullptr, *hand = nullptr, *clients = nullptr;
  std::vector<ModelText> models;
};

/// The modes of `clients`, in the order of ClientMode.
inline constexpr std::string_view kClientModes[] = {"off", "add", "instead"};

/// The key `hd` of a device file: how HDAPI programs see the arm. The lists in it are read later.
struct HdText {
  std::string model, vendor, serial;
  const Node *joints = nullptr, *buttons = nullptr;
};

struct DeviceText {
  int version = 0;
  std::string name, module;
  Pose mount;
  Limits limits;
  std::optional<Admittance> admittance;
  const Node *parameters = nullptr, *hand = nullptr;
  std::optional<HdText> hd;
};

struct DaemonText {
  int version = 0;
  Daemon daemon;
  const Node* plugin_path = nullptr;
};

extern const Table kSceneTable, kModelTable, kClientsTable, kDeviceReferenceTable, kDeviceTable, kDaemonTable;

/// A format, and the key with which its files begin.
struct Format {
  const char* key;   ///< such as "hapticd"
  const char* name;  ///< such as "scene"
  const char* doc;
  const Table* table;
};
extern const std::span<const Format> kFormats;

}  // namespace hapticd::scene

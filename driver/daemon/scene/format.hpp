// SPDX-License-Identifier: MIT
/// The three file formats as tables, and the plain structs that reading fills. Meaning is checked later (load.cpp).
#pragma once
#include <optional>
#include <vector>

#include "description/scene.hpp"
#include "document/table.hpp"
#include "scene/daemon.hpp"

namespace hapticd::scene {

using document::Node;
using document::Table;

/// Most models of one scene, and most arms (one probe each).
constexpr double kMaxModels = 20000, kMaxDevices = 8;

struct ModelText {
  const Node* node = nullptr;
  std::string name, plugin;
  Pose pose;
  const Node *parameters = nullptr, *motion = nullptr, *path = nullptr;
};

/// An arm as the scene names it: its file, and the settings that this scene overrides.
struct DeviceReference {
  std::filesystem::path file;
  std::string name;
  std::optional<Pose> mount;
  const Node* hand = nullptr;
  std::optional<Admittance> admittance = std::nullopt;
};

struct SceneText {
  int version = 0;
  Servo servo;
  const Node *device = nullptr, *devices = nullptr, *hand = nullptr, *clients = nullptr;
  std::vector<ModelText> models;
};

/// The modes of `clients`, in the order of ClientMode.
inline constexpr std::string_view kClientModes[] = {"off", "add", "instead"};

/// How programs of the HDAPI see the arm; its lists are read later.
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
  const char* key;   ///< "hapticd"
  const char* name;  ///< "scene"
  const char* doc;
  const Table* table;
};
extern const std::span<const Format> kFormats;

}  // namespace hapticd::scene

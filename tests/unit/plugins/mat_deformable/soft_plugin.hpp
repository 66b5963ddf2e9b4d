// SPDX-License-Identifier: MIT
/// The plugin through its C ABI alone, as the host uses it.
#pragma once
#include <gtest/gtest.h>
#include <unistd.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "hapticd/shape.h"

namespace hapticd::test {

using Eigen::Vector3d;

class Plugin {
 public:
  explicit Plugin(const std::string& geometry = "soft-plate.yaml") {
    host_.struct_size = sizeof host_;
    host_.log = [](const hsp_host*, int32_t level, const char* text) {
      if (level >= HSP_LOG_WARNING) printf("%s\n", text);
    };
    shape_ = kind().create(&kind(), &host_);
    set("geometry", geometry[0] == '/' ? geometry : HAPTICD_SOURCE_DIR "/config/models/" + geometry);
  }
  ~Plugin() {
    kind().deactivate(shape_);
    kind().destroy(shape_);
  }

  hsp_status set(const char* id, double number) { return put(id, {0, 0, number, nullptr, nullptr}); }
  hsp_status set(const char* id, const std::string& text) { return put(id, {0, 0, 0, text.c_str(), nullptr}); }
  hsp_status activate(uint32_t probes = 1) {
    hsp_activation activation{};
    activation.struct_size = sizeof activation;
    activation.max_probes = probes;
    report = {};
    report.struct_size = sizeof report;
    return kind().activate(shape_, &activation, &report);
  }
  template <class Extension>
  const Extension& extension(const char* name) {
    return *static_cast<const Extension*>(kind().extension(shape_, name));
  }
  double energy() { return extension<hsp_ext_energy>(HSP_EXT_ENERGY).stored(shape_); }
  hsp_shape* handle() { return shape_; }

  /// The search of the simulation side, for probe `i`.
  void search(const Vector3d& p, uint32_t i = 0) {
    const auto& surfaces = extension<hsp_ext_surfaces>(HSP_EXT_SURFACES);
    hsp_near near{};
    if (surfaces.nearby(shape_, p.data(), 0.15, &near, 1) != 1) return;
    near.probe = i;
    EXPECT_EQ(surfaces.activate(shape_, &near), HSP_OK);
  }
  std::vector<hsp_contact> step(const std::vector<Vector3d>& at, const Vector3d& velocity = Vector3d::Zero(),
                                double dt = 1e-3, uint32_t flags = 0) {
    std::vector<hsp_probe> probes(at.size());
    std::vector<hsp_contact> contacts(at.size());
    time_ += dt;
    for (std::size_t i = 0; i < at.size(); ++i) {
      Eigen::Map<Vector3d>(probes[i].position) = at[i];
      Eigen::Map<Vector3d>(probes[i].velocity) = velocity;
      probes[i].time_ns = static_cast<uint64_t>(1e9 * time_);
      probes[i].flags = flags;
    }
    hsp_step step{};
    step.struct_size = sizeof step;
    step.count = static_cast<uint32_t>(at.size());
    step.in = probes.data();
    step.out = contacts.data();
    step.in_stride = sizeof(hsp_probe);
    step.out_stride = sizeof(hsp_contact);
    step.dt_s = dt;
    step.viz_xyz = viz.empty() ? nullptr : viz.data();
    step.viz_capacity = static_cast<uint32_t>(viz.size() / 3);
    status = kind().step(shape_, &step);
    return contacts;
  }
  hsp_contact touch(const Vector3d& p, const Vector3d& velocity = Vector3d::Zero()) { return step({p}, velocity)[0]; }
  void rest(double seconds) { time_ += seconds; }

  hsp_status status = HSP_OK;
  hsp_report report{};
  std::vector<float> viz;  ///< where steps write vertices, while it is not empty

 private:
  static const hsp_class& kind() { return *hsp_plugin_entry.classes[0]; }
  hsp_status put(const char* id, hsp_value value) {
    for (uint32_t i = 0; i < kind().param_count; ++i) {
      if (std::strcmp(kind().params[i].id, id) != 0) continue;
      value.kind = kind().params[i].kind;
      return kind().set(shape_, i, &value);
    }
    return HSP_E_ARG;
  }
  hsp_host host_{};
  hsp_shape* shape_ = nullptr;
  double time_ = 0;
};

inline Vector3d forceOf(const hsp_contact& contact) {
  return Vector3d(contact.force);
}

/// Random motions a case: HAPTICD_MOTIONS in the environment, or so many.
inline int motions(int usual) {
  const char* asked = std::getenv("HAPTICD_MOTIONS");
  return asked != nullptr ? std::max(1, std::atoi(asked)) : usual;
}

/// A file that is gone when the test is over.
class TemporaryFile {
 public:
  TemporaryFile(const std::string& name, const std::string& text)
      : path_(std::filesystem::temp_directory_path() / (std::to_string(::getpid()) + "-" + name)) {
    std::ofstream(path_) << text;
  }
  ~TemporaryFile() { std::filesystem::remove(path_); }
  std::string path() const { return path_.string(); }

 private:
  std::filesystem::path path_;
};

}  // namespace hapticd::test

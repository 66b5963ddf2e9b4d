// SPDX-License-Identifier: MIT
/// A shape plugin through its C ABI alone, as the host uses it: it traces what is near, keeps the pose and gives
/// positions and velocities relative to it.
#pragma once
#include <Eigen/Geometry>
#include <cstring>
#include <initializer_list>
#include <string>
#include <vector>

#include "hapticd/shape.h"

namespace hapticd::test {

using Eigen::Vector3d;

class PluginUnderTest {
 public:
  PluginUnderTest() {
    host_.struct_size = sizeof host_;
    host_.ctx = this;
    host_.log = [](const hsp_host* host, int32_t, const char* text) {
      static_cast<PluginUnderTest*>(host->ctx)->log += std::string(text) + "\n";
    };
    shape_ = kind().create(&kind(), &host_);
    pose.orientation[0] = 1;
  }
  ~PluginUnderTest() {
    kind().deactivate(shape_);
    kind().destroy(shape_);
  }
  PluginUnderTest(const PluginUnderTest&) = delete;
  PluginUnderTest& operator=(const PluginUnderTest&) = delete;

  hsp_status set(const char* id, double number) { return put(id, {0, 0, number, nullptr, nullptr}); }
  hsp_status set(const char* id, const std::string& text) { return put(id, {0, 0, 0, text.c_str(), nullptr}); }
  hsp_status set(const char* id, const std::vector<double>& numbers) {
    return put(id, {0, static_cast<uint32_t>(numbers.size()), 0, nullptr, numbers.data()});
  }
  hsp_status set(const char* id, std::initializer_list<double> numbers) {
    return set(id, std::vector<double>(numbers));
  }
  hsp_status activate(uint32_t probes = 1, double rate = 1000, const Vector3d& gravity = {0, -9.81, 0}) {
    hsp_activation activation{};
    activation.struct_size = sizeof activation;
    activation.max_probes = probes;
    activation.rate_hz = rate;
    for (int i = 0; i < 3; ++i) activation.gravity[i] = gravity[i];
    activation.pose = pose;
    report.struct_size = sizeof report;
    period_ = 1 / rate;
    return kind().activate(shape_, &activation, &report);
  }

  std::vector<uint32_t> own_flags;  ///< of each probe, besides those that tick() is given

  /// One tick with probes at world positions and velocities; the first has dt = 0.
  void tick(const std::vector<Vector3d>& positions, const std::vector<Vector3d>& velocities = {}, uint32_t flags = 0) {
    search(positions);
    const Eigen::Quaterniond turn(pose.orientation[0], pose.orientation[1], pose.orientation[2], pose.orientation[3]);
    const Vector3d origin(pose.position);
    std::vector<hsp_probe> probes(positions.size());
    for (size_t i = 0; i < positions.size(); ++i) {
      const Vector3d arm = positions[i] - origin;
      Vector3d relative = i < velocities.size() ? velocities[i] : Vector3d::Zero();
      relative -= Vector3d(pose.linear) + Vector3d(pose.angular).cross(arm);
      Eigen::Map<Vector3d>(probes[i].position) = turn.conjugate() * arm;
      if ((report.flags & HSP_R_VELOCITY) != 0) Eigen::Map<Vector3d>(probes[i].velocity) = turn.conjugate() * relative;
      probes[i].orientation[0] = 1;
      probes[i].flags = flags | (i < own_flags.size() ? own_flags[i] : 0);
    }
    contacts.assign(positions.size(), hsp_contact{});
    hsp_step step{};
    step.struct_size = sizeof step;
    step.count = static_cast<uint32_t>(positions.size());
    step.in = probes.data();
    step.in_stride = sizeof(hsp_probe);
    step.out = contacts.data();
    step.out_stride = sizeof(hsp_contact);
    step.dt_s = started_ ? period_ : 0;
    step.pose = &pose;
    started_ = true;
    status = kind().step(shape_, &step);
  }
  /// Force on a probe in the last tick, world frame.
  Vector3d force(size_t probe = 0) const {
    const Eigen::Quaterniond turn(pose.orientation[0], pose.orientation[1], pose.orientation[2], pose.orientation[3]);
    return turn * Vector3d(contacts[probe].force);
  }
  Vector3d position() const { return Vector3d(pose.position); }
  double energy() {
    const auto* extension = static_cast<const hsp_ext_energy*>(kind().extension(shape_, HSP_EXT_ENERGY));
    return extension->stored(shape_);
  }
  void reset() { kind().reset(shape_); }
  bool has(const char* extension) { return kind().extension(shape_, extension) != nullptr; }
  static const hsp_class& kind() { return *hsp_plugin_entry.classes[0]; }

  hsp_pose pose{};
  hsp_report report{};
  hsp_status status = HSP_OK;
  std::vector<hsp_contact> contacts;
  std::string log;

 private:
  void search(const std::vector<Vector3d>& positions) {
    const auto* surfaces = static_cast<const hsp_ext_surfaces*>(kind().extension(shape_, HSP_EXT_SURFACES));
    const Eigen::Quaterniond turn(pose.orientation[0], pose.orientation[1], pose.orientation[2], pose.orientation[3]);
    for (uint32_t probe = 0; probe < positions.size(); ++probe) {
      const Vector3d at = turn.conjugate() * (positions[probe] - Vector3d(pose.position));
      hsp_near near[16];
      const int64_t count = surfaces->nearby(shape_, at.data(), 0.15, near, 16);
      for (int64_t i = 0; i < count && i < 16; ++i) {
        near[i].probe = probe;
        surfaces->activate(shape_, &near[i]);
      }
    }
  }
  hsp_status put(const char* id, hsp_value value) {
    for (uint32_t i = 0; i < kind().param_count; ++i)
      if (std::strcmp(kind().params[i].id, id) == 0) {
        value.kind = kind().params[i].kind;
        return kind().set(shape_, i, &value);
      }
    return HSP_E_ARG;
  }

  hsp_host host_{};
  hsp_shape* shape_ = nullptr;
  double period_ = 1e-3;
  bool started_ = false;
};

inline const std::string kModels = HAPTICD_SOURCE_DIR "/config/models/";

}  // namespace hapticd::test

// SPDX-License-Identifier: MIT
/// The built module `simulated`, driven through its C ABI as the host does it.
#pragma once
#include <dlfcn.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cstring>
#include <string>
#include <vector>

#include "hapticd/device.h"
#include "hapticd/device_pace.h"

namespace hapticd::simulated {

class Module {
 public:
  Module() {
    host_.struct_size = sizeof host_;
    host_.ctx = this;
    host_.log = [](const hsp_host* host, int32_t, const char* text) { static_cast<Module*>(host->ctx)->said = text; };
    void* library = dlopen(SIMULATED_MODULE, RTLD_NOW | RTLD_LOCAL);
    const auto* entry = library ? static_cast<const hdv_entry*>(dlsym(library, "hdv_module_entry")) : nullptr;
    if (entry == nullptr) throw std::runtime_error(dlerror());
    class_ = entry->classes[0];
    device_ = class_->create(class_, &host_);
    set("hand.tremor", 0.0), set("hand.wander", 0.0);
  }
  ~Module() {
    class_->close(device_);
    class_->destroy(device_);
  }
  Module(const Module&) = delete;
  Module& operator=(const Module&) = delete;

  hsp_status set(const std::string& id, double number) { return assign(id, number, nullptr, {}); }
  hsp_status set(const std::string& id, const std::vector<double>& numbers) { return assign(id, 0, nullptr, numbers); }

  hsp_status start(double gravity = 9.81) {
    info.struct_size = sizeof info;
    const hsp_status opened = class_->open(device_, &info);
    if (opened < 0) return opened;
    kinematics = static_cast<const hdv_ext_kinematics*>(class_->extension(device_, HDV_EXT_KINEMATICS));
    hdv_start how{};
    how.struct_size = sizeof how;
    how.rate_hz = 1000;
    how.time_ns = 1000;
    how.gravity[1] = -gravity;
    now_ns = how.time_ns;
    return class_->start(device_, &how);
  }

  /// Reads `ns` later; the sample stays in `sample`.
  const hdv_sample& read(uint64_t ns) {
    now_ns += ns;
    EXPECT_EQ(class_->read(device_, now_ns, &sample), HSP_OK);
    return sample;
  }
  /// When the next sample is due, as a loop that waits for it asks.
  uint64_t nextSample(uint64_t until_ns) {
    return static_cast<const hdv_ext_pace*>(class_->extension(device_, HDV_EXT_PACE))->wait(device_, until_ns);
  }
  void write(uint32_t mode, const Eigen::VectorXd& torque) {
    hdv_command command{};
    command.struct_size = sizeof command;
    command.mode = mode;
    for (int i = 0; i < torque.size(); ++i) command.torque[i] = torque[i];
    write(command);
  }
  void write(const hdv_command& command) { EXPECT_EQ(class_->write(device_, now_ns, &command), HSP_OK); }

  Eigen::VectorXd joints() const { return Eigen::Map<const Eigen::VectorXd>(sample.position, info.joint_count); }
  Eigen::Vector3d tip() const {
    Eigen::Vector3d p;
    double orientation[4];
    EXPECT_EQ(kinematics->forward(device_, sample.position, p.data(), orientation), HSP_OK);
    return p;
  }
  /// J^T f + gravity: what the host sends for a force on the hand.
  Eigen::VectorXd torqueOf(const Eigen::Vector3d& force) const {
    const auto n = static_cast<Eigen::Index>(info.joint_count);
    Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::RowMajor> J(6, n);
    Eigen::VectorXd tau(n);
    const double gravity[3] = {0, -9.81, 0};
    EXPECT_EQ(kinematics->jacobian(device_, sample.position, J.data()), HSP_OK);
    EXPECT_EQ(kinematics->gravity(device_, sample.position, gravity, tau.data()), HSP_OK);
    return tau + J.topRows<3>().transpose() * force;
  }

  /// The extension that leads the hand.
  const hdv_ext_hand& hand() const {
    return *static_cast<const hdv_ext_hand*>(class_->extension(device_, HDV_EXT_HAND));
  }
  hdv_device* handle() const { return device_; }

  hdv_info info{};
  hdv_sample sample{};
  const hdv_ext_kinematics* kinematics = nullptr;
  uint64_t now_ns = 0;
  std::string said;  ///< last message of the module

 private:
  hsp_status assign(const std::string& id, double number, const char* text, const std::vector<double>& numbers) {
    for (uint32_t i = 0; i < class_->param_count; ++i) {
      const hsp_param* param = HSP_AT(const hsp_param, class_->params, class_->params[0].struct_size, i);
      if (id != param->id) continue;
      const hsp_value value{param->kind, static_cast<uint32_t>(numbers.size()), number, text, numbers.data()};
      return class_->set(device_, i, &value);
    }
    ADD_FAILURE() << "no parameter " << id;
    return HSP_E_ARG;
  }

  hsp_host host_{};
  const hdv_class* class_ = nullptr;
  hdv_device* device_ = nullptr;
};

enum ScriptId { kHold, kStroke, kPress, kTap, kCircle, kPath, kNone, kGuided };
inline constexpr uint64_t kMillisecond = 1'000'000;

}  // namespace hapticd::simulated

// SPDX-License-Identifier: MIT
/// The test arm `walker`: three sliding joints that follow a path to the last bit, one row per tick, whatever force
/// acts. With it a session traces exactly the probe path that `hapticd trace` is given.
#include <algorithm>
#include <array>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "hapticd/device.hpp"

namespace hapticd::walker {
namespace {

struct Walker : Device {
  std::string file;

  static constexpr DeviceInfo kInfo{"org.hapticd.test.walker", "walker", "1.0.0", "MIT", "A test arm on a path."};
  static constexpr auto fields() {
    using F = Fields<Walker>;
    return std::array{F::path("path", &Walker::file, "CSV file t,x,y,z (s, m); one row per tick.")};
  }

  void open(hdv_info& info) {
    info.joint_count = 3;
    info.rate_hz = 1000;
    info.max_force = 8.5;
    for (int i = 0; i < 3; ++i) info.position_min[i] = -1e300, info.position_max[i] = 1e300;
    info.capabilities = HDV_C_SIMULATED;
    readPath();
  }
  void start(const hdv_start&) { next_ = 0; }

  hsp_status read(uint64_t now_ns, hdv_sample& sample) noexcept HSP_RT {
    const std::array<double, 3>& at = rows_[std::min(next_, rows_.size() - 1)];
    std::copy(at.begin(), at.end(), sample.position);
    sample.sequence = ++next_;
    sample.time_ns = now_ns;
    sample.flags = HDV_S_CALIBRATED;
    return HSP_OK;
  }
  hsp_status write(uint64_t, const hdv_command&) noexcept HSP_RT { return HSP_OK; }
  void stop() {}
  void close() {}
  const void* extension(const char* name) { return std::string(name) == HDV_EXT_KINEMATICS ? &kKinematics : nullptr; }

 private:
  void readPath() {
    std::ifstream in(file);
    std::string line, cell;
    std::getline(in, line);
    for (rows_.clear(); std::getline(in, line);) {
      std::istringstream cells(line);
      std::getline(cells, cell, ',');
      std::array<double, 3> row{};
      for (double& x : row) x = std::getline(cells, cell, ',') ? std::strtod(cell.c_str(), nullptr) : 0;
      rows_.push_back(row);
    }
    if (rows_.empty()) throw std::runtime_error(file + ": has no rows");
  }

  static hsp_status forward(const hdv_device*, const double* q, double position[3],
                            double orientation[4]) noexcept HSP_RT {
    std::copy(q, q + 3, position);
    for (int i = 0; i < 4; ++i) orientation[i] = i == 0 ? 1 : 0;
    return HSP_OK;
  }
  static hsp_status jacobian(const hdv_device*, const double*, double* J) noexcept HSP_RT {
    for (int i = 0; i < 18; ++i) J[i] = i % 4 == 0 && i < 9 ? 1 : 0;
    return HSP_OK;
  }
  static hsp_status gravity(const hdv_device*, const double*, const double*, double* torque) noexcept HSP_RT {
    std::fill_n(torque, 3, 0.0);
    return HSP_OK;
  }
  static hsp_status inverse(const hdv_device*, const double position[3], double* q) noexcept HSP_RT {
    std::copy(position, position + 3, q);
    return HSP_OK;
  }
  static constexpr hdv_ext_kinematics kKinematics{
      sizeof(hdv_ext_kinematics), 3, &forward, &jacobian, &gravity, &inverse};

  std::vector<std::array<double, 3>> rows_;
  std::size_t next_ = 0;
};

}  // namespace
}  // namespace hapticd::walker

HAPTICD_DEVICES(hapticd::walker::Walker)

// SPDX-License-Identifier: MIT
#include "diagnostics/hand/hand_path_warnings.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <string>

#include "diagnostics/reading/given_values.hpp"
#include "document/csv.hpp"
#include "host/child.hpp"
#include "host/device_instance.hpp"

namespace hapticd::diagnostics {
namespace {

constexpr int kPathLimitMs = 60'000;
constexpr size_t kMaxBytes = size_t{1} << 30;

/// Returns the file that the hand follows; "" if it follows none.
std::string pathOf(const scene::Device& device) {
  constexpr double kFollows = 5;  // number of the script `path` among the choices
  const scene::Value *script = givenIn(device.parameters, "hand.script"),
                     *path = givenIn(device.parameters, "hand.path");
  const bool follows = device.module == "simulated" && script != nullptr && script->number == kFollows;
  return follows && path != nullptr ? path->text : "";
}

/// Warns of a path that the script of the hand does not follow. A scene may replace the script of its device file, so
/// the two must stand in one file.
void reportIdlePath(const scene::Device& device, document::Problems& warnings) {
  const scene::Value *script = givenIn(device.parameters, "hand.script"),
                     *path = givenIn(device.parameters, "hand.path");
  if (device.module != "simulated" || path == nullptr || path->text.empty() || !pathOf(device).empty()) return;
  if (script == nullptr || script->place.file == path->place.file)
    document::report(
        warnings, path->place, "hand.path",
        fmt::format("has no effect: the hand of {} does not follow a path; {}, or remove the path", device.name,
                    script == nullptr
                        ? "add script: path beside it"
                        : fmt::format("replace the script in line {} by script: path", script->place.line)));
}

/// Returns why the arm cannot reach a place, or "". The search starts from the joints of the row before.
std::string obstacle(const host::DeviceInstance& arm, const double* place, std::array<double, HDV_MAX_JOINTS>& joints) {
  const hdv_ext_kinematics& kinematics = arm.kinematics();
  if (kinematics.inverse == nullptr) return "";
  auto q = joints;
  if (kinematics.inverse(arm.handle(), place, q.data()) < 0) {
    const double smaller[] = {1e-3 * place[0], 1e-3 * place[1], 1e-3 * place[2]};
    constexpr double kFar = 2;  // [m] no arm reaches so far
    const bool fits =
        std::hypot(place[0], place[1], place[2]) > kFar && kinematics.inverse(arm.handle(), smaller, q.data()) >= 0;
    return std::string("the arm does not reach it") + (fits ? "; is it in mm? It must be in m" : "");
  }
  joints = q;
  for (uint32_t i = 0; i < arm.info().joint_count; ++i) {
    constexpr double kRounding = 1e-6;
    const double low = arm.info().position_min[i], high = arm.info().position_max[i];
    if (!(high > low) || (q[i] >= low - kRounding && q[i] <= high + kRounding)) continue;
    return fmt::format("joint {} would be at {:.3f}, beyond its stop at {:.3f}", i + 1, q[i], q[i] < low ? low : high);
  }
  return "";
}

/// Returns a text with the line of the first row that the arm cannot follow, the reason, and how many rows there are;
/// "=" if it can follow all.
std::string tryRows(const scene::Device& device, const std::string& file) {
  const auto table =  // wrong rows are reported by the module, which opens the file
      document::readSoundRows(file, kMaxBytes, {{"t,x,y,z", "t,x,y,z,qw,qx,qy,qz"}, true, true});
  scene::Device at_rest = device;  // its module refuses a file with a wrong row
  std::erase_if(at_rest.parameters, [](const scene::Value& value) { return value.id.starts_with("hand."); });
  auto arm = host::DeviceInstance::create(at_rest, nullptr);
  hdv_start how{};
  how.struct_size = sizeof how;
  how.rate_hz = 1000;
  hdv_sample sample{};
  if (!table || !arm || !(*arm)->open() || !(*arm)->start(how) || (*arm)->read(0, sample) < 0) return "=";
  std::array<double, HDV_MAX_JOINTS> joints{};
  std::copy(sample.position, sample.position + HDV_MAX_JOINTS, joints.begin());
  std::string first;
  size_t rows = 0;
  for (size_t i = 0; i < table->rows(); ++i) {
    const double* row = table->row(i);
    const std::string why = obstacle(**arm, row + 1, joints);
    if (why.empty()) continue;
    if (rows++ == 0)
      first = fmt::format("{}: at t = {:g} s the hand wants to be at [{:.4g}, {:.4g}, {:.4g}] m (device frame): {}",
                          table->lines[i], row[0], row[1], row[2], row[3], why);
  }
  if (rows == 0) return "=";
  return first +
         fmt::format("; this happens in {} of {} rows: there the arm stays at its stop, and the hand feels the stop",
                     rows, table->rows());
}

}  // namespace

document::Problems unreachableRows(const scene::Scene& scene) {
  document::Problems warnings;
  for (const scene::Device& device : scene.devices) {
    reportIdlePath(device, warnings);
    const std::string file = pathOf(device);
    if (file.empty()) continue;
    const auto told = host::runInChild([&] { return tryRows(device, file); }, kPathLimitMs);
    if (!told || *told == "=") continue;
    const size_t colon = told->find(": ");
    int line = 0;
    std::from_chars(told->data(), told->data() + colon, line);
    document::report(warnings, file, line, 1, "hand.path", told->substr(colon + 2));
  }
  return warnings;
}

}  // namespace hapticd::diagnostics

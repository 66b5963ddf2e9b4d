// SPDX-License-Identifier: MIT
#include "facts.hpp"

#include <algorithm>
#include <cstdlib>
#include <mutex>
#include <nlohmann/json.hpp>
#include <set>

#include "coordinates.hpp"
#include "units.hpp"

namespace hapticd::hd {

namespace {

using Json = nlohmann::json;

constexpr size_t kFull = 6;  // degrees of freedom of a pose

/// Arms whose names HDAPI programs know, with the usable workspace in mm that the maker publishes.
struct KnownModel {
  const char* product;  ///< part of the product name that the device reports
  const char* model;    ///< value of HD_DEVICE_MODEL_TYPE
  double size[3];
};
constexpr KnownModel kKnown[] = {
    {"Premium 1.5", "PHANTOM Premium 1.5", {381, 267, 191}},
    {"Premium 3.0", "PHANTOM Premium 3.0", {838, 584, 406}},
    {"Falcon", "", {102, 102, 102}},
    {"Sarcos", "", {1000, 1000, 1000}},
};
constexpr KnownModel kOther = {"", "", {160, 120, 70}};

const KnownModel& knownAs(const std::string& product) {
  const auto found = std::find_if(std::begin(kKnown), std::end(kKnown), [&](const KnownModel& known) {
    return product.find(known.product) != std::string::npos;
  });
  return found != std::end(kKnown) ? *found : kOther;
}

/// Sets the usable workspace to a box around the place where the arm stands, and the largest workspace to a box with
/// the same middle whose sides are a quarter longer.
void readWorkspace(const KnownModel& known, const Json& mount, DeviceFacts& facts) {
  constexpr double kBeyondUsable = 1.25;
  double place[3];
  for (size_t i = 0; i < 3; ++i) place[i] = mount.at("position").at(i).get<double>() - facts.origin[i];
  fromWorld(facts, place);
  for (size_t i = 0; i < 3; ++i) {
    const double middle = place[i] * kMmPerMetre, half = known.size[i] / 2;
    facts.usable[i] = middle - half, facts.usable[i + 3] = middle + half;
    facts.workspace[i] = middle - kBeyondUsable * half, facts.workspace[i + 3] = middle + kBeyondUsable * half;
  }
  facts.tabletop = -facts.usable[1];
}

/// Reads the coordinates of the programs: the axes of the world or of the arm's mount, with another origin.
void readFrame(const Json& clients, const Json& mount, DeviceFacts& facts) {
  const bool of_device = clients.value("frame", "world") == "device";
  double origin[3] = {};
  for (size_t i = 0; i < 3; ++i) origin[i] = clients.contains("origin") ? clients["origin"].at(i).get<double>() : 0.0;
  for (size_t i = 0; i < 4 && of_device; ++i) facts.turn[i] = mount.at("orientation").at(i);
  facts.is_world = !of_device && std::count(std::begin(origin), std::end(origin), 0.0) == 3;
  toWorld(facts, origin);
  for (size_t i = 0; i < 3; ++i)
    facts.origin[i] = origin[i] + (of_device ? mount.at("position").at(i).get<double>() : 0.0);
}

/// Reads the part of the device file that is for HDAPI programs.
void readHd(const Json& device, DeviceFacts& facts) {
  const Json hd = device.value("hd", Json::object());
  const auto words = [&](const char* key, std::string& text) {
    if (const std::string given = hd.value(key, ""); !given.empty()) text = given;
  };
  words("model", facts.model), words("vendor", facts.vendor), words("serial", facts.serial);
  for (const Json& joint : hd.value("joints", Json::array()))
    facts.joint_of.push_back({joint.at(0), joint.at(1), joint.at(2)});
  std::erase_if(facts.joint_of, [&](const auto& of) { return of.joint >= static_cast<size_t>(facts.joints); });
  for (const Json& button : hd.value("buttons", Json::array())) facts.button_of.push_back(button);
  const auto all = std::min<size_t>(kFull, static_cast<size_t>(facts.joints));
  if (facts.joint_of.empty())
    for (size_t i = 0; i < all; ++i) facts.joint_of.push_back({i, 1, 0});
  facts.input_dof = facts.joint_of.size() >= kFull ? static_cast<int>(kFull) : 3;
  facts.output_dof = std::min(facts.input_dof, facts.output_dof);
}

void readInfo(const Json& info, DeviceFacts& facts) {
  // [s] largest damping divided by largest stiffness; a wall at 1 kHz is stable with it.
  constexpr double kDampingTime = 1e-3;
  facts.joints = info.at("joint_count");
  const Json& torque = info.at("max_torque");
  const auto motors = std::count_if(torque.begin(), torque.end(),
                                    [](const Json& most) { return most.is_string() || most.get<double>() > 0; });
  facts.output_dof = motors >= static_cast<long>(kFull) ? static_cast<int>(kFull) : 3;
  facts.max_force = info.at("max_force");
  facts.continuous_force = info.at("continuous_force");
  facts.max_stiffness = info.at("max_stiffness").get<double>() / kMmPerMetre;
  facts.max_damping = facts.max_stiffness * kDampingTime;
  facts.serial = info.at("serial");
  facts.firmware_text = info.at("firmware");
  facts.firmware = std::strtod(facts.firmware_text.c_str(), nullptr);
}

void readScene(const Json& scene, size_t device, DeviceFacts& facts) {
  const Json& arm = scene.at("devices").at(device);
  const Json& limits = arm.at("limits");
  if (const Json& enable = limits.at("enable"); enable.is_object()) facts.enable_button = enable.value("button", -1);
  if (const double force = limits.at("force"); force > 0)
    facts.max_force = facts.max_force > 0 ? std::min(facts.max_force, force) : force;
  // Index of the largest and the ambient temperature in the list of a motor.
  constexpr size_t kHottest = 7, kAmbient = 8;
  for (const Json& motor : limits.at("motors")) facts.motors.push_back({motor.at(kHottest), motor.at(kAmbient)});
  facts.max_torque = limits.at("torque");
  const Json clients = scene.value("clients", Json::object());
  facts.pushable = clients.value("mode", 0) != 0;
  readFrame(clients, arm.at("mount"), facts);
}

}  // namespace

bool readFacts(const char* about, int device, DeviceFacts& facts) try {
  const auto place = static_cast<size_t>(device);
  const Json json = Json::parse(about);
  const Json& arm = json.at("devices").at(place);
  const std::string product = arm.at("info").at("product");
  const KnownModel& known = knownAs(product);
  facts.name = arm.at("name");
  facts.model = known.model[0] != '\0' ? known.model : product.empty() ? facts.name : product;
  facts.driver = json.at("hapticd");
  facts.rate = json.at("rate_hz");
  readInfo(arm.at("info"), facts);
  readScene(json.at("scene"), place, facts);
  readHd(json.at("scene").at("devices").at(place), facts);
  readWorkspace(known, json.at("scene").at("devices").at(place).at("mount"), facts);
  return true;
} catch (const std::exception&) {
  return false;
}

HDstring keptForever(const std::string& text) {
  static auto& lock = *new std::mutex;
  static auto& texts = *new std::set<std::string>;
  const std::lock_guard guard(lock);
  return texts.insert(text).first->c_str();
}

}  // namespace hapticd::hd

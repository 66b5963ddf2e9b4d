// SPDX-License-Identifier: MIT
#include "record/scene_json.hpp"

#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "document/json_text.hpp"

namespace hapticd::record {

namespace {

using Json = nlohmann::ordered_json;

/// Returns a number as JSON. Infinity and NaN become texts, because JSON has no such numbers.
Json real(double value) {
  if (std::isfinite(value)) return value;
  return std::isnan(value) ? "nan" : value > 0 ? "inf" : "-inf";
}

double toReal(const Json& json) {
  return json.is_string() ? std::strtod(json.get_ref<const std::string&>().c_str(), nullptr) : json.get<double>();
}

Json vector(const Eigen::Vector3d& v) {
  return {real(v[0]), real(v[1]), real(v[2])};
}

Eigen::Vector3d toVector(const Json& json) {
  return {toReal(json.at(0)), toReal(json.at(1)), toReal(json.at(2))};
}

Json pose(const scene::Pose& p) {
  const Eigen::Quaterniond& q = p.orientation;
  return {{"position", vector(p.position)}, {"orientation", {real(q.w()), real(q.x()), real(q.y()), real(q.z())}}};
}

scene::Pose toPose(const Json& json) {
  const Json& q = json.at("orientation");
  return {toVector(json.at("position")), {toReal(q.at(0)), toReal(q.at(1)), toReal(q.at(2)), toReal(q.at(3))}};
}

Json values(const std::vector<scene::Value>& all) {
  Json list = Json::array();
  for (const scene::Value& value : all) {
    Json numbers = Json::array();
    for (const double number : value.numbers) numbers.push_back(real(number));
    list.push_back({{"id", value.id},
                    {"index", value.index},
                    {"kind", value.kind},
                    {"number", real(value.number)},
                    {"text", value.text},
                    {"numbers", std::move(numbers)}});
  }
  return list;
}

std::vector<scene::Value> toValues(const Json& list) {
  std::vector<scene::Value> all;
  for (const Json& json : list) {
    scene::Value& value = all.emplace_back();
    value.id = json.at("id");
    value.index = json.at("index");
    value.kind = json.at("kind");
    value.number = toReal(json.at("number"));
    value.text = json.at("text");
    for (const Json& number : json.at("numbers")) value.numbers.push_back(toReal(number));
  }
  return all;
}

Json modelJson(const scene::Model& model) {
  Json path = Json::array();
  for (const scene::PathPoint& point : model.path) path.push_back({{"t", real(point.t)}, {"pose", pose(point.pose)}});
  return {{"name", model.name},
          {"plugin", model.plugin},
          {"library", model.library.string()},
          {"pose", pose(model.pose)},
          {"kinematic", model.kinematic},
          {"enabled", model.enabled},
          {"path", std::move(path)},
          {"parameters", values(model.parameters)}};
}

/// Reads a point of a path: an object, or a row of numbers as in the description of a model that came later.
scene::PathPoint toPathPoint(const Json& json) {
  if (json.is_object()) return {toReal(json.at("t")), toPose(json.at("pose"))};
  scene::PathPoint point{toReal(json.at(0)), {}};
  point.pose.position = {toReal(json.at(1)), toReal(json.at(2)), toReal(json.at(3))};
  if (json.size() > 4)
    point.pose.orientation = {toReal(json.at(4)), toReal(json.at(5)), toReal(json.at(6)), toReal(json.at(7))};
  return point;
}

scene::Model toModel(const Json& json) {
  scene::Model model;
  model.name = json.at("name");
  model.plugin = json.at("plugin");
  model.library = json.at("library").get<std::string>();
  model.pose = toPose(json.at("pose"));
  model.kinematic = json.at("kinematic");
  model.enabled = json.value("enabled", true);  // older recordings have no models that start disabled
  for (const Json& point : json.at("path")) model.path.push_back(toPathPoint(point));
  model.parameters = toValues(json.at("parameters"));
  return model;
}

/// Returns the numbers of each motor in the order of scene::Motor.
Json motorsJson(const std::vector<scene::Motor>& motors) {
  Json json = Json::array();
  for (const scene::Motor& m : motors)
    json.push_back({real(m.ratio), real(m.torque_constant), real(m.resistance), real(m.winding_housing),
                    real(m.housing_air), real(m.winding_time), real(m.housing_time), real(m.max_temperature),
                    real(m.ambient)});
  return json;
}

Json limitsJson(const scene::Limits& limits) {
  const scene::Enable& enable = limits.enable;
  return {
      {"force", real(limits.force)},
      {"torque", real(limits.torque)},
      {"slew", real(limits.slew)},
      {"velocity", limits.velocity ? real(*limits.velocity) : Json()},
      {"workspace", real(limits.workspace)},
      {"ramp_in", real(limits.ramp_in)},
      {"ramp_out", real(limits.ramp_out)},
      {"passivity", limits.passivity ? Json(*limits.passivity) : Json()},
      {"torque_slew", real(limits.torque_slew)},
      {"power", real(limits.power)},
      {"impulse", real(limits.impulse)},
      {"enable", enable.button ? Json{{"button", *enable.button}, {"toggle", enable.mode == scene::EnableMode::kToggle}}
                               : Json()},
      {"motors", motorsJson(limits.motors)},
      {"weight", limits.weight ? real(*limits.weight) : Json()}};
}

scene::Limits toLimits(const Json& json) {
  scene::Limits limits;
  limits.force = toReal(json.at("force"));
  limits.torque = toReal(json.at("torque"));
  limits.slew = toReal(json.at("slew"));
  if (const Json& velocity = json.at("velocity"); !velocity.is_null()) limits.velocity = toReal(velocity);
  limits.workspace = toReal(json.at("workspace"));
  limits.ramp_in = toReal(json.at("ramp_in"));
  limits.ramp_out = toReal(json.at("ramp_out"));
  if (const Json& passivity = json.at("passivity"); !passivity.is_null()) limits.passivity = passivity.get<bool>();
  // Older recordings do not have these limits.
  const auto later = [&](const char* key) { return json.contains(key) ? json.at(key) : Json(); };
  const auto bound = [&](const char* key) { return json.contains(key) ? toReal(json.at(key)) : 0.0; };
  limits.torque_slew = bound("torque_slew");
  limits.power = bound("power");
  limits.impulse = bound("impulse");
  if (const Json weight = later("weight"); !weight.is_null()) limits.weight = toReal(weight);
  if (const Json enable = later("enable"); !enable.is_null())
    limits.enable = {enable.at("button").get<int>(),
                     enable.at("toggle") ? scene::EnableMode::kToggle : scene::EnableMode::kHold};
  for (const Json& motor : later("motors")) {
    scene::Motor& m = limits.motors.emplace_back();
    size_t i = 0;
    for (double* value : {&m.ratio, &m.torque_constant, &m.resistance, &m.winding_housing, &m.housing_air,
                          &m.winding_time, &m.housing_time, &m.max_temperature, &m.ambient})
      *value = toReal(motor.at(i++));
  }
  return limits;
}

Json hdJson(const scene::HdArm& hd) {
  Json joints = Json::array();
  for (const scene::HdJoint& joint : hd.joints) joints.push_back({joint.joint, real(joint.sign), real(joint.offset)});
  return {{"model", hd.model},
          {"vendor", hd.vendor},
          {"serial", hd.serial},
          {"joints", std::move(joints)},
          {"buttons", hd.buttons}};
}

scene::HdArm toHd(const Json& json) {
  scene::HdArm hd{json.at("model"), json.at("vendor"), json.at("serial"), {}, json.at("buttons")};
  for (const Json& joint : json.at("joints"))
    hd.joints.push_back({joint.at(0), toReal(joint.at(1)), toReal(joint.at(2))});
  return hd;
}

Json deviceJson(const scene::Device& device) {
  Json json = {{"name", device.name},
               {"module", device.module},
               {"file", device.file.string()},
               {"library", device.library.string()},
               {"mount", pose(device.mount)},
               {"limits", limitsJson(device.limits)},
               {"parameters", values(device.parameters)}};
  if (device.admittance)
    json["admittance"] = {{"mass", real(device.admittance->mass)}, {"damping", real(device.admittance->damping)}};
  if (device.hd) json["hd"] = hdJson(*device.hd);
  return json;
}

scene::Device toDevice(const Json& json) {
  scene::Device device;
  device.name = json.at("name");
  device.module = json.at("module");
  device.file = json.at("file").get<std::string>();
  device.library = json.at("library").get<std::string>();
  device.mount = toPose(json.at("mount"));
  device.limits = toLimits(json.at("limits"));
  device.parameters = toValues(json.at("parameters"));
  if (json.contains("admittance"))
    device.admittance = {toReal(json["admittance"].at("mass")), toReal(json["admittance"].at("damping"))};
  if (json.contains("hd")) device.hd = toHd(json["hd"]);
  return device;
}

Json servoJson(const scene::Servo& servo) {
  Json json = {{"rate", real(servo.rate)},
               {"activation_radius", real(servo.activation_radius)},
               {"hysteresis", real(servo.hysteresis)},
               {"gravity", vector(servo.gravity)},
               {"pace", servo.pace == scene::Pace::kClock ? "clock" : "device"},
               {"velocity", {{"estimator", servo.velocity.estimator}, {"parameter", real(servo.velocity.parameter)}}},
               {"budget_us", real(servo.budget_us)}};
  if (servo.spin_us) json["spin_us"] = real(*servo.spin_us);
  json["instructions"] = servo.instructions == scene::Instructions::kPortable ? "portable" : "auto";
  return json;
}

scene::Servo toServo(const Json& json) {
  scene::Servo servo;
  servo.rate = toReal(json.at("rate"));
  servo.activation_radius = toReal(json.at("activation_radius"));
  servo.hysteresis = toReal(json.at("hysteresis"));
  servo.gravity = toVector(json.at("gravity"));
  servo.pace = json.at("pace") == "device" ? scene::Pace::kDevice : scene::Pace::kClock;
  servo.velocity.estimator = json.at("velocity").at("estimator");
  servo.velocity.parameter = toReal(json.at("velocity").at("parameter"));
  servo.budget_us = toReal(json.at("budget_us"));
  if (json.contains("spin_us")) servo.spin_us = toReal(json["spin_us"]);
  if (json.value("instructions", "auto") == "portable") servo.instructions = scene::Instructions::kPortable;
  return servo;
}

Json clientsJson(const scene::Clients& clients) {
  return {{"mode", static_cast<int>(clients.mode)},
          {"max_force", real(clients.max_force)},
          {"exclusive", clients.exclusive},
          {"answer_time", real(clients.answer_time)},
          {"push", clients.push},
          {"origin", vector(clients.origin)},
          {"frame", clients.frame == scene::ClientFrame::kDevice ? "device" : "world"}};
}

/// Reads the settings for clients. Older recordings do not have them.
scene::Clients toClients(const Json& json) {
  if (!json.contains("clients")) return {};
  const Json& clients = json.at("clients");
  const int mode = clients.at("mode");
  if (mode < 0 || mode > static_cast<int>(scene::ClientMode::kInstead))
    throw std::runtime_error("clients: unknown mode");
  return {static_cast<scene::ClientMode>(mode),
          toReal(clients.at("max_force")),
          clients.at("exclusive"),
          clients.contains("answer_time") ? toReal(clients.at("answer_time")) : 0,
          clients.value("push", true),
          clients.contains("origin") ? toVector(clients.at("origin")) : Eigen::Vector3d::Zero(),
          clients.value("frame", "world") == "device" ? scene::ClientFrame::kDevice : scene::ClientFrame::kWorld};
}

}  // namespace

std::string sceneToJson(const scene::Scene& scene) {
  Json models = Json::array(), devices = Json::array();
  for (const scene::Model& model : scene.models) models.push_back(modelJson(model));
  for (const scene::Device& device : scene.devices) devices.push_back(deviceJson(device));
  const Json json = {{"file", scene.file.string()},
                     {"servo", servoJson(scene.servo)},
                     {"clients", clientsJson(scene.clients)},
                     {"models", std::move(models)},
                     {"devices", std::move(devices)}};
  return document::jsonLine(json);
}

Result<scene::Scene> sceneFromJson(const std::string& json_text) {
  try {
    const Json json = document::parseJsonOrThrow(json_text);
    scene::Scene scene;
    scene.file = json.at("file").get<std::string>();
    scene.servo = toServo(json.at("servo"));
    scene.clients = toClients(json);
    for (const Json& model : json.at("models")) scene.models.push_back(toModel(model));
    for (const Json& device : json.at("devices")) scene.devices.push_back(toDevice(device));
    return scene;
  } catch (const std::exception& error) {
    return Error{std::string("its scene cannot be read: ") + error.what()};
  }
}

std::string modelToJson(const scene::Model& model) {
  return modelJson(model).dump(-1, ' ', true, Json::error_handler_t::replace);
}

Result<scene::Model> modelFromJson(const std::string& json_text) {
  try {
    return toModel(document::parseJsonOrThrow(json_text));
  } catch (const std::exception& error) {
    return Error{std::string("the description of a model cannot be read: ") + error.what()};
  }
}

}  // namespace hapticd::record

#include "cli/trial.hpp"

#include <Eigen/Core>

#include "host/child.hpp"
#include "host/shape_instance.hpp"
#include "host/wire.hpp"

namespace hapticd::cli {
namespace {

constexpr int kLimitMs = 300'000;  ///< thousands of models may need minutes; a hang needs an end

hsp_activation activationOf(const scene::Scene& scene, const scene::Model& model) {
  hsp_activation activation{};
  activation.struct_size = sizeof activation;
  activation.max_probes = 1;
  activation.rate_hz = scene.servo.rate;
  activation.max_probe_speed = 2;
  Eigen::Map<Eigen::Vector3d>(activation.gravity) = scene.servo.gravity;
  Eigen::Map<Eigen::Vector3d>(activation.pose.position) = model.pose.position;
  const Eigen::Quaterniond& q = model.pose.orientation;
  const double orientation[4] = {q.w(), q.x(), q.y(), q.z()};
  std::copy(orientation, orientation + 4, activation.pose.orientation);
  return activation;
}

/// Nothing, or what the plugin says against a model.
std::string objection(const scene::Scene& scene, const scene::Model& model, double& stiffness) {
  auto shape = host::ShapeInstance::create(model, nullptr);
  if (!shape) return shape.error();
  const auto activated = (*shape)->activate(activationOf(scene, model));
  if (!activated) return activated.error();
  stiffness = (*shape)->report().max_stiffness;
  return "";
}

std::string tryAll(const scene::Scene& scene) {
  host::Packer out;
  uint32_t count = 0;
  host::Packer list, claims;
  for (size_t i = 0; i < scene.models.size(); ++i) {
    double stiffness = 0;
    const std::string text = objection(scene, scene.models[i], stiffness);
    claims.number(stiffness);
    if (text.empty()) continue;
    ++count;
    list.number(static_cast<uint32_t>(i));
    list.text(text);
  }
  out.number(count);
  return out.take() + list.take() + claims.take();
}

}  // namespace

scene::Problems tryModels(const scene::Scene& scene, std::vector<double>* stiffness) {
  scene::Problems problems;
  if (scene.models.empty()) return problems;
  const auto told = host::runInChild([&] { return tryAll(scene); }, kLimitMs);
  if (!told) {
    scene::report(problems, scene.file.string(), 1, 1, "models", "setting them up " + told.error());
    return problems;
  }
  host::Unpacker in(*told);
  for (uint32_t left = in.count(); left > 0 && in.good(); --left) {
    const uint32_t index = in.count();
    const std::string text = in.text();
    if (index >= scene.models.size()) break;
    scene::report(problems, scene.models[index].place, "models[" + std::to_string(index) + "]", text);
  }
  if (stiffness != nullptr)
    for (size_t i = 0; i < scene.models.size() && in.good(); ++i) stiffness->push_back(in.real());
  return problems;
}

}  // namespace hapticd::cli

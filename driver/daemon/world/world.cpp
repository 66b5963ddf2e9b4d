// SPDX-License-Identifier: MIT
#include "world/world.hpp"

#include "servo/velocity/probe_velocity.hpp"
#include "world/instructions.hpp"
#include "world/setup_calls.hpp"

namespace hapticd::servo {

namespace {

/// Returns the pose of a model at the start. A path replaces the model's own pose: the first search must find the
/// surfaces where the first tick has them.
hsp_pose startPose(const scene::Model& model) {
  const scene::Pose& start = model.kinematic && !model.path.empty() ? model.path.front().pose : model.pose;
  hsp_pose pose{};
  Eigen::Map<Eigen::Vector3d>(pose.position) = start.position;
  storeQuaternion(start.orientation, pose.orientation);
  return pose;
}

uint64_t budgetNs(const scene::Servo& servo, double rate) {
  // shapes get this share of a period; the rest is for the devices, the limits and the sleep
  constexpr double kShareOfPeriod = 0.8;
  return static_cast<uint64_t>(servo.budget_us > 0 ? servo.budget_us * 1e3 : kShareOfPeriod * 1e9 / rate);
}

hsp_activation activationFor(const scene::Scene& scene, const WorldOptions& options, uint64_t budget_ns) {
  hsp_activation activation{};
  activation.struct_size = sizeof activation;
  activation.max_probes = options.probe_count;
  activation.rate_hz = options.rate;
  activation.max_probe_speed = kMaxProbeSpeed;
  activation.budget_ns = budget_ns;
  activation.max_arm_force = options.max_force;
  Eigen::Map<Eigen::Vector3d>(activation.gravity) = scene.servo.gravity;
  return activation;
}

/// Creates and activates a shape. Observers hear of the calls, which may take long.
Result<std::unique_ptr<host::ShapeInstance>> setUp(const scene::Model& model, const hsp_activation& activation,
                                                   const host::Services::Log& log) {
  noteSetup(&model, "create() or set");
  auto shape = host::ShapeInstance::create(model, log);
  if (!shape) return Error{shape.error()};
  noteSetup(&model, "activate");
  if (auto done = (*shape)->activate(activation); !done) return Error{done.error()};
  return shape;
}

}  // namespace

Result<std::unique_ptr<World>> World::build(const scene::Scene& scene, const WorldOptions& options,
                                            const host::Services::Log& log) {
  chooseInstructions(scene.servo);
  std::unique_ptr<World> world(new World);
  const uint64_t budget_ns = options.budgets ? budgetNs(scene.servo, options.rate) : 0;
  hsp_activation& activation = world->activation_;
  activation = activationFor(scene, options, budget_ns);
  std::vector<host::ShapeInstance*> models;
  std::vector<hsp_pose> poses;
  const SetupScope setting_up;
  for (const scene::Model& described : scene.models) {
    activation.pose = startPose(described);
    auto shape = setUp(described, activation, log);
    if (!shape) return Error{shape.error()};
    const hsp_report& report = (*shape)->report();
    world->needs_ |= report.flags;
    world->locked_bytes_ += report.locked_bytes;
    models.push_back(shape->get());
    poses.push_back(activation.pose);
    world->shapes_.push_back(std::move(*shape));
  }
  world->link_ = std::make_unique<link::Link>();
  world->proximity_ = std::make_unique<sim::Proximity>(
      models, poses, options.probe_count, sim::ProximitySettings{scene.servo.activation_radius, scene.servo.hysteresis},
      *world->link_);
  CoreSettings settings;
  settings.budget_ns = budget_ns;
  settings.max_probe_speed = kMaxProbeSpeed;
  settings.measure = options.measure;
  settings.evaluation_ns = options.evaluation_ns;
  settings.spare_models = options.spare_models;
  settings.former_claims = options.former_claims;
  settings.keep_disabled = options.keep_disabled;
  for (uint32_t i = 0; i < models.size() && options.keep_disabled; ++i)
    if (!scene.models[i].enabled) world->proximity_->remove(i);  // until wake()
  world->core_ = std::make_unique<Core>(models, scene, options.probe_count, settings, *world->link_);
  world->shapes_.resize(models.size() + options.spare_models);
  return world;
}

Result<std::unique_ptr<host::ShapeInstance>> World::prepare(const scene::Model& model,
                                                            const host::Services::Log& log) const {
  const SetupScope setting_up;
  hsp_activation activation = activation_;
  activation.pose = startPose(model);
  auto shape = setUp(model, activation, log);
  if (!shape) return Error{shape.error()};
  const uint32_t needs = (*shape)->report().flags;
  if ((needs & HSP_R_VELOCITY) != 0 && !needsVelocity())
    return Error{"model '" + model.name +
                 "': needs the velocity of the probe, which this run does not estimate, because "
                 "no model needed it at the start\n  fix: start the daemon with a scene that has this model"};
  return shape;
}

void World::store(uint32_t place, std::unique_ptr<host::ShapeInstance> shape, const scene::Model& model) {
  shapes_[place] = std::move(shape);
  if (model.enabled) proximity_->add(place, *shapes_[place], startPose(model), activation_.max_probes);
}

bool World::wake(uint32_t place, const scene::Model& model) {
  if (shapes_[place]->surfaces() == nullptr || proximity_->contains(place)) return false;
  proximity_->add(place, *shapes_[place], startPose(model), activation_.max_probes);  // a moving model sends its pose
  return true;
}

}  // namespace hapticd::servo

// SPDX-License-Identifier: MIT
/// The heart of the servo: a function of (state, probes, dt). The same core runs on a real clock, in virtual time and
/// over a recorded path; same input gives the same bits.
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <atomic>
#include <memory>
#include <span>
#include <vector>

#include "description/scene.hpp"
#include "host/shape_instance.hpp"
#include "link/link.hpp"
#include "servo/core/frame.hpp"
#include "servo/core/led_pose.hpp"
#include "servo/core/load_shedding.hpp"
#include "servo/core/minimum_jerk.hpp"
#include "servo/core/order.hpp"
#include "servo/core/path.hpp"
#include "servo/safety/claim.hpp"
#include "servo/safety/guard.hpp"
#include "servo/safety/passivity/controller.hpp"

namespace hapticd::servo {

/// One arm's tip, in the world frame.
struct Probe {
  Vector3d position = Vector3d::Zero();  ///< [m]
  Vector3d velocity = Vector3d::Zero();  ///< [m/s] zero unless something in the scene uses it
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  bool valid = false;  ///< the sample is good; otherwise no shape pushes
};

/// What one model answered to one probe in the last tick; vectors in the world frame.
struct Contact {
  hsp_contact world{};
  bool traced = false;
};

/// A model as the servo sees it.
struct ModelState {
  host::ShapeInstance* shape = nullptr;
  hsp_pose pose{};
  Frame frame;
  Frame before;       ///< its frame one tick ago; kept if the model moves
  Path path;          ///< kinematic models
  MinimumJerk glide;  ///< the motion that a person asked for; it precedes the path
  bool kinematic = false;
  bool enabled = true;                  ///< it is felt; otherwise it is faded out and only traced
  bool leaving = false;                 ///< it fades out and then leaves its place
  bool until_free = false;              ///< it was added or enabled while a tip may be in it: see enters()
  double free_for = 0;                  ///< [s] for which no tip was in it since
  std::array<hsp_change, 8> changes{};  ///< live parameters for the next step
  uint32_t change_count = 0;
  uint32_t active_surfaces = 0;  ///< over all probes
  bool always = false;           ///< stepped in every tick, because it traces itself or moves by itself
  bool moves = false;            ///< its pose may change
  hsp_status status = HSP_OK;
  hsp_status failed_status = HSP_OK;  ///< the first status that step may not return
  Pull pull;                          ///< the pull that silenced it, or the largest jump of its force
  Guard guard;
  ClaimBounds claims;         ///< what it may do
  bool overran = false;       ///< its last step took too long, which counts against it
  bool overran_then = false;  ///< it overran in the run that is replayed
  uint64_t step_ns = 0;       ///< time of the last step; 0 when not measured
  bool cpu_timed = false;     ///< that is the thread's own time, without interruptions
  // How exactly it answers: less so while a tick takes too long, see load_shedding.hpp.
  uint32_t level = 0, coarsest = 0;  ///< the level now, and the coarsest so far
  uint64_t finer_ns = 0;             ///< time of a step before the level was lowered
  double rested = 0;                 ///< [s] since its last step
  uint64_t degraded_ticks = 0;
  double degraded_residual = 0;  ///< [m] largest error that a degraded answer reported
  LedPose lead;                  ///< lead of a kinematic model; it precedes glide and path
};

struct CoreSettings {
  uint64_t budget_ns = 0;       ///< for all shapes in a tick; 0: no limit
  double max_probe_speed = 20;  ///< [m/s] faster motion between two samples is a jump
  uint32_t spare_models = 0;    ///< empty places for models that are added during the run
  bool measure = false;         ///< take the CPU time of each step
  double evaluation_ns = 0;     ///< > 0: time per evaluation that a step is charged, instead of what it takes
  bool former_claims = false;   ///< as formerly, claims do not bound torques, nor steps after a parameter was set
};

/// What the arms do with a tick's answers; settled before the first tick. What nobody uses is not computed.
struct Uses {
  bool torque = true;    ///< an arm can turn the hand, or torques are written to a file
  bool exchange = true;  ///< an arm has a passivity controller
  /// [N] The most that each arm lets through, by probe; 0 or missing: unknown.
  std::vector<double> max_force = {};
  std::vector<double> max_torque = {};  ///< [N m] the same
};

class Core {
 public:
  /// [main] @param models active instances in the order of the scene, with the poses they were activated at
  Core(const std::vector<host::ShapeInstance*>& models, const scene::Scene& scene, uint32_t probe_count,
       const CoreSettings& settings, link::Link& link);

  /// [main] Called before the first tick; without it everything is computed.
  void serve(const Uses& uses);

  /// [rt] Called before the first tick: CLOCK_MONOTONIC [s] at t = 0, which is the clock of leaders.
  void startAt(double epoch) noexcept HSP_RT { epoch_ = epoch; }

  /// [rt] One tick at time t [s], dt [s] after the last (0: the first). Fills contacts() and force().
  void tick(double t, double dt, std::span<const Probe> probes) noexcept HSP_RT;

  /// [main] Tells what the servo must know of an active shape before its first tick.
  static ModelState stateOf(host::ShapeInstance& shape, const scene::Model& described);

  /// [rt] Called before tick(): decides from the last tick's cost how exactly each model answers. @return what changed
  std::span<const LoadShedding::Change> shedLoad() noexcept HSP_RT;

  /// [rt] Obeys an order to a model, before tick(). False if it cannot be obeyed.
  bool obey(const Order& order, double t) noexcept HSP_RT;

  /// [any] Only one reader: a place whose model has left, so that its shape may be destroyed.
  bool takeReleased(uint32_t& model) noexcept { return released_.pop(model); }

  /// [rt] Tells the simulation side where the probes are; called before tick(), so that a search in lockstep sees them.
  void publish(double t, std::span<const Probe> probes) noexcept HSP_RT;

  /// Force [N] and torque [N m] of all models on a probe, world frame.
  const Vector3d& force(uint32_t probe) const noexcept { return forces_[probe]; }
  const Vector3d& torque(uint32_t probe) const noexcept { return torques_[probe]; }
  /// What moving models did to a probe since the last tick, and what its contacts can give back.
  const passivity::Exchange& exchange(uint32_t probe) const noexcept { return exchanges_[probe]; }
  std::span<const ModelState> models() const noexcept { return models_; }
  const Contact& contact(uint32_t model, uint32_t probe) const noexcept {
    return contacts_[size_t{model} * probe_count_ + probe];
  }
  /// True if the last tick had a jump or a lost track, so that the simulation side should search at once.
  bool wantsSearch() const noexcept { return wants_search_; }
  /// Transforms in the last tick: n inverse ones of probes, m of points and m of normals; models at the world's origin
  /// need none.
  uint32_t transforms() const noexcept { return transforms_; }
  /// Models that have something to do in this tick, in scene order.
  std::span<const uint32_t> live() const noexcept { return live_; }
  /// Activation records that the last tick took, for the recording.
  std::span<const link::ActivationRecord> received() const noexcept { return {received_.data(), received_count_}; }
  uint32_t probeCount() const noexcept { return probe_count_; }
  /// [rt] How many models are present, felt or not.
  uint32_t present() const noexcept { return present_; }

 private:
  bool adopt(ModelState& place, const Order& order) noexcept HSP_RT;
  bool change(ModelState& model, const Order& order) noexcept HSP_RT;
  void releaseLeaving() noexcept HSP_RT;
  void receiveRecords() noexcept HSP_RT;
  void moveKinematic(ModelState& model, double t, double dt) noexcept HSP_RT;
  void findJumps(double dt, std::span<const Probe> probes) noexcept HSP_RT;
  void stepModel(uint32_t index, double t, double dt, std::span<const Probe> probes) noexcept HSP_RT;
  bool mayRest(const ModelState& model, uint32_t index, double dt) const noexcept HSP_RT;
  struct Begun {
    Nanoseconds wall = 0, cpu = 0;  ///< 0: not taken
  };
  Begun beginCost() const noexcept HSP_RT;
  void takeCost(ModelState& model, const Begun& begun) noexcept HSP_RT;
  bool excused() noexcept HSP_RT;
  bool setLevel(ModelState& model, uint32_t level) noexcept HSP_RT;
  void fillProbe(const ModelState& model, const Probe& probe, uint32_t index, double t) noexcept HSP_RT;
  void callShape(ModelState& model, double dt, hsp_pose& pose) noexcept HSP_RT;
  Trouble judge(ModelState& model, uint32_t index, double dt, const hsp_pose& pose) noexcept HSP_RT;
  void fadeContact(uint32_t index, uint32_t probe, double part) noexcept HSP_RT;
  Trouble holdToClaims(ModelState& model, uint32_t index, double dt) noexcept HSP_RT;
  Trouble holdToClaim(ModelState& model, uint32_t index, uint32_t probe, double dt) noexcept HSP_RT;
  bool holdTorque(const ModelState& model, Claim& claim, uint32_t probe, double dt) noexcept HSP_RT;
  bool pulls(ModelState& model) noexcept HSP_RT;
  Trouble holdToTime(ModelState& model) noexcept HSP_RT;
  Trouble takePose(ModelState& model, hsp_pose pose) noexcept HSP_RT;
  void bookMotion(const ModelState& model, uint32_t index) noexcept HSP_RT;
  void bookContact(const ModelState& model, const Contact& contact, uint32_t probe) noexcept HSP_RT;
  void takeContact(ModelState& model, uint32_t index, uint32_t probe, double gain) noexcept HSP_RT;
  bool enters(ModelState& model, std::span<const Probe> probes, double& pace) const noexcept HSP_RT;
  void clearContacts(uint32_t index) noexcept HSP_RT;
  void listLive() noexcept HSP_RT;
  void sendTransform(ModelState& model, uint32_t index) noexcept HSP_RT;

  CoreSettings settings_;
  Uses uses_;
  link::Link& link_;
  uint32_t probe_count_;
  std::vector<ModelState> models_;
  std::vector<uint32_t> live_;  // models with something to do, in scene order, so that the sum is always the same
  std::vector<Load> loads_;     // of the models that were stepped
  LoadShedding shedding_;
  std::vector<Claim> claims_;  // [model * probe_count + probe]
  // Of the answer being judged: kept, because making it anew would cost as much as judging it.
  ClaimStep claim_step_;
  Eigen::Matrix3d turn_ = Eigen::Matrix3d::Identity();  // motion of its model in this tick, if it moves
  std::vector<Contact> contacts_;                       // [model * probe_count + probe]
  std::vector<hsp_probe> inputs_;                       // of the model being stepped
  std::vector<hsp_contact> outputs_;
  // Bounded, so that a flood of records does not make a tick late; the rest waits for the next tick.
  std::array<link::ActivationRecord, 1024> received_;
  size_t received_count_ = 0;
  std::vector<Vector3d> last_position_;               // position of the last good sample
  std::vector<Eigen::Quaterniond> last_orientation_;  // the same
  std::vector<uint8_t> jumped_, seen_;
  std::vector<Vector3d> forces_, torques_;
  std::vector<passivity::Exchange> exchanges_;
  SpscRing<uint32_t> released_{256};
  uint32_t leaving_ = 0, present_ = 0;
  bool wants_search_ = true;
  uint32_t transforms_ = 0;
  double epoch_ = 0;
  uint64_t tick_ = 0;
  uint64_t budget_left_ns_ = 0;
  bool preempted_ = false;  // their counts in this tick, if anybody asked for them
  // After a tick that was too long, the thread's own time is measured, at the cost of one system call per step.
  uint32_t suspicious_ = 0;  // ticks for which it is still measured
  bool cpu_timed_ = false;   // it was measured in the last tick
};

}  // namespace hapticd::servo

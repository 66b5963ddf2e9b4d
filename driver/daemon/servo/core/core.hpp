// SPDX-License-Identifier: MIT
/// The core of the servo: steps all models for one tick, as a function of (state, probes, dt). The same core runs on a
/// real clock, in virtual time and in a replay. The same input gives the same result, bit by bit.
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
#include "servo/safety/energy_account.hpp"
#include "servo/safety/guard.hpp"
#include "servo/safety/passivity/controller.hpp"

namespace hapticd::servo {

/// The tip of one arm, world frame.
struct Probe {
  Vector3d position = Vector3d::Zero();  ///< [m]
  Vector3d velocity = Vector3d::Zero();  ///< [m/s] zero if nothing in the scene uses it
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  bool valid = false;  ///< true if the sample is good; otherwise no shape pushes
};

/// The answer of one model to one probe in the last tick; vectors in the world frame.
struct Contact {
  hsp_contact world{};
  bool traced = false;
};

/// The state of one model in the servo.
struct ModelState {
  host::ShapeInstance* shape = nullptr;
  hsp_pose pose{};
  Frame frame;
  Frame before;       ///< its frame one tick ago; only set if the model moves
  Path path;          ///< motion of a kinematic model, from a file
  MinimumJerk glide;  ///< motion that a user asked for (ctl move); it overrides the path
  bool kinematic = false;
  bool enabled = true;      ///< true: it is felt; false: its force fades out, and it is only traced
  bool dormant = false;     ///< true: it has started disabled, and is not stepped until it is enabled
  bool leaving = false;     ///< true if its force fades out, after which it is removed from the run
  bool until_free = false;  ///< true: it is not felt until every tip has been outside for some time, see enters()
  double free_for = 0;      ///< [s] time for which no tip has been inside; used while until_free is true
  bool waits = false;       ///< true: a tip was found inside, so it is not felt until they were outside for kFreeFor
  std::array<hsp_change, 8> changes{};  ///< values of live parameters for the next step
  uint32_t change_count = 0;
  uint32_t active_surfaces = 0;  ///< traced surfaces, all probes together
  bool always = false;  ///< true: it is stepped in every tick, because its plugin finds the foot points or moves it
  bool moves = false;   ///< true if its pose may change
  uint32_t at_end = 0;  ///< HSP_OUT_AT_LOWEST or HSP_OUT_AT_HIGHEST if a joint stands there; else 0
  hsp_status status = HSP_OK;
  hsp_status failed_status = HSP_OK;  ///< the first status that step() returned and that the ABI does not allow
  Breach breach;  ///< the pull for which it was silenced; if there is none, the largest jump of its force
  Guard guard;
  ClaimBounds claims;         ///< bounds on the change of its force
  bool overran = false;       ///< its last step took too long, and was counted against it (Guard::strike())
  bool overran_then = false;  ///< replay: it overran in this tick of the recorded run
  uint64_t step_ns = 0;       ///< time of the last step; 0 if not measured
  bool cpu_timed = false;     ///< true: step_ns is CPU time of the thread, without interruptions
  // Its accuracy: reduced while ticks take too long, see load_shedding.hpp.
  uint32_t level = 0, coarsest = 0;  ///< Accuracy level now, and the coarsest one so far
  uint64_t finer_ns = 0;             ///< time of a step before the level was last lowered
  double rested = 0;                 ///< [s] time since its last step
  uint64_t degraded_ticks = 0;
  double degraded_residual = 0;  ///< [m] largest error that a degraded answer reported
  LedPose lead;                  ///< a leader's motion of a kinematic model; it overrides glide and path
};

struct CoreSettings {
  uint64_t budget_ns = 0;       ///< time for all shapes of a tick together; 0: no limit
  double max_probe_speed = 20;  ///< [m/s] a faster probe is treated as a jump
  uint32_t spare_models = 0;    ///< empty places for models that are added during the run
  bool measure = false;         ///< true: the time of each step is measured
  /// [ns] for tests, in which accuracy must fall in the same way each time: if > 0, a step costs this time for each
  /// evaluation of the surface (hsp_contact.iterations), and not its measured time
  double evaluation_ns = 0;
  /// for old recordings: torques are not bounded, nor is the step after a parameter was set
  bool former_claims = false;
  /// true: after a gap of more than kLongestGap between two ticks every probe has jumped, as in a run. Tools that step
  /// over rows of a file may have rows as far apart as they like
  bool gaps_jump = false;
  bool keep_disabled = false;  ///< false: models that the scene disables are enabled, see WorldOptions
};

/// The results of a tick that the arms use. Other results are not computed.
struct RequiredResults {
  bool torque = true;    ///< true if an arm can apply torques, or torques are written to a file
  bool exchange = true;  ///< true if an arm has a passivity controller
  /// [N] Largest force that each arm lets through, by probe; 0 or missing: unknown.
  std::vector<double> max_force = {};
  std::vector<double> max_torque = {};  ///< [N m] largest torque that each arm lets through, by probe
};

class Core {
 public:
  /// [s] A model that came, or was enabled, is felt once no tip has been inside for this time. Until it was searched
  /// for, no tip seems to be inside; a search runs every 5 ms, less often on a busy machine.
  static constexpr double kFreeFor = 0.05;
  /// [s] After a longer gap between two ticks nobody knows on which path a probe went.
  static constexpr double kLongestGap = 0.1;

  /// [main] @param models active shapes in the order of the scene, in the poses in which they were activated
  Core(const std::vector<host::ShapeInstance*>& models, const scene::Scene& scene, uint32_t probe_count,
       const CoreSettings& settings, link::Link& link);

  /// [main] Sets which results tick() computes. Call it before the first tick. Without this call, tick() computes all
  /// of them.
  void serve(const RequiredResults& uses);

  /// [rt] Called before the first tick. `epoch` is the CLOCK_MONOTONIC time [s] of t = 0; leaders use that clock.
  void startAt(double epoch) noexcept HSP_RT { epoch_ = epoch; }

  /// [rt] Runs one tick at time t [s], dt [s] after the last one (0 for the first). Fills contact() and force().
  void tick(double t, double dt, std::span<const Probe> probes) noexcept HSP_RT;

  /// [main] Returns the state with which the servo starts an active shape.
  /// @param keep_disabled false: it is enabled, even if it is described as disabled
  static ModelState stateOf(host::ShapeInstance& shape, const scene::Model& described, bool keep_disabled = true);

  /// [rt] Called before tick(): sets the accuracy of each model from the cost of the last tick. @return what changed
  std::span<const LoadShedding::Change> shedLoad() noexcept HSP_RT;

  /// [rt] Called before tick(): obeys an order that concerns a model. Returns false if that is impossible.
  bool apply(const Order& order, double t) noexcept HSP_RT;

  /// [any] Gives the number of a model that has left the run, so that its shape may be destroyed. Returns false if
  /// there is none. Only one thread may call it.
  bool takeReleased(uint32_t& model) noexcept { return released_.pop(model); }

  /// [rt] Sends the positions of the probes to the proximity search; called before tick(), so that a search in lockstep
  /// sees them.
  void publish(double t, std::span<const Probe> probes) noexcept HSP_RT;

  /// Sums of the forces [N] and torques [N m] of all models on a probe, world frame.
  const Vector3d& force(uint32_t probe) const noexcept { return forces_[probe]; }
  const Vector3d& torque(uint32_t probe) const noexcept { return torques_[probe]; }
  /// Energy that moving models gave to a probe since the last tick, and energy that its contacts can still give back.
  const passivity::Exchange& exchange(uint32_t probe) const noexcept { return exchanges_[probe]; }
  std::span<const ModelState> models() const noexcept { return models_; }
  const Contact& contact(uint32_t model, uint32_t probe) const noexcept { return contacts_[at(model, probe)]; }
  /// True if the last tick had a jump or a lost track, so that a proximity search should run at once.
  bool needsSearch() const noexcept { return needs_search_; }
  /// Number of transforms in the last tick: one per model and probe, and two per traced foot point (the point and its
  /// normal). Models whose frame is the world frame need none.
  uint32_t transforms() const noexcept { return transforms_; }
  /// Models that are traced or move in this tick, in scene order.
  std::span<const uint32_t> live() const noexcept { return live_; }
  /// Activation records that were carried out in the last tick, for the recording.
  std::span<const link::ActivationRecord> received() const noexcept { return {received_.data(), received_count_}; }
  uint32_t probeCount() const noexcept { return probe_count_; }
  /// [rt] Returns how many models are in the run, felt or not.
  uint32_t present() const noexcept { return present_; }

 private:
  /// Returns the place of a model and a probe in contacts_, claims_ and energies_.
  size_t at(uint32_t model, uint32_t probe) const noexcept { return size_t{model} * probe_count_ + probe; }
  bool adopt(ModelState& place, const Order& order) noexcept HSP_RT;
  bool enable(ModelState& model, uint32_t param) noexcept HSP_RT;
  static bool isTraced(const ModelState& model) noexcept HSP_RT;
  bool change(ModelState& model, const Order& order) noexcept HSP_RT;
  void releaseLeaving() noexcept HSP_RT;
  void receiveRecords() noexcept HSP_RT;
  /// [m] Returns how deep a probe was in the models in the last tick; 0 if it touched none.
  double deepest(uint32_t probe) const noexcept HSP_RT;
  void moveKinematic(ModelState& model, double t, double dt) noexcept HSP_RT;
  void findJumps(double dt, std::span<const Probe> probes) noexcept HSP_RT;
  void stepModel(uint32_t index, double t, double dt, std::span<const Probe> probes) noexcept HSP_RT;
  bool mayRest(const ModelState& model, uint32_t index, double dt) const noexcept HSP_RT;
  struct CostStart {
    Nanoseconds wall = 0, cpu = 0;  ///< 0: not measured
  };
  CostStart beginCost() const noexcept HSP_RT;
  void takeCost(ModelState& model, const CostStart& begun) noexcept HSP_RT;
  bool excused() noexcept HSP_RT;
  bool setLevel(ModelState& model, uint32_t level) noexcept HSP_RT;
  void fillProbe(const ModelState& model, const Probe& probe, uint32_t index, double t) noexcept HSP_RT;
  void callShape(ModelState& model, double dt, hsp_pose& pose) noexcept HSP_RT;
  ShapeFault checkAnswer(ModelState& model, uint32_t index, double dt, const hsp_pose& pose) noexcept HSP_RT;
  void fadeContact(uint32_t index, uint32_t probe, double part) noexcept HSP_RT;
  ShapeFault holdToClaims(ModelState& model, uint32_t index, double dt) noexcept HSP_RT;
  ShapeFault holdToClaim(ModelState& model, uint32_t index, uint32_t probe, double dt) noexcept HSP_RT;
  bool holdTorque(const ModelState& model, Claim& claim, uint32_t probe, double dt) noexcept HSP_RT;
  bool pulls(ModelState& model) noexcept HSP_RT;
  bool gives(ModelState& model, uint32_t index, double dt) noexcept HSP_RT;
  ShapeFault holdToTime(ModelState& model) noexcept HSP_RT;
  ShapeFault takePose(ModelState& model, hsp_pose pose) noexcept HSP_RT;
  Vector3d touchedPlace(uint32_t index, uint32_t probe) const noexcept HSP_RT;
  Vector3d pushDirection(uint32_t index, uint32_t probe) const noexcept HSP_RT;
  bool runsAway(const ModelState& model, uint32_t index, double dt) const noexcept HSP_RT;
  void recordMotion(const ModelState& model, uint32_t index) noexcept HSP_RT;
  void recordContact(const ModelState& model, const Contact& contact, uint32_t probe) noexcept HSP_RT;
  void takeContact(ModelState& model, uint32_t index, uint32_t probe, double gain) noexcept HSP_RT;
  bool enters(ModelState& model, std::span<const Probe> probes, double& pace) const noexcept HSP_RT;
  void clearContacts(uint32_t index) noexcept HSP_RT;
  void listLive() noexcept HSP_RT;
  void sendTransform(ModelState& model, uint32_t index) noexcept HSP_RT;

  CoreSettings settings_;
  RequiredResults uses_;
  link::Link& link_;
  uint32_t probe_count_;
  std::vector<ModelState> models_;
  std::vector<uint32_t> live_;  // see live(). It is in scene order, so that forces are always added in the same order
  std::vector<Load> loads_;     // costs of the models that were stepped
  LoadShedding shedding_;
  std::vector<Claim> claims_;            // see at()
  std::vector<EnergyAccount> energies_;  // see at()
  // The answer that is being judged. It is a member, because constructing it for each answer would take as long as
  // judging it.
  ClaimStep claim_step_;
  Eigen::Matrix3d turn_ = Eigen::Matrix3d::Identity();  // rotation in this tick of the model that is being judged
  std::vector<Contact> contacts_;                       // see at()
  std::vector<hsp_probe> inputs_;                       // probes for the model being stepped
  std::vector<hsp_contact> outputs_;
  // The number of records per tick is bounded, so that many records at once do not make a tick late. The rest waits for
  // the next tick.
  std::array<link::ActivationRecord, 1024> received_;
  size_t received_count_ = 0;
  std::vector<Vector3d> last_position_;               // position at the last good sample, by probe
  std::vector<Eigen::Quaterniond> last_orientation_;  // orientation at the last good sample, by probe
  std::vector<uint8_t> jumped_, seen_;
  std::vector<Vector3d> forces_, torques_;
  std::vector<passivity::Exchange> exchanges_;
  SpscRing<uint32_t> released_{256};
  uint32_t leaving_ = 0, present_ = 0;
  bool needs_search_ = true;
  uint32_t transforms_ = 0;
  double epoch_ = 0;
  uint64_t tick_ = 0;
  uint64_t budget_left_ns_ = 0;
  bool preempted_ = false;  // true if the kernel interrupted the thread in this tick; only excused() finds this out
  // After a tick that was too long, CPU time is measured for a while, at the cost of one system call per step.
  uint32_t suspicious_ = 0;  // ticks for which CPU time is still measured
  bool cpu_timed_ = false;   // CPU time was measured in the last tick
};

}  // namespace hapticd::servo

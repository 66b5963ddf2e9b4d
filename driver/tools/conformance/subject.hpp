// SPDX-License-Identifier: MIT
/// One instance of a shape under test, which a conformance test drives through the C ABI alone.
#pragma once
#include <Eigen/Core>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/result.hpp"
#include "conformance/touch.hpp"
#include "description/scene.hpp"
#include "hapticd/shape.h"
#include "host/library.hpp"
#include "host/services.hpp"

namespace hapticd::conformance {

/// Describes how every instance of a check is made.
struct Recipe {
  std::string file, class_name;
  /// Parameters that were checked against the plugin's table; all others keep their defaults.
  std::vector<scene::Value> set;
  Touch touch;  ///< where the shape can be touched; empty until such a place was searched for
};

/// The answer to one step; some tests compare it bit for bit.
struct Answer {
  hsp_status status = HSP_OK;
  std::vector<hsp_contact> contacts;
  hsp_pose pose{};
  bool jumped = false;  ///< the probe jumped, so this answer cannot be compared with the one before
};
bool sameBits(const Answer& a, const Answer& b);
bool finite(const Answer& answer);
/// Returns which output is not a finite number, such as "contact.force[1] is nan; expected a finite number", or "".
std::string notFinite(const Answer& answer);

/// The cost of one step.
struct StepCost {
  uint64_t wall_ns = 0, cpu_ns = 0;
  bool waited = false;  ///< the step released the processor by itself
};

class Subject {
 public:
  /// Loads the plugin, creates an instance and sets its parameters. An error is in the plugin's own words.
  static Result<std::unique_ptr<Subject>> make(const Recipe& recipe);
  ~Subject();
  Subject(const Subject&) = delete;
  Subject& operator=(const Subject&) = delete;

  Result<void> activate(uint32_t probes = 1);
  hsp_status activateRaw(uint32_t probes, hsp_report& report);
  void deactivate();

  /// Moves every probe to a position within dt [s]. Velocities follow from the positions before. Every fifth step also
  /// makes a proximity search, as the host does.
  const Answer& step(const std::vector<Eigen::Vector3d>& positions, double dt, uint32_t flags = 0);
  /// Makes a step with one probe exactly as given, without a proximity search.
  const Answer& stepRaw(const hsp_probe& probe, double dt);
  /// From now on probes have the quantities that these flags stand for (HSP_R_VELOCITY, HSP_R_ORIENTATION), even if the
  /// shape did not ask for them.
  void give(uint32_t flags) { given_ = flags; }
  /// From now on every step takes 0 s and has the same time, so that a shape that moves stays where it is. What holds
  /// for shapes at rest then holds for it, too. The velocity of a probe is that of the time that step() was given.
  void stopTime() { stopped_ = true; }
  /// From now on the cost of each step is measured, and cost() returns that of the last step.
  void measureCost() { measured_ = true; }
  const StepCost& cost() const { return cost_; }
  /// Puts this much room between the records of a step, to show whether the shape uses the strides.
  void widen(size_t bytes) { room_ = bytes; }
  bool roomUntouched() const;
  /// Allocates the records of a step now, so that they lie in guarded memory if the caller has guarded its allocations.
  void reserve(size_t probes);
  void reset();

  const hsp_class& description() const { return *class_; }
  const hsp_report& report() const { return report_; }
  const std::vector<Place>& places() const { return places_; }  ///< the places where it can be touched
  hsp_shape* handle() const { return shape_; }
  const void* extension(const char* name) const;
  bool moves() const { return (report_.flags & HSP_R_MOVES) != 0; }
  double damping() const { return damping_; }  ///< [N s/m] the largest damping that its parameters ask for
  double energy() const;                       ///< [J] stored energy; NaN if the shape does not report it
  /// Returns the box of the shape in its own frame [m]. If it is unknown, returns a cube from -0.1 m to 0.1 m.
  std::pair<Eigen::Vector3d, Eigen::Vector3d> bounds() const;
  uint64_t stepNs() const { return step_ns_; }           ///< [ns] wall-clock time of the last step
  uint64_t allocations() const { return allocations_; }  ///< number of allocations in all steps since activate()
  uint64_t locks() const { return locks_; }  ///< number of locks in all steps since countLocksOf() was called

 private:
  Subject() = default;
  void search(const std::vector<hsp_probe>& probes);
  void call(const hsp_step& step);
  const Answer& run(const std::vector<hsp_probe>& probes, double dt);

  std::shared_ptr<host::Library> library_;
  std::unique_ptr<host::Services> services_;
  const hsp_class* class_ = nullptr;
  hsp_shape* shape_ = nullptr;
  hsp_report report_{};
  bool active_ = false;
  double damping_ = 0;
  std::vector<Place> places_;
  hsp_pose pose_{};
  Answer answer_;
  std::vector<Eigen::Vector3d> last_;
  std::vector<std::vector<uint8_t>> traced_;  // [probe][surface]
  std::vector<uint8_t> in_, out_;             // records with room between them
  size_t room_ = 0;
  uint64_t steps_ = 0, ticks_ = 0, step_ns_ = 0, allocations_ = 0, locks_ = 0;
  uint32_t given_ = 0;
  bool measured_ = false, stopped_ = false;
  StepCost cost_;
};

}  // namespace hapticd::conformance

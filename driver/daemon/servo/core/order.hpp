// SPDX-License-Identifier: MIT
/// What a person asks of the running servo. Ordinary threads prepare it, a ring carries it, and the servo obeys at the
/// start of a tick; a recording keeps it, because it changes forces.
#pragma once
#include <cstdint>

#include "hapticd/shape.h"
#include "link/lead.hpp"

namespace hapticd::servo {

struct ModelState;

struct Order {
  enum class Kind : uint32_t {
    kNone,
    kEnable,   ///< the model becomes felt: its force fades in
    kDisable,  ///< the model becomes unfelt: its force fades out; it is still traced
    kMove,     ///< a kinematic model goes to a pose and stays
    kSet,      ///< a live parameter
    kClear,    ///< the arm's latched fault is cleared; the force ramps in
    kHold,     ///< the arm's force ramps out until it is cleared
    kAdopt,    ///< a prepared model takes an empty place
    kRelease,  ///< the model fades out and leaves its place
    // What the servo decides by itself, because of times that a replay cannot measure again. It is kept as orders are.
    kAccuracy,  ///< how exactly a model answers
    kOverran,   ///< the model's step took too long, which counts against it
    kCut,       ///< the watchdog cut the arm's motors
    // Programs outside.
    kLead,   ///< a leader begins; `param` says what it leads
    kUnlead  ///< it has gone
  };
  /// What a lead moves: `param` of kLead and kUnlead.
  enum class Led : uint32_t {
    kModel,  ///< the pose of a kinematic model
    kHand,   ///< where the hand of a simulated arm wants to be
    kForce   ///< a force on the hand of an arm
  };
  /// `param` of kEnable: the model is felt once no tip is in it.
  static constexpr uint32_t kOnceFree = 1;
  Kind kind = Kind::kNone;
  uint32_t target = 0;  ///< kSet; of leads: Led; kEnable: kOnceFree or, in older recordings, 0
  uint32_t param = 0;   ///< number of the request, for the answer
  uint32_t ticket = 0;  ///< for a lead of a force: which of the arm's places
  uint32_t place = 0;   ///< of leads of a force: which of the arm's
  double value = 0;     ///< kSet; kAccuracy: the level; kCut: 1 found before the tick's read, 0 at its write
  double seconds = 0;  ///< kMove: how long it takes at least, 0: the servo's choice; kCut: how long the servo was stuck
  double position[3] = {}, orientation[4] = {1, 0, 0, 0};  ///< kMove: world frame; no orientation (zeros): it stays
  ModelState* model = nullptr;                             ///< kAdopt: exchanged with the empty place
  const link::PoseSlot* slot = nullptr;                    ///< kLead: its memory, valid until kUnlead was obeyed
  const link::PushSlot* push = nullptr;                    ///< the same, for a force
};

}  // namespace hapticd::servo

// SPDX-License-Identifier: MIT
/// A change that the running servo makes at the start of a tick. A user or a program requests it, an ordinary thread
/// prepares it, and a ring buffer passes it to the servo. Some orders are decisions of the servo itself. Recordings
/// contain the orders, because orders change forces.
#pragma once
#include <cstdint>

#include "hapticd/shape.h"
#include "link/lead.hpp"

namespace hapticd::servo {

struct ModelState;

struct Order {
  enum class Kind : uint32_t {
    kNone,
    kEnable,   ///< the force of the model fades in, so that it is felt
    kDisable,  ///< the force of the model fades out; the model is still traced
    kMove,     ///< a kinematic model goes to a pose and stays
    kSet,      ///< sets a live parameter
    kClear,    ///< the arm's latched fault is cleared; the force ramps in
    kHold,     ///< the arm's force ramps out until it is cleared
    kAdopt,    ///< a prepared model gets an empty place in the list of models
    kRelease,  ///< the force of the model fades out, and its place becomes empty
    // Decisions of the servo itself. They depend on measured times, which a replay cannot repeat, so they are recorded.
    kAccuracy,  ///< the accuracy level of a model changed
    kOverran,   ///< the model's step took too long and was counted as a strike (Guard::strike())
    kCut,       ///< the watchdog cut the arm's motors
    // Leads of other programs.
    kLead,    ///< a leader begins; `param` says what it leads
    kUnlead,  ///< the leader has gone
    /// A text for the stream `marks`, which has it instead of `orders`. It changes nothing. `target` is kNoModel for a
    /// mark of a program, otherwise the model that the text describes.
    kMark
  };
  static constexpr uint32_t kNoModel = UINT32_MAX;
  static constexpr uint32_t kTextBytes = 96;  ///< [bytes] size of `text`, with the zero at its end
  /// What a lead moves: `param` of kLead and kUnlead.
  enum class Led : uint32_t {
    kModel,  ///< the pose of a kinematic model
    kHand,   ///< the position to which the hand of a simulated arm wants to go
    kForce   ///< a force on the hand of an arm
  };
  /// `param` of kEnable: the model is felt only after no tip has been inside it for some time.
  static constexpr uint32_t kOnceFree = 1;
  Kind kind = Kind::kNone;
  uint32_t target = 0;  ///< index of the model or the arm
  /// kSet: the parameter; leads: Led; kEnable: kOnceFree, or 0 in older recordings; kMark: how many texts are to come
  uint32_t param = 0;
  uint32_t place = 0;  ///< kLead and kUnlead of a force: place of the program in ClientForces::clients()
  double value = 0;  ///< kSet: new value; kAccuracy: level; kCut: 1 if found before the tick's read, 0 if at its write
  double seconds = 0;  ///< kMove: shortest duration, 0: the servo chooses; kCut: how long the servo was stuck
  double position[3] = {}, orientation[4] = {1, 0, 0, 0};  ///< kMove: world frame; four zeros keep the orientation
  ModelState* model = nullptr;  ///< kAdopt: the prepared model; its content is swapped with that of the empty place
  const link::PoseSlot* slot = nullptr;  ///< kLead: the leader's memory, valid until kUnlead was obeyed
  const link::PushSlot* push = nullptr;  ///< kLead of a force: the program's memory, valid until kUnlead was obeyed
  char text[kTextBytes] = {};            ///< kMark: UTF-8 without control characters, filled up with zeros
};

}  // namespace hapticd::servo

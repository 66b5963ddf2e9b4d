// SPDX-License-Identifier: MIT
/// Forces that programs outside put on the hand of one arm. Each program answers ticks; what it says is bounded, fades
/// in, and ramps out once it is silent. The sum goes through everything that the force of a model goes through.
#pragma once
#include <Eigen/Core>
#include <array>
#include <atomic>
#include <cstdint>

#include "description/scene.hpp"
#include "hapticd/client.h"
#include "link/lead.hpp"

namespace hapticd::servo {

class ClientForces {
 public:
  static constexpr uint32_t kMost = 8;          ///< programs that push on one arm
  static constexpr double kSilentAfter = 3e-3;  ///< [s] after its last answer a program's force begins to ramp out
  static constexpr double kFadeOut = 17e-3;     ///< [s] from full force to none: none is left 20 ms after the answer
  static constexpr double kFadeIn = 50e-3;      ///< [s] from none to full force
  static constexpr double kOldest = 20e-3;      ///< [s] an answer to an older tick does not count
  static constexpr double kLargestNumber = link::kLargestPush;  ///< [N], [N m] more than any sound program asks for

  /// Why an answer was refused.
  enum class Refusal : uint32_t { kNone, kNotFinite, kTooLarge, kAhead };

  /// One program. Other threads read the counts.
  struct Client {
    hapticd_push push{};                       ///< the last answer that was taken
    double gain = 0, silence = 0;              ///< [s]
    const link::PushSlot* slot = nullptr;      ///< its memory; nullptr: the program has gone, and its force ramps out
    uint64_t seen = 0;                         ///< count of the memory
    bool answered = false;                     ///< ever
    bool fresh = false;                        ///< `push` was taken in this tick
    std::atomic<uint64_t> answers{0};          ///< that were taken
    std::atomic<uint64_t> in_time{0};          ///< of these, answers in the tick that they answer
    std::atomic<uint64_t> silences{0};         ///< times that it fell silent
    std::atomic<uint64_t> next_tick{0};        ///< of the answers, those one tick late
    std::atomic<double> felt{0};               ///< [N] of its force now, bounded and faded
    std::atomic<double> largest{0};            ///< [N] of that ever
    std::atomic<double> asked{0};              ///< [N] the largest that it asked for
    std::atomic<double> given{0};              ///< [N] of its last answer, bounded
    std::atomic<double> quiet{0};              ///< [s] how long it has been silent; 0: it is not, or never answered
    std::atomic<uint64_t> bounded{0};          ///< answers that were cut to the bound
    std::atomic<uint64_t> refused{0};          ///< answers that were refused
    std::atomic<Refusal> why{Refusal::kNone};  ///< the last of these
  };

  /// [main] @param device_force [N] what the device's limits let through, 0: no bound
  /// @param device_torque [N m] the same; 0: no limit is known, so programs apply no torque
  /// @param period [s] of the servo
  ClientForces(const scene::Clients& clients, double device_force, double device_torque, double period);

  bool possible() const noexcept { return mode_ != scene::ClientMode::kOff; }  ///< programs may push

  /// [rt] A program begins. @param slot its memory, valid until end() @param place below kMost
  void begin(uint32_t place, const link::PushSlot& slot) noexcept HSP_RT;
  void end(uint32_t place) noexcept HSP_RT;  ///< [rt] it has gone

  /// [rt] True if a program that answered one of the last two ticks has not answered this one yet.
  bool awaits(uint64_t tick) const noexcept HSP_RT;

  /// [rt] Once per tick, after the shapes: takes what the programs want. @param tick number of this tick, @param dt [s]
  void collect(uint64_t tick, double dt) noexcept HSP_RT {
    if (places_ == 0 && share_ == 1) return;
    step(tick, dt);
  }

  const Eigen::Vector3d& force() const noexcept { return force_; }    ///< [N] sum of all of them, world frame
  const Eigen::Vector3d& torque() const noexcept { return torque_; }  ///< [N m]
  double share() const noexcept { return share_; }       ///< share of the models' force that is felt beside it: 0 to 1
  bool present() const noexcept { return places_ > 0; }  ///< somebody pushes, or the rest of a push ramps out
  const std::array<Client, kMost>& clients() const noexcept { return clients_; }
  uint64_t refused() const noexcept { return refused_; }  ///< [rt] how many answers were refused so far
  double bound() const noexcept { return max_force_; }    ///< [any] [N] of the force of each program; infinity: none

 private:
  void step(uint64_t tick, double dt) noexcept HSP_RT;
  void step(Client& client, uint64_t tick, double dt) noexcept HSP_RT;
  bool take(Client& client, uint64_t tick) noexcept HSP_RT;
  static Refusal refusalOf(const hapticd_push& push, uint64_t tick) noexcept HSP_RT;
  void note(Client& client) const noexcept HSP_RT;

  scene::ClientMode mode_;
  double max_force_, max_torque_;
  uint64_t oldest_ticks_;
  uint32_t places_ = 0;  ///< that are taken
  uint64_t refused_ = 0;
  double share_ = 1;
  Eigen::Vector3d force_ = Eigen::Vector3d::Zero(), torque_ = Eigen::Vector3d::Zero();
  std::array<Client, kMost> clients_{};
};

}  // namespace hapticd::servo

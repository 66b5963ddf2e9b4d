// SPDX-License-Identifier: MIT
/// Forces by which other programs push on the hand of one arm. Each program answers ticks with a force. This force is
/// bounded, fades in, and ramps out once the program is silent. The sum of all these forces passes the same limits as
/// the force of a model.
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
  static constexpr uint32_t kMost = 8;  ///< most programs that can push on one arm at a time
  /// [s] a program's force ramps out from this time after its last answer
  static constexpr double kSilentAfter = 3e-3;
  /// [s] time from full force to none: the force is zero 20 ms after the last answer
  static constexpr double kFadeOut = 17e-3;
  static constexpr double kFadeIn = 50e-3;  ///< [s] time from none to full force
  static constexpr double kOldest = 20e-3;  ///< [s] an answer to a tick older than this does not count
  static constexpr double kLargestNumber = link::kLargestPush;  ///< [N], [N m] a larger number is refused as an error

  /// Why an answer was refused. kAhead: it answers a tick that has not begun.
  enum class Refusal : uint32_t { kNone, kNotFinite, kTooLarge, kAhead };

  /// One program. Other threads read the counts.
  struct Client {
    hapticd_push push{};           ///< the last answer that was accepted
    double gain = 0, silence = 0;  ///< factor of its force, 0 to 1; [s] since its last answer
    /// the memory of its lead; nullptr if the program has gone, so that its force ramps out
    const link::PushSlot* slot = nullptr;
    uint64_t seen = 0;                         ///< sequence number of the last record read from `slot`
    bool answered = false;                     ///< true once it has answered any tick
    bool fresh = false;                        ///< true if `push` was accepted in this tick
    std::atomic<uint64_t> answers{0};          ///< accepted answers
    std::atomic<uint64_t> in_time{0};          ///< accepted answers that came within the tick that they answer
    std::atomic<uint64_t> silences{0};         ///< how often it fell silent
    std::atomic<uint64_t> next_tick{0};        ///< accepted answers that came one tick late
    std::atomic<double> felt{0};               ///< [N] size of its force now, bounded and faded
    std::atomic<double> largest{0};            ///< [N] largest `felt` so far
    std::atomic<double> asked{0};              ///< [N] largest force that it asked for
    std::atomic<double> given{0};              ///< [N] size of its last answer, bounded
    std::atomic<double> quiet{0};              ///< [s] how long it has been silent; 0: not silent, or it never answered
    std::atomic<uint64_t> bounded{0};          ///< answers that asked for more than the bound
    std::atomic<uint64_t> refused{0};          ///< answers that were refused
    std::atomic<Refusal> why{Refusal::kNone};  ///< reason of the last refusal
  };

  /// [main] @param device_force [N] largest force that the device's limits let through; 0: no limit
  /// @param device_torque [N m] largest torque; 0: no limit is known, and programs can apply no torque
  /// @param period [s] of the servo
  ClientForces(const scene::Clients& clients, double device_force, double device_torque, double period);

  bool possible() const noexcept { return mode_ != scene::ClientMode::kOff; }  ///< true if programs may push

  /// [rt] A program begins to push. @param slot its memory, valid until end() @param place index of a free place in
  /// clients(), below kMost
  void begin(uint32_t place, const link::PushSlot& slot) noexcept HSP_RT;
  void end(uint32_t place) noexcept HSP_RT;  ///< [rt] the program has gone

  /// [rt] True if a program that answered one of the last two ticks has not answered this one yet.
  bool awaits(uint64_t tick) const noexcept HSP_RT;

  /// [rt] Called once per tick, after the shapes: reads the programs' answers. @param tick number of this tick
  /// @param dt [s]
  void collect(uint64_t tick, double dt) noexcept HSP_RT {
    if (places_ == 0 && share_ == 1) return;
    step(tick, dt);
  }

  const Eigen::Vector3d& force() const noexcept { return force_; }  ///< [N] sum of all programs, world frame
  const Eigen::Vector3d& torque() const noexcept { return torque_; }
  /// factor for the force of the models, 0 to 1; below 1 only with ClientMode::kInstead, while a program pushes
  double share() const noexcept { return share_; }
  /// true while a program pushes, or its force ramps out
  bool present() const noexcept { return places_ > 0; }
  const std::array<Client, kMost>& clients() const noexcept { return clients_; }
  uint64_t refused() const noexcept { return refused_; }  ///< [rt] how many answers were refused so far
  double bound() const noexcept { return max_force_; }  ///< [any] [N] largest force of each program; infinite: no bound

 private:
  void step(uint64_t tick, double dt) noexcept HSP_RT;
  void step(Client& client, uint64_t tick, double dt) noexcept HSP_RT;
  bool take(Client& client, uint64_t tick) noexcept HSP_RT;
  static Refusal refusalOf(const hapticd_push& push, uint64_t tick) noexcept HSP_RT;
  void note(Client& client) const noexcept HSP_RT;

  scene::ClientMode mode_;
  double max_force_, max_torque_;
  uint64_t oldest_ticks_;
  uint32_t places_ = 0;  ///< number of places in use
  uint64_t refused_ = 0;
  double share_ = 1;
  Eigen::Vector3d force_ = Eigen::Vector3d::Zero(), torque_ = Eigen::Vector3d::Zero();
  std::array<Client, kMost> clients_{};
};

}  // namespace hapticd::servo

// SPDX-License-Identifier: MIT
/// Keeps the leads: gives a leader the shared memory of its lead, allows one leader per target, and ends a lead when
/// the leader's connection ends. Only the request worker may use it.
#pragma once
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "base/result.hpp"
#include "base/sealed_memory.hpp"
#include "control/server.hpp"
#include "servo/arm/client_forces.hpp"
#include "servo/core/order.hpp"

namespace hapticd::servo {

class Leads {
 public:
  /// Gives an order to the servo and waits until it is obeyed.
  using PostOrder = std::function<Result<void>(const Order&)>;

  /// The target of a lead.
  struct Target {
    Order::Led led = Order::Led::kModel;
    uint32_t index = 0;  ///< number of the model or the arm
    std::string name;    ///< such as "model door", for messages
    uint32_t place = 0;  ///< the program's place on the arm if it leads a force; begin() chooses it
  };

  /// A program that pushes on an arm.
  struct Pusher {
    pid_t pid;
    uint32_t place;
    std::string program;
  };
  /// What a pushing program did. kBegins: it begins to push. kEnds: a request ended the push. kLeft: its connection has
  /// ended.
  enum class PushEvent { kBegins, kEnds, kLeft };
  /// Called when a program begins or stops pushing on an arm.
  using OnPushEvent = std::function<void(uint32_t arm, const Pusher& pusher, PushEvent news)>;

  /// @param exclusive true if only one program may push on an arm; otherwise as many as there are places
  explicit Leads(PostOrder post_order, bool exclusive = false, OnPushEvent on_push_event = nullptr)
      : post_order_(std::move(post_order)), on_push_event_(std::move(on_push_event)), exclusive_(exclusive) {}
  ~Leads();  ///< reports the end of programs that still push
  Leads(const Leads&) = delete;
  Leads& operator=(const Leads&) = delete;

  /// [main] Begins a lead. @return a descriptor of its memory. If the target has a leader already, the error names it.
  Result<Descriptor> begin(Target target, const control::Peer& peer);
  /// [main] Ends this peer's lead of a target.
  Result<void> end(const Target& target, const control::Peer& peer) { return end(target, peer, PushEvent::kEnds); }
  /// [main] Ends the lead of a model, if there is one, because something else moves the model, or it is removed.
  Result<void> endOfModel(uint32_t model);
  /// [main] Ends all leads of a force, because programs may no longer push. Later answers of these programs are not
  /// read.
  void endPushes();
  /// [main] Ends all leads of a peer whose connection is gone.
  void left(const control::Peer& peer);

  /// [main] Returns the process that has a lead of this model, or of this arm's hand or force, if there is one.
  std::optional<pid_t> leader(Order::Led led, uint32_t index) const;
  /// [main] Returns the name of the program that led or pushed as process `pid`; "?" if there was none, or if its name
  /// was forgotten.
  std::string program(pid_t pid) const;
  /// [main] Returns the programs that push on an arm.
  std::vector<Pusher> pushers(uint32_t arm) const;
  /// [main] True if programs may push. The scene sets the first value, and a request can change it.
  bool mayPush() const { return may_push_; }
  void setMayPush(bool may) { may_push_ = may; }  ///< [main] sets mayPush()
  /// [main] True if this peer has a lead, which ends with its connection.
  bool holds(const control::Peer& peer) const;
  /// [main] Returns the ids of all peers that have a lead.
  std::set<uint64_t> holders() const;

 private:
  struct Lead {
    Target target;
    control::Peer peer;
    std::unique_ptr<SealedMemory> memory;
    std::string program;  ///< name of the leading program
  };
  Result<void> end(const Target& target, const control::Peer& peer, PushEvent how);
  Result<void> finish(Lead lead, PushEvent how);
  void notify(const Lead& lead, PushEvent news) const;
  Result<void> findPlace(Target& target, const control::Peer& peer);

  PostOrder post_order_;
  OnPushEvent on_push_event_;
  bool exclusive_, may_push_ = true;
  uint32_t last_place_ = 0;
  std::vector<Lead> leads_;
  std::map<pid_t, std::string> programs_;            ///< names of the newest programs
  std::vector<std::unique_ptr<SealedMemory>> kept_;  ///< memory of ended leads that the servo may still read
};

}  // namespace hapticd::servo

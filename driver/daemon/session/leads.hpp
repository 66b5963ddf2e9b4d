// SPDX-License-Identifier: MIT
/// Who leads what: hands out the memory of leads, one leader per target, and ends a lead with the connection that asked
/// for it. Control thread only.
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
  using Give = std::function<Result<void>(const Order&)>;

  /// What is led, and the name by which its leader knows it.
  struct Target {
    Order::Led led = Order::Led::kModel;
    uint32_t index = 0;  ///< model or arm
    std::string name;    ///< "model door", for messages
    uint32_t place = 0;  ///< for a force; given by begin()
  };

  /// A program that pushes.
  struct Pusher {
    pid_t pid;
    uint32_t place;
    std::string program;
  };
  /// A program begins to push; it ends by a request, or when its connection is gone.
  enum class News { kBegins, kEnds, kLeft };
  /// Is told when a program begins or stops pushing on an arm.
  using Tell = std::function<void(uint32_t arm, const Pusher& pusher, News news)>;

  /// @param exclusive one program pushes on an arm; otherwise as many as there are places
  explicit Leads(Give give, bool exclusive = false, Tell tell = nullptr)
      : give_(std::move(give)), tell_(std::move(tell)), exclusive_(exclusive) {}
  ~Leads();  ///< reports those that still push
  Leads(const Leads&) = delete;
  Leads& operator=(const Leads&) = delete;

  /// [main] Begins a lead. @return a descriptor of its memory. An error names the leader that is there already.
  Result<Descriptor> begin(Target target, const control::Peer& peer);
  /// [main] Ends the lead of this peer.
  Result<void> end(const Target& target, const control::Peer& peer) { return end(target, peer, News::kEnds); }
  /// [main] Ends whatever leads a model, because it is moved otherwise, or leaves.
  Result<void> endOfModel(uint32_t model);
  /// [main] Ends all pushes, because the permission is gone. Nobody reads what a program writes from now on.
  void endPushes();
  /// [main] Ends all leads of a peer that is gone.
  void left(const control::Peer& peer);

  /// [main] The process that leads a model or a hand, if one does.
  std::optional<pid_t> leader(Order::Led led, uint32_t index) const;
  /// [main] The name of a process that led or pushed; "?" if none had this number.
  std::string program(pid_t pid) const;
  /// [main] Those that push on an arm.
  std::vector<Pusher> pushers(uint32_t arm) const;
  /// [main] False: programs may not push, whatever the scene said at the start.
  bool mayPush() const { return may_push_; }
  void letPush(bool may) { may_push_ = may; }  ///< [main]
  /// [main] True if something lives as long as the peer's connection.
  bool holds(const control::Peer& peer) const;
  /// [main] Numbers of the peers that hold something.
  std::set<uint64_t> holders() const;

 private:
  struct Lead {
    Target target;
    control::Peer peer;
    std::unique_ptr<SealedMemory> memory;
    std::string program;  ///< that pushes
  };
  Result<void> end(const Target& target, const control::Peer& peer, News how);
  Result<void> finish(Lead lead, News how);
  void tell(const Lead& lead, News news) const;
  Result<void> findPlace(Target& target, const control::Peer& peer);

  Give give_;
  Tell tell_;
  bool exclusive_, may_push_ = true;
  uint32_t last_place_ = 0;
  std::vector<Lead> leads_;
  std::map<pid_t, std::string> programs_;            ///< of the programs that came last
  std::vector<std::unique_ptr<SealedMemory>> kept_;  ///< of leads that the servo did not end, which it may still read
};

}  // namespace hapticd::servo

// SPDX-License-Identifier: MIT
/// The I/O thread of one arm. The thread calls the transport, which may block. The servo thread must not block, so it
/// only exchanges the newest sample and the newest command with the I/O thread. If the device is unplugged, the I/O
/// thread searches for it until it is back.
#pragma once
#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <string>

#include "base/bell.hpp"
#include "base/clock.hpp"
#include "base/os.hpp"
#include "base/triple_buffer.hpp"
#include "hapticd/device_capture.h"
#include "wire_arm/session.hpp"
#include "wire_arm/transport.hpp"

namespace hapticd::wire_arm {

/// Offsets that make the positions of an arm absolute. The default is an arm that is not calibrated.
struct Zero {
  JointArray offset{};
  bool known = false;
};

struct LinkSettings {
  Address address;
  SessionSettings session;
  std::function<void(int level, const std::string&)> log;  ///< [any thread] shows a message to the user
  /// [main] or I/O thread: returns the offsets of an earlier calibration.
  std::function<Zero(const Identity&)> zero;
  /// [main] or I/O thread: uploads firmware after wire.startup. May be empty.
  std::function<Result<void>(Transport&)> prepare;
};

class Link {
 public:
  Link(std::unique_ptr<Transport> transport, const codec::Wire& wire, LinkSettings settings);
  ~Link();
  Link(const Link&) = delete;
  Link& operator=(const Link&) = delete;

  /// [main] Finds and opens the device, and runs its start-up sequence.
  Result<Identity> open();
  /// [main] Starts the thread and waits for the first report.
  Result<void> start();
  /// [main] Captures the transfers of a device that is open but not started. Keeps the motors off and passes every
  /// transfer to `take`, until `take` returns a number other than 0.
  Result<void> capture(hdv_take_transfer take, void* who);
  /// [main] Switches the motors off and joins the thread.
  void stop();
  /// [main] Closes the device.
  void close();

  /// [rt] Returns the newest sample. @return false if it is the same as at the last call
  bool read(Sample& sample) noexcept HSP_RT;
  /// [rt] To be called between two ticks, if the samples of the arm pace the servo. Lets the I/O thread send the newest
  /// command at once, and sleeps until there is a new sample or trouble, at the latest until `until`. From the first
  /// call on, the I/O thread sends each command as soon as it comes.
  void waitForNews(Nanoseconds until) noexcept;
  /// [rt] Gives the newest command to the I/O thread.
  void write(const ArmCommand& wanted) noexcept HSP_RT;

  /// [any] Switches the motors off until endCut(), whatever the commands of the servo are. Async-signal-safe. The I/O
  /// thread sends the cut with its next command, at most about one period of wire.rate later.
  void cut() noexcept;
  /// [any] Returns false while a cut must still be sent to the arm; true if there is no cut or no arm.
  /// Async-signal-safe.
  bool cutLeft() const noexcept { return !cut_.load() || cut_left_.load(); }
  /// [any] Fills in how another process can switch the motors off. Returns false if another process cannot reach the
  /// device, or if no report has come yet, because it may then be the wrong device.
  bool silence(hdv_silence& how) const;
  /// [rt] Ends a cut: the commands after this call are sent again.
  void endCut() noexcept HSP_RT { cut_.store(false, std::memory_order_release); }

  /// [main] While `wanted` is true, tells the device to find its zero.
  void calibrateByDevice(bool wanted) noexcept { calibrate_.store(wanted); }
  /// [main] Sets the zero so that the present positions of the arm are `pose`. @return the offsets, to be stored
  Result<JointArray> calibrateAt(const JointArray& pose);
  /// [main] The identity of the device that is open.
  Identity identity() const;

 private:
  void run() noexcept;
  void forgetOld() noexcept;
  void serve(Nanoseconds now) noexcept;
  void receive(Nanoseconds wait) noexcept;
  void takeZero() noexcept;
  void send(Nanoseconds now) noexcept;
  Nanoseconds midway(Nanoseconds due) const noexcept;
  Nanoseconds readUntil(Nanoseconds now) const noexcept;
  void lose(Trouble trouble) noexcept;
  void findDevice() noexcept;
  void logTrouble() noexcept;
  void publish() noexcept;
  void publishToServo() noexcept;
  Result<Identity> bringUp();
  void prepareSilence();
  Result<void> startUp();
  Result<void> perform(const codec::StartStep& step);

  std::unique_ptr<Transport> transport_;
  codec::Wire wire_;
  LinkSettings settings_;
  Session session_;
  TripleBuffer<Sample> samples_;
  TripleBuffer<ArmCommand> commands_;
  Bell news_, commanded_;  ///< news_ wakes the servo for a sample or a trouble; commanded_ wakes the I/O thread
  uint32_t heard_ = 0;     ///< the servo's count of news_ at its last read()
  os::Thread thread_;
  /// cut_: cut() was called and endCut() was not; cut_left_: this cut was sent, or there is no arm to which it could be
  /// sent
  std::atomic<bool> cut_{false}, cut_left_{false};
  bool cut_sent_ = false;
  hdv_silence silence_{};              ///< how to reach the device that was opened last
  Descriptor silence_descriptor_;      ///< the descriptor in silence_; empty if the device cannot be opened twice
  std::atomic<bool> reported_{false};  ///< a report came since the device was opened
  std::atomic<bool> paced_{false};     ///< the samples of the arm pace the servo
  std::atomic<bool> stop_{false}, calibrate_{false}, zero_wanted_{false}, zero_done_{false};
  mutable std::mutex
      mutex_;  ///< guards identity_, pose_, silence_ and silence_descriptor_; the servo thread never takes it
  Identity identity_;
  JointArray pose_{}, offset_{};
  bool open_ = false, answered_ = false;
  Trouble told_ = Trouble::kNone;
  std::string refusal_;           ///< why the last try to open the device again failed
  std::string back_ = "healthy";  ///< message for the time when the arm is healthy again
  Nanoseconds tried_at_ = 0;      ///< time of the last try to open the device again
  Nanoseconds due_ = 0, period_ = 0, sent_at_ = 0, reported_at_ = 0;
  uint64_t sent_command_ = 0;
  std::array<uint8_t, codec::kMaxReportBytes + 1> in_{}, out_{};
};

}  // namespace hapticd::wire_arm

// SPDX-License-Identifier: MIT
/// The I/O thread of one arm: between a transport, which may block, and the servo thread, which may not. Newest value
/// wins in both directions. A device that leaves is looked for until it is back.
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

/// The pose in which an arm is plugged in, before anybody calibrated it.
struct Zero {
  JointArray offset{};
  bool known = false;
};

struct LinkSettings {
  Address address;
  SessionSettings session;
  std::function<void(int level, const std::string&)> log;  ///< [any thread] tells users what they should know
  std::function<Zero(const Identity&)> zero;        ///< I/O thread: the offsets that an earlier calibration stored
  std::function<Result<void>(Transport&)> prepare;  ///< more than wire.startup, such as a firmware upload; may be empty
};

class Link {
 public:
  Link(std::unique_ptr<Transport> transport, const codec::Wire& wire, LinkSettings settings);
  ~Link();
  Link(const Link&) = delete;
  Link& operator=(const Link&) = delete;

  /// [main] Finds, opens and starts up the device.
  Result<Identity> open();
  /// [main] Starts the thread and waits for the first report.
  Result<void> start();
  /// [main] Open but not started: reads with the motors off and hands over every transfer, until `take` ends it.
  Result<void> capture(hdv_take_transfer take, void* who);
  /// [main] Switches the motors off and joins the thread.
  void stop();
  /// [main]
  void close();

  /// [rt] The newest sample. @return false if it is no newer than the last one
  bool read(Sample& sample) noexcept HSP_RT;
  /// [rt] Called between two exchanges: sends the newest wish at once, and sleeps until there is something new for
  /// read(), or until `until`. From the first call on, this thread sends each wish when it comes.
  void waitForNews(Nanoseconds until) noexcept;
  /// [rt] Leaves the newest wish for the thread.
  void write(const Wish& wish) noexcept HSP_RT;

  /// [any] Frees the motors, whatever the wishes say, until endCut(); async-signal-safe, and one report late at most.
  void cut() noexcept;
  /// [any] True if a cut has been sent to the arm, or there is no arm to send it to; async-signal-safe.
  bool cutLeft() const noexcept { return !cut_.load() || cut_left_.load(); }
  /// [any] How another process switches the motors off. False if no report has come yet, so that it may be another
  /// device, or if there is no other way to reach it.
  bool silence(hdv_silence& how) const;
  /// [rt] Ends a cut: the next wish counts again.
  void endCut() noexcept HSP_RT { cut_.store(false, std::memory_order_relaxed); }

  /// [main] Tells the device to find its zero (while true).
  void calibrateByDevice(bool wanted) noexcept { calibrate_.store(wanted); }
  /// [main] Makes positions read `pose` where the arm is now. @return offsets, to be stored
  Result<JointArray> calibrateAt(const JointArray& pose);
  /// [main] The identity of the device that is open.
  Identity identity() const;

 private:
  void run() noexcept;
  void forgetOld() noexcept;
  void serve(Nanoseconds now) noexcept;
  void receive(Nanoseconds wait) noexcept;
  void send(Nanoseconds now) noexcept;
  Nanoseconds midway(Nanoseconds due) const noexcept;
  void lose(Trouble trouble) noexcept;
  void lookForIt() noexcept;
  void tell() noexcept;
  void publish() noexcept;
  void tellServo() noexcept;
  Result<Identity> bringUp();
  void prepareSilence();
  Result<void> startUp();
  Result<void> perform(const codec::StartStep& step);

  std::unique_ptr<Transport> transport_;
  codec::Wire wire_;
  LinkSettings settings_;
  Session session_;
  TripleBuffer<Sample> samples_;
  TripleBuffer<Wish> wishes_;
  Bell news_, wished_;  ///< wakes the servo for a sample or a trouble; wakes this thread for a wish
  uint32_t heard_ = 0;  ///< the servo's count of news_ at its last read()
  os::Thread thread_;
  std::atomic<bool> cut_{false}, cut_left_{false};  ///< the watchdog or a crash cut the motors; the cut was sent since
  bool cut_sent_ = false;
  hdv_silence silence_{};  ///< for the device that was opened last
  Descriptor way_in_;
  std::atomic<bool> reported_{false};  ///< since it was opened
  std::atomic<bool> paced_{false};     ///< the servo waits for samples
  std::atomic<bool> stop_{false}, calibrate_{false}, zero_wanted_{false}, zero_done_{false};
  mutable std::mutex mutex_;  ///< guards identity_ and pose_; the servo thread never takes it
  Identity identity_;
  JointArray pose_{}, offset_{};
  bool open_ = false, answered_ = false;
  Trouble told_ = Trouble::kNone;
  std::string refusal_;           ///< why the device could not be opened again
  std::string back_ = "healthy";  ///< what to report once it is well
  Nanoseconds tried_at_ = 0;      ///< to open it again
  Nanoseconds due_ = 0, period_ = 0, sent_at_ = 0;
  uint64_t sent_wish_ = 0;
  std::array<uint8_t, codec::kMaxReportBytes + 1> in_{}, out_{};
};

}  // namespace hapticd::wire_arm

// SPDX-License-Identifier: MIT
/// For hardware whose transfers may block (a serial line, USB, a network): a thread of the module speaks with the arm,
/// and the servo thread exchanges only the newest values with it. It shows what such a thread owes the hand: an arm
/// that falls silent is sent "off" by the clock, not by its next report. The gantry of this template needs none of it.
#pragma once
#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <thread>

#include "board.hpp"

namespace template_arm {

/// Passes the newest value from one thread to one other. Neither waits, and a value that nobody took is replaced.
template <class T>
class Newest {
 public:
  /// [rt]
  void put(const T& value) noexcept {
    values_[writers_] = value;
    writers_ = between_.exchange(static_cast<uint8_t>(writers_ | kNew), std::memory_order_acq_rel) & kWhich;
  }
  /// [rt] @return false if `value` is still that of the last call
  bool take(T& value) noexcept {
    const bool fresh = (between_.load(std::memory_order_relaxed) & kNew) != 0;
    if (fresh) readers_ = between_.exchange(readers_, std::memory_order_acq_rel) & kWhich;
    value = values_[readers_];
    return fresh;
  }

 private:
  static constexpr uint8_t kWhich = 3, kNew = 4;
  std::array<T, 3> values_{};
  std::atomic<uint8_t> between_{0};
  uint8_t writers_ = 1, readers_ = 2;
};

struct MonotonicClock {
  static uint64_t now() noexcept {
    return static_cast<uint64_t>(std::chrono::steady_clock::now().time_since_epoch() / std::chrono::nanoseconds(1));
  }
};

struct Report {
  uint64_t time_ns = 0, sequence = 0;
  Vec3 position{};
};

struct Order {
  uint64_t time_ns = 0;
  Vec3 force{};  ///< all 0: off
};

/// `Port` is your hardware: bool receive(Vec3& position) noexcept waits for a report, but never longer than kWait, and
/// void send(const Vec3& force) noexcept writes a command.
template <class Port, class Clock = MonotonicClock>
class IoThread {
 public:
  static constexpr uint64_t kWait = 5'000'000;   ///< [ns] longest time in receive()
  static constexpr uint64_t kOld = 20'000'000;   ///< [ns] a report or a command that is older moves no motor
  static constexpr uint64_t kRamp = 50'000'000;  ///< [ns] the force returns over this time after a silence

  explicit IoThread(Port& port) : port_(port) {}
  ~IoThread() { stop(); }
  IoThread(const IoThread&) = delete;
  IoThread& operator=(const IoThread&) = delete;

  /// [main] The caller gives the thread its priority (pthread_setschedparam), one above that of the servo.
  void start() {
    stop_ = false;
    thread_ = std::thread([this] {
      while (!stop_) exchange();
    });
  }
  /// [main] Returns when "off" has been sent.
  void stop() {
    if (!thread_.joinable()) return;
    stop_ = true;
    thread_.join();
    port_.send({});
  }
  /// [rt] For read(). @return false: no newer one has come
  bool newest(Report& report) noexcept { return reports_.take(report); }
  /// [rt] For write(), with the time that write() names.
  void leave(const Order& order) noexcept { orders_.put(order); }
  /// [any] For hdv.cut/1; a write() with HDV_OFF ends it.
  void cut(bool free) noexcept { cut_.store(free, std::memory_order_relaxed); }

  /// [io] One round takes a report, or none, and always sends a command. So the motors of an arm that falls silent are
  /// off after kOld + kWait, and an arm that missed a command gets it again.
  void exchange() noexcept {
    Vec3 position{};
    const bool came = port_.receive(position);
    const uint64_t now = Clock::now();
    if (came) take(position, now);
    orders_.take(order_);
    port_.send(allowed(now));
  }

 private:
  void take(const Vec3& position, uint64_t now) noexcept {
    if (isOld(heard_ns_, now)) back_ns_ = now;  // the first one, or one after a silence
    heard_ns_ = now;
    reports_.put({now, ++sequence_, position});
  }
  Vec3 allowed(uint64_t now) const noexcept {
    const bool off = cut_.load(std::memory_order_relaxed) || isOld(heard_ns_, now) || isOld(order_.time_ns, now);
    const double part = std::min(1.0, static_cast<double>(now - back_ns_) / static_cast<double>(kRamp));
    Vec3 force{};
    for (int i = 0; !off && i < 3; ++i) force[i] = part * order_.force[i];
    return force;
  }
  static bool isOld(uint64_t then, uint64_t now) noexcept { return then == 0 || now > then + kOld; }

  Port& port_;
  Newest<Report> reports_;
  Newest<Order> orders_;
  Order order_{};
  uint64_t heard_ns_ = 0, back_ns_ = 0, sequence_ = 0;
  std::atomic<bool> stop_{false}, cut_{false};
  std::thread thread_;
};

}  // namespace template_arm

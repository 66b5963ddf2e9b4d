// SPDX-License-Identifier: MIT
/// For hardware whose transfers may block (a serial line, USB, a network). A thread of the module talks to the arm, and
/// the servo thread only exchanges the newest values with this thread. For safety, the thread sends "off" if no report
/// or no order has come for a fixed time; it does not wait for the next report. The simulated gantry does not use this
/// file.
#pragma once
#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <thread>

#include "board.hpp"

namespace template_arm {

/// Passes the newest value from one thread to another. No thread waits. A newer value replaces one that was not yet
/// taken.
template <class T>
class Newest {
 public:
  /// [rt] Passes a value to the other thread.
  void put(const T& value) noexcept {
    values_[writers_] = value;
    writers_ = between_.exchange(static_cast<uint8_t>(writers_ | kNew), std::memory_order_acq_rel) & kWhich;
  }
  /// [rt] Takes the newest value. @return false if there is no newer one than at the last call
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
  Vec3 force{};  ///< [N] zero means off
};

/// `Port` is your hardware: bool receive(Vec3& position) noexcept waits for a report, but never longer than kWait, and
/// void send(const Vec3& force) noexcept writes a command.
template <class Port, class Clock = MonotonicClock>
class IoThread {
 public:
  static constexpr uint64_t kWait = 5'000'000;   ///< [ns] longest time that receive() may wait
  static constexpr uint64_t kOld = 20'000'000;   ///< [ns] if the report or the command is older, the motors are off
  static constexpr uint64_t kRamp = 50'000'000;  ///< [ns] time in which the force rises again after a silence

  explicit IoThread(Port& port) : port_(port) {}
  ~IoThread() { stop(); }
  IoThread(const IoThread&) = delete;
  IoThread& operator=(const IoThread&) = delete;

  /// [main] Starts the thread. The caller sets its priority (pthread_setschedparam) to one above the servo's priority.
  void start() {
    stop_ = false;
    thread_ = std::thread([this] {
      while (!stop_) exchange();
    });
  }
  /// [main] Ends the thread. Returns when "off" has been sent.
  void stop() {
    if (!thread_.joinable()) return;
    stop_ = true;
    thread_.join();
    port_.send({});
  }
  /// [rt] To be called in read(): returns the newest report. @return false if no newer report has come
  bool newest(Report& report) noexcept { return reports_.take(report); }
  /// [rt] To be called in write(): passes an order to the thread. Set Order::time_ns to the time that write() was
  /// given.
  void leave(const Order& order) noexcept { orders_.put(order); }
  /// [any] While `free` is true, the thread sends only "off". hdv.cut/1 calls this function with true, and a write()
  /// with HDV_OFF calls it with false.
  void cut(bool free) noexcept { cut_.store(free, std::memory_order_relaxed); }

  /// [io] Makes one round: takes a report if one comes, and always sends a command. So if the arm falls silent, its
  /// motors are off after at most kOld + kWait, and an arm that missed a command gets it again.
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
    if (isOld(heard_ns_, now)) back_ns_ = now;  // the first report, or the first after a silence
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

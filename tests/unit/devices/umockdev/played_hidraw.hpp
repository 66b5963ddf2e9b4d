// SPDX-License-Identifier: MIT
/// A hidraw device that exists for this process alone: umockdev gives /sys, the node and its reads, writes and ioctls;
/// an emulated arm is behind them. umockdev's plain files are always readable, so the node is a pseudo-terminal whose
/// one byte says that a report waits, and whose closed master is an unplugged device.
#pragma once
#include <umockdev.h>

#include <atomic>
#include <deque>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include "emulators/emulated_arm.hpp"
#include "played_terminal.hpp"

namespace hapticd::emulator {

class PlayedHidraw {
 public:
  PlayedHidraw(UMockdevTestbed* testbed, int number, EmulatedArm& arm, std::string serial);
  ~PlayedHidraw();
  PlayedHidraw(const PlayedHidraw&) = delete;
  PlayedHidraw& operator=(const PlayedHidraw&) = delete;

  void plug();
  void unplug();
  std::atomic<bool> pushed{false};  ///< what the arm's motors did at the last command

 private:
  using Client = UMockdevIoctlClient;
  static gboolean onIoctl(UMockdevIoctlBase*, Client*, gpointer);
  static gboolean onRead(UMockdevIoctlBase*, Client*, gpointer);
  static gboolean onWrite(UMockdevIoctlBase*, Client*, gpointer);
  void showWaiting();
  void add(const std::string& text);

  UMockdevTestbed* testbed_;
  UMockdevIoctlBase* handler_;
  EmulatedArm& arm_;
  std::string node_, serial_, usb_, hid_name_;
  PlayedTerminal terminal_;
  int number_, plugged_ = 0;
  std::recursive_mutex mutex_;
  bool gone_ = true;
  std::deque<std::vector<uint8_t>> reports_;
};

}  // namespace hapticd::emulator

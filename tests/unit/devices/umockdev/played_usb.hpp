// SPDX-License-Identifier: MIT
/// A USB device that exists for this process alone: umockdev gives /sys and the ioctls of its node, an emulated arm is
/// behind them, and a thread is its clock. umockdev's plain files are always ready, so the node is a pseudo-terminal:
/// writable while a transfer is done, its closed master an unplugged device, as usbfs has it.
#pragma once
#include <linux/usbdevice_fs.h>
#include <umockdev.h>

#include <atomic>
#include <deque>
#include <mutex>
#include <string>
#include <thread>

#include "emulators/usb_arm.hpp"
#include "played_terminal.hpp"

namespace hapticd::emulator {

class PlayedUsb {
 public:
  PlayedUsb(UMockdevTestbed* testbed, int number, UsbArm& arm);
  ~PlayedUsb();
  PlayedUsb(const PlayedUsb&) = delete;
  PlayedUsb& operator=(const PlayedUsb&) = delete;

  void plug();
  void unplug();
  /// Every transfer of the endpoint ends with this status, such as -EPIPE; 0: none does any more.
  void fail(uint8_t endpoint, int status);
  /// The endpoint out takes each command only after so many milliseconds.
  void takeCommandsAfter(int milliseconds);
  void spoil(Fault fault);
  bool pushed();
  uint64_t commands();
  int opened() const { return claimed_; }  ///< times that the interface was claimed

 private:
  using Client = UMockdevIoctlClient;
  static gboolean onIoctl(UMockdevIoctlBase*, Client*, gpointer);
  bool answer(Client* client);
  void submit(usbdevfs_urb* urb);
  bool discard(usbdevfs_urb* urb);
  void feed();
  void finish(usbdevfs_urb* urb, int status);
  void take(usbdevfs_urb* urb);
  void showDone();
  void run();

  UMockdevTestbed* testbed_;
  UMockdevIoctlBase* handler_;
  UsbArm& arm_;
  std::string node_, sys_;
  PlayedTerminal terminal_;
  int number_;
  std::recursive_mutex mutex_;
  bool gone_ = true;
  std::deque<usbdevfs_urb*> waiting_, done_;
  struct Command {
    usbdevfs_urb* urb;
    int after;  // [ms]
  };
  std::deque<Command> commands_;
  int slow_ = 0;
  int failing_status_ = 0;
  uint8_t failing_ = 0;
  std::atomic<int> claimed_{0};
  std::atomic<bool> stop_{false};
  std::thread clock_;
};

}  // namespace hapticd::emulator

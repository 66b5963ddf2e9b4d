// SPDX-License-Identifier: MIT
#include "played_usb.hpp"

#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <stdexcept>

namespace hapticd::emulator {
namespace {

std::string format(const char* pattern, int a, int b = 0) {
  char text[128];
  std::snprintf(text, sizeof text, pattern, a, b);
  return text;
}

std::string hex(const Bytes& bytes) {
  std::string text;
  for (const uint8_t byte : bytes) text += format("%02X", byte);
  return text;
}

}  // namespace

PlayedUsb::PlayedUsb(UMockdevTestbed* testbed, int number, UsbArm& arm)
    : testbed_(testbed),
      handler_(umockdev_ioctl_base_new()),
      arm_(arm),
      node_(format("/dev/bus/usb/001/%03d", number + 2)),
      number_(number) {
  std::signal(SIGHUP, SIG_IGN);  // a closing master must not end a session leader
  g_signal_connect(handler_, "handle-ioctl", G_CALLBACK(onIoctl), this);
  clock_ = std::thread([this] { run(); });
}

PlayedUsb::~PlayedUsb() {
  stop_ = true;
  clock_.join();
  if (!gone_) unplug();
  g_object_unref(handler_);
}

void PlayedUsb::run() {
  while (!stop_) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    const std::lock_guard lock(mutex_);
    arm_.advance(0.001);  // also without its cable: the board's own watchdog cuts the motors
    for (Command& command : commands_) --command.after;
    while (!commands_.empty() && commands_.front().after <= 0) take(commands_.front().urb), commands_.pop_front();
    if (!gone_) feed();
  }
}

void PlayedUsb::plug() {
  const std::lock_guard lock(mutex_);
  const About& about = arm_.about();
  sys_ = format("/sys/devices/pci0000:00/usb1/1-%d", number_ + 1);
  Bytes descriptors = arm_.deviceDescriptor();
  const Bytes configuration = arm_.configuration();
  descriptors.insert(descriptors.end(), configuration.begin(), configuration.end());
  umockdev_testbed_attach_ioctl(testbed_, node_.c_str(), handler_, nullptr);
  const std::string text =
      "P: " + sys_.substr(4) + "\nN: " + node_.substr(5) +
      "\nE: SUBSYSTEM=usb\nE: DEVTYPE=usb_device\nE: DRIVER=usb\nE: DEVNAME=" + node_ +
      format("\nE: BUSNUM=001\nE: DEVNUM=%03d\nA: busnum=1\\n\nA: devnum=%d\\n\n", number_ + 2, number_ + 2) +
      "A: bConfigurationValue=1\\n\nA: speed=12\\n\nA: idVendor=" + format("%04x", about.vendor) +
      "\\n\nA: idProduct=" + format("%04x", about.product) + "\\n\nH: descriptors=" + hex(descriptors) + "\n\n";
  GError* error = nullptr;
  if (!umockdev_testbed_add_from_string(testbed_, text.c_str(), &error)) throw std::runtime_error(error->message);
  terminal_.open(testbed_, node_);
  gone_ = false;
  showDone();
}

void PlayedUsb::unplug() {
  {
    const std::lock_guard lock(mutex_);
    gone_ = true;
    for (usbdevfs_urb* urb : waiting_) finish(urb, -ESHUTDOWN);  // as a host controller flushes them
    for (const Command& command : commands_) finish(command.urb, -ESHUTDOWN);
    waiting_.clear();
    commands_.clear();
    terminal_.close();
  }
  umockdev_testbed_uevent(testbed_, sys_.c_str(), "remove");
  umockdev_testbed_detach_ioctl(testbed_, node_.c_str(), nullptr);
  char* root = umockdev_testbed_get_root_dir(testbed_);
  ::unlink((root + node_).c_str());
  g_free(root);
  umockdev_testbed_remove_device(testbed_, sys_.c_str());
}

void PlayedUsb::fail(uint8_t endpoint, int status) {
  const std::lock_guard lock(mutex_);
  failing_ = endpoint;
  failing_status_ = status;
}
void PlayedUsb::takeCommandsAfter(int milliseconds) {
  const std::lock_guard lock(mutex_);
  slow_ = milliseconds;
}
void PlayedUsb::spoil(Fault fault) {
  const std::lock_guard lock(mutex_);
  arm_.arm().spoil(fault);
}
bool PlayedUsb::pushed() {
  const std::lock_guard lock(mutex_);
  return arm_.arm().pushed();
}
uint64_t PlayedUsb::commands() {
  const std::lock_guard lock(mutex_);
  return arm_.arm().commands();
}

void PlayedUsb::showDone() {
  if (terminal_.slave >= 0) tcflow(terminal_.slave, done_.empty() ? TCOOFF : TCOON);
}

void PlayedUsb::finish(usbdevfs_urb* urb, int status) {
  urb->status = status;
  done_.push_back(urb);
}

void PlayedUsb::submit(usbdevfs_urb* urb) {
  auto* bytes = static_cast<uint8_t*>(urb->buffer);
  urb->status = urb->actual_length = 0;
  if (urb->type == USBDEVFS_URB_TYPE_CONTROL) {
    Bytes data(bytes + 8, bytes + urb->buffer_length);
    const int result = arm_.control(bytes, data);
    std::copy_n(data.begin(), std::min<long>(std::max(result, 0), urb->buffer_length - 8), bytes + 8);
    urb->actual_length = std::max(result, 0);
    return finish(urb, std::min(result, 0));
  }
  if ((urb->endpoint & 0x80) != 0) return waiting_.push_back(urb);
  if (failing_status_ != 0 && failing_ == urb->endpoint) return finish(urb, failing_status_);
  if (slow_ > 0) return commands_.push_back({urb, slow_});
  take(urb);
}

/// A command reaches the arm.
void PlayedUsb::take(usbdevfs_urb* urb) {
  arm_.out({static_cast<const uint8_t*>(urb->buffer), static_cast<size_t>(urb->buffer_length)});
  urb->actual_length = urb->buffer_length;
  finish(urb, 0);
  showDone();
}

/// Reports into the transfers that wait for them.
void PlayedUsb::feed() {
  Bytes packet;
  while (!waiting_.empty()) {
    usbdevfs_urb* urb = waiting_.front();
    const bool fails = failing_status_ != 0 && failing_ == urb->endpoint;
    if (!fails && !arm_.in(packet)) break;
    waiting_.pop_front();
    if (!fails) {
      urb->actual_length = static_cast<int>(std::min(packet.size(), static_cast<size_t>(urb->buffer_length)));
      std::memcpy(urb->buffer, packet.data(), static_cast<size_t>(urb->actual_length));
    }
    finish(urb, fails ? failing_status_ : 0);
  }
  showDone();
}

bool PlayedUsb::discard(usbdevfs_urb* urb) {
  if (std::erase_if(commands_, [urb](const Command& command) { return command.urb == urb; }) > 0)
    return finish(urb, -ENOENT), showDone(), true;
  const auto at = std::find(waiting_.begin(), waiting_.end(), urb);
  if (at == waiting_.end()) return false;
  waiting_.erase(at);
  finish(urb, -ENOENT);
  showDone();
  return true;
}

bool PlayedUsb::answer(Client* client) {
  const auto request = static_cast<unsigned long>(umockdev_ioctl_client_get_request(client));
  UMockdevIoctlData* arg = umockdev_ioctl_client_get_arg(client);
  void* pointer = *reinterpret_cast<void**>(arg->data);
  const auto say = [&](long result, int error) { umockdev_ioctl_client_complete(client, result, error); };
  const bool reaps = request == USBDEVFS_REAPURB || request == USBDEVFS_REAPURBNDELAY;
  if (gone_ && !reaps && request != USBDEVFS_DISCARDURB) return say(-1, ENODEV), true;
  if (reaps) {
    if (done_.empty()) return say(-1, gone_ ? ENODEV : EAGAIN), true;
    *static_cast<void**>(pointer) = done_.front();
    done_.pop_front();
    showDone();
    return say(0, 0), true;
  }
  switch (request) {
    case USBDEVFS_GET_CAPABILITIES:
      *static_cast<uint32_t*>(pointer) = USBDEVFS_CAP_ZERO_PACKET | USBDEVFS_CAP_BULK_CONTINUATION |
                                         USBDEVFS_CAP_NO_PACKET_SIZE_LIM | USBDEVFS_CAP_REAP_AFTER_DISCONNECT;
      return say(0, 0), true;
    case USBDEVFS_GETDRIVER:  // no kernel driver is bound, none to be unbound
    case USBDEVFS_IOCTL:
      return say(-1, ENODATA), true;
    case USBDEVFS_DISCONNECT_CLAIM:
    case USBDEVFS_CLAIMINTERFACE:
      ++claimed_;
      return say(0, 0), true;
    case USBDEVFS_RELEASEINTERFACE:
    case USBDEVFS_CLEAR_HALT:
    case USBDEVFS_SETCONFIGURATION:
      return say(0, 0), true;
    case USBDEVFS_SUBMITURB:
      submit(static_cast<usbdevfs_urb*>(pointer));
      showDone();
      return say(0, 0), true;
    case USBDEVFS_DISCARDURB:
      return discard(static_cast<usbdevfs_urb*>(pointer)) ? say(0, 0) : say(-1, EINVAL), true;
    default:
      return false;
  }
}

gboolean PlayedUsb::onIoctl(UMockdevIoctlBase*, Client* client, gpointer pointer) {
  auto& self = *static_cast<PlayedUsb*>(pointer);
  const std::lock_guard lock(self.mutex_);
  return self.answer(client) ? TRUE : FALSE;
}

}  // namespace hapticd::emulator

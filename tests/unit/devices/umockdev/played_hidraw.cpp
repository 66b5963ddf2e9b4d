// SPDX-License-Identifier: MIT
#include "played_hidraw.hpp"

#include <fcntl.h>
#include <linux/hidraw.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <stdexcept>

namespace hapticd::emulator {
namespace {

std::string format(const char* pattern, int a, int b) {
  char text[128];
  std::snprintf(text, sizeof text, pattern, a, b);
  return text;
}

}  // namespace

PlayedHidraw::PlayedHidraw(UMockdevTestbed* testbed, int number, EmulatedArm& arm, std::string serial)
    : testbed_(testbed),
      handler_(umockdev_ioctl_base_new()),
      arm_(arm),
      node_("/dev/hidraw" + std::to_string(number)),
      serial_(std::move(serial)),
      number_(number) {
  std::signal(SIGHUP, SIG_IGN);  // a closing master must not end a session leader
  g_signal_connect(handler_, "handle-ioctl", G_CALLBACK(onIoctl), this);
  g_signal_connect(handler_, "handle-read", G_CALLBACK(onRead), this);
  g_signal_connect(handler_, "handle-write", G_CALLBACK(onWrite), this);
}

PlayedHidraw::~PlayedHidraw() {
  if (!gone_) unplug();
  g_object_unref(handler_);
}

void PlayedHidraw::add(const std::string& text) {
  GError* error = nullptr;
  if (!umockdev_testbed_add_from_string(testbed_, text.c_str(), &error)) throw std::runtime_error(error->message);
}

void PlayedHidraw::plug() {
  const std::lock_guard lock(mutex_);
  reports_.clear();
  ++plugged_;
  const About& about = arm_.about();
  usb_ = format("/devices/pci0000:00/usb2/2-%d", number_ + 1, 0);
  const std::string interface = usb_ + format("/2-%d:1.0", number_ + 1, 0);
  hid_name_ = "0003:" + format("%04X:%04X", about.vendor, about.product) + format(".%04X", 16 * number_ + plugged_, 0);
  const std::string hid = interface + "/" + hid_name_;
  umockdev_testbed_attach_ioctl(testbed_, node_.c_str(), handler_, nullptr);
  add("P: " + usb_ +
      "\nE: SUBSYSTEM=usb\nE: DEVTYPE=usb_device\nE: PRODUCT=" + format("%x/%x/100", about.vendor, about.product) +
      "\nA: idVendor=" + format("%04x", about.vendor, 0) + "\\n\nA: idProduct=" + format("%04x", about.product, 0) +
      "\\n\nA: bcdDevice=0100\\n\nA: manufacturer=hapticd\\n\n" + "A: product=" + about.name +
      "\\n\nA: serial=" + serial_ + "\\n\n\nP: " + interface +
      "\nE: SUBSYSTEM=usb\nE: DEVTYPE=usb_interface\nA: bInterfaceNumber=00\\n\n\nP: " + hid +
      "\nE: SUBSYSTEM=hid\nE: HID_ID=0003:" + format("%08X:%08X", about.vendor, about.product) + "\nE: HID_NAME=" +
      about.name + "\nE: HID_UNIQ=" + serial_ + "\nE: DRIVER=hid-generic\nH: report_descriptor=0600ff0901a101c0\n\n");
  add("P: " + hid + format("/hidraw/hidraw%d\nN: hidraw%d=00\n", number_, number_) +
      "E: SUBSYSTEM=hidraw\nE: DEVNAME=" + node_ +
      format("\nE: MAJOR=244\nE: MINOR=%d\nA: dev=244:%d\\n\n", number_, number_) + "L: device=../../../" + hid_name_ +
      "\n\n");
  terminal_.open(testbed_, node_);
  gone_ = false;
}

void PlayedHidraw::unplug() {
  {
    const std::lock_guard lock(mutex_);
    gone_ = true;
    terminal_.close();
  }
  const std::string usb = "/sys" + usb_, interface = usb + format("/2-%d:1.0", number_ + 1, 0);
  const std::string hid = interface + "/" + hid_name_, raw = hid + format("/hidraw/hidraw%d", number_, 0);
  umockdev_testbed_uevent(testbed_, raw.c_str(), "remove");
  umockdev_testbed_detach_ioctl(testbed_, node_.c_str(), nullptr);
  char* root = umockdev_testbed_get_root_dir(testbed_);
  ::unlink((root + node_).c_str());
  // umockdev 0.17 removes neither children nor the links of buses that it does not know
  for (const std::string& path : {raw, hid, interface, usb}) umockdev_testbed_remove_device(testbed_, path.c_str());
  const std::string sys = std::string(root) + "/sys";
  ::unlink((sys + "/bus/hid/devices/" + hid_name_).c_str());
  ::unlink((sys + format("/dev/char/244:%d", number_, 0)).c_str());
  g_free(root);
}

void PlayedHidraw::showWaiting() {
  if (terminal_.slave < 0) return;
  int waiting = 0;
  ioctl(terminal_.slave, FIONREAD, &waiting);
  if (reports_.empty() && waiting > 0) tcflush(terminal_.slave, TCIFLUSH);
  if (!reports_.empty() && waiting == 0 && ::write(terminal_.master, "x", 1) != 1) std::perror("pseudo-terminal");
}

gboolean PlayedHidraw::onRead(UMockdevIoctlBase*, Client* client, gpointer pointer) {
  auto& self = *static_cast<PlayedHidraw*>(pointer);
  const std::lock_guard lock(self.mutex_);
  UMockdevIoctlData* arg = umockdev_ioctl_client_get_arg(client);
  if (self.gone_ || self.reports_.empty()) {
    umockdev_ioctl_client_complete(client, -1, self.gone_ ? EIO : EAGAIN);
    return TRUE;
  }
  const std::vector<uint8_t> report = self.reports_.front();
  self.reports_.pop_front();
  self.showWaiting();
  const size_t size = std::min(report.size(), static_cast<size_t>(arg->data_len));
  std::memcpy(arg->data, report.data(), size);
  umockdev_ioctl_client_complete(client, static_cast<glong>(size), 0);
  return TRUE;
}

gboolean PlayedHidraw::onWrite(UMockdevIoctlBase*, Client* client, gpointer pointer) {
  auto& self = *static_cast<PlayedHidraw*>(pointer);
  const std::lock_guard lock(self.mutex_);
  UMockdevIoctlData* arg = umockdev_ioctl_client_get_arg(client);
  if (self.gone_) {
    umockdev_ioctl_client_complete(client, -1, ENODEV);
    return TRUE;
  }
  const auto size = static_cast<size_t>(arg->data_len);
  if (size > 0) self.arm_.command({arg->data + 1, size - 1});  // byte 0: report id
  self.arm_.advance(0.001);
  self.pushed = self.arm_.pushed();
  if (std::vector<uint8_t> report = self.arm_.report(); !report.empty()) self.reports_.push_back(std::move(report));
  self.showWaiting();
  umockdev_ioctl_client_complete(client, arg->data_len, 0);
  return TRUE;
}

gboolean PlayedHidraw::onIoctl(UMockdevIoctlBase*, Client* client, gpointer pointer) {
  auto& self = *static_cast<PlayedHidraw*>(pointer);
  const std::lock_guard lock(self.mutex_);
  const auto request = static_cast<unsigned long>(umockdev_ioctl_client_get_request(client));
  if (_IOC_TYPE(request) != 'H' || _IOC_NR(request) != 0x01) return FALSE;
  UMockdevIoctlData* arg = umockdev_ioctl_client_get_arg(client);
  UMockdevIoctlData* data = umockdev_ioctl_data_resolve(arg, 0, sizeof(int), nullptr);
  const int bytes = 8;  // of the report descriptor: hidapi opens a node only if it has one
  std::memcpy(data->data, &bytes, sizeof bytes);
  g_object_unref(data);
  umockdev_ioctl_client_complete(client, 0, 0);
  return TRUE;
}

}  // namespace hapticd::emulator

// SPDX-License-Identifier: MIT
/// An emulated arm through /dev/uhid: hid core, hidraw and udev are the kernel's own, only the hardware is not there.
/// Usage: uhid_arm KIND ...: see options.hpp
#include <fcntl.h>
#include <linux/uhid.h>
#include <poll.h>
#include <sched.h>
#include <sys/timerfd.h>
#include <unistd.h>

#include <cstring>

#include "emulators/options.hpp"
#include "emulators/usb_arm.hpp"

namespace hapticd::emulator {
namespace {

bool tell(int fd, const uhid_event& event) {
  return write(fd, &event, sizeof event) == static_cast<ssize_t>(sizeof event);
}

bool create(int fd, const About& about, const std::string& serial) {
  uhid_event event{};
  event.type = UHID_CREATE2;
  auto& c = event.u.create2;
  std::snprintf(reinterpret_cast<char*>(c.name), sizeof c.name, "%s", about.name);
  std::snprintf(reinterpret_cast<char*>(c.uniq), sizeof c.uniq, "%s", serial.c_str());
  const Bytes bytes = hidDescriptor(about);
  c.rd_size = static_cast<uint16_t>(bytes.size());
  std::memcpy(c.rd_data, bytes.data(), bytes.size());
  c.bus = 3;  // BUS_USB
  c.vendor = about.vendor, c.product = about.product;
  return tell(fd, event);
}

void send(int fd, UsbArm& arm) {
  for (Bytes report; arm.in(report);) {
    uhid_event event{};
    event.type = UHID_INPUT2;
    event.u.input2.size = static_cast<uint16_t>(report.size());
    std::memcpy(event.u.input2.data, report.data(), report.size());
    tell(fd, event);
  }
}

/// One plugging-in.
void serve(int fd, UsbArm& arm, bool hold) {
  const int timer = timerfd_create(CLOCK_MONOTONIC, TFD_CLOEXEC);
  const itimerspec period{{0, 1'000'000}, {0, 1'000'000}};
  timerfd_settime(timer, 0, &period, nullptr);
  while (g_unplug == 0) {
    pollfd on[2] = {{fd, POLLIN, 0}, {timer, POLLIN, 0}};
    if (poll(on, 2, 1000) < 0) continue;
    uint64_t ticks = 0;
    if ((on[1].revents & POLLIN) != 0 && read(timer, &ticks, sizeof ticks) == static_cast<ssize_t>(sizeof ticks)) {
      arm.arm().holdStill(hold && g_begin == 0);
      arm.advance(static_cast<double>(ticks) * 1e-3);
    }
    uhid_event event{};
    if ((on[0].revents & POLLIN) != 0 && read(fd, &event, sizeof event) > 0 && event.type == UHID_OUTPUT &&
        event.u.output.size > 0)
      arm.out({event.u.output.data + 1, event.u.output.size - 1u});  // byte 0: report id
    send(fd, arm);
  }
  close(timer);
}

}  // namespace
}  // namespace hapticd::emulator

int main(int argc, char** argv) {
  using namespace hapticd::emulator;
  const Options options = readOptions(argc, argv);
  const sched_param hardware{90};  // hardware waits for no program
  (void)sched_setscheduler(0, SCHED_FIFO, &hardware);
  const int fd = open("/dev/uhid", O_RDWR | O_CLOEXEC);
  if (fd < 0) return std::perror("/dev/uhid"), 1;
  do {
    UsbArm arm(options.kind, options.hand, options.serial);
    if (!create(fd, arm.about(), options.serial)) return std::perror("UHID_CREATE2"), 1;
    g_unplug = 0;
    if (options.latency) arm.arm().measureLatency();
    tellTip(arm.arm());
    serve(fd, arm, options.hold);
    uhid_event event{};
    event.type = UHID_DESTROY;
    tell(fd, event);
    std::printf("%llu commands\n", static_cast<unsigned long long>(arm.arm().commands()));
    arm.arm().meter().tell();
    std::fflush(stdout);
    if (options.replug_after >= 0 && g_end == 0) usleep(static_cast<useconds_t>(options.replug_after * 1e6));
  } while (options.replug_after >= 0 && g_end == 0);
}

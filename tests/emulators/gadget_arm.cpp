// SPDX-License-Identifier: MIT
/// An emulated arm on the device side of this machine's own kernel: the reports of a HID gadget that somebody bound to
/// a controller such as dummy_hcd. Usage: gadget_arm KIND ...: see options.hpp; the node is /dev/hidg0
#include <fcntl.h>
#include <poll.h>
#include <sched.h>
#include <sys/timerfd.h>
#include <unistd.h>

#include <array>

#include "emulators/options.hpp"
#include "emulators/usb_arm.hpp"

namespace hapticd::emulator {
namespace {

void serve(int fd, UsbArm& arm) {
  const int timer = timerfd_create(CLOCK_MONOTONIC, TFD_CLOEXEC);
  const itimerspec period{{0, 1'000'000}, {0, 1'000'000}};
  timerfd_settime(timer, 0, &period, nullptr);
  std::array<uint8_t, 64> command;
  while (g_unplug == 0) {
    pollfd on[2] = {{timer, POLLIN, 0}, {fd, POLLIN, 0}};
    if (poll(on, 2, 1000) < 0) continue;
    uint64_t ticks = 0;
    if (read(fd, command.data(), arm.about().output_bytes) == static_cast<ssize_t>(arm.about().output_bytes))
      arm.out({command.data(), arm.about().output_bytes});
    if ((on[0].revents & POLLIN) == 0 || read(timer, &ticks, sizeof ticks) != static_cast<ssize_t>(sizeof ticks))
      continue;
    arm.advance(1e-3 * static_cast<double>(ticks));
    // Refused while the last report waits for the host, which then gets a newer one, or while nobody is there.
    for (Bytes report; arm.in(report);)
      if (write(fd, report.data(), report.size()) < 0) break;
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
  const int fd = open("/dev/hidg0", O_RDWR | O_NONBLOCK | O_CLOEXEC);
  if (fd < 0) return std::perror("/dev/hidg0"), 1;
  UsbArm arm(options.kind, options.hand, options.serial);
  tellTip(arm.arm());
  serve(fd, arm);
}

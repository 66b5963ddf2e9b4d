/// An emulated arm through /dev/uhid: hid core, hidraw and udev are the kernel's own, only the hardware is not there.
/// Usage: uhid_arm premium15|woodenhaptics [--serial S] [--seconds N] [--unplug-after MS] [--replug-after MS]
/// SIGUSR1 plugs it out and, after the time of --replug-after, in again.
#include <fcntl.h>
#include <linux/uhid.h>
#include <poll.h>
#include <sys/timerfd.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>

#include "emulators/emulated_arm.hpp"

namespace {

using hapticd::emulator::EmulatedArm;

volatile std::sig_atomic_t g_unplug = 0;

/// Vendor page, unnumbered: one input and one output report of so many bytes.
std::vector<uint8_t> descriptor(size_t input, size_t output) {
  return {0x06, 0x00,
          0xff, 0x09,
          0x01, 0xa1,
          0x01, 0x15,
          0x00, 0x26,
          0xff, 0x00,
          0x75, 0x08,
          0x95, static_cast<uint8_t>(input),
          0x09, 0x01,
          0x81, 0x02,
          0x95, static_cast<uint8_t>(output),
          0x09, 0x02,
          0x91, 0x02,
          0xc0};
}

bool tell(int fd, const uhid_event& event) {
  return write(fd, &event, sizeof event) == static_cast<ssize_t>(sizeof event);
}

bool create(int fd, const EmulatedArm& arm, const std::string& serial) {
  uhid_event event{};
  event.type = UHID_CREATE2;
  auto& c = event.u.create2;
  std::snprintf(reinterpret_cast<char*>(c.name), sizeof c.name, "%s", arm.about().name);
  std::snprintf(reinterpret_cast<char*>(c.uniq), sizeof c.uniq, "%s", serial.c_str());
  const auto bytes = descriptor(arm.about().input_bytes, arm.about().output_bytes);
  c.rd_size = static_cast<uint16_t>(bytes.size());
  std::memcpy(c.rd_data, bytes.data(), bytes.size());
  c.bus = 3;  // BUS_USB
  c.vendor = arm.about().vendor, c.product = arm.about().product;
  return tell(fd, event);
}

void send(int fd, EmulatedArm& arm) {
  const auto bytes = arm.report();
  if (bytes.empty()) return;
  uhid_event event{};
  event.type = UHID_INPUT2;
  event.u.input2.size = static_cast<uint16_t>(bytes.size());
  std::memcpy(event.u.input2.data, bytes.data(), bytes.size());
  tell(fd, event);
}

/// Runs one plugging-in. @return false: the program shall end
bool serve(int fd, EmulatedArm& arm, const std::map<std::string, std::string>& options) {
  const auto number = [&](const char* name) {
    return options.count(name) != 0 ? std::atof(options.at(name).c_str()) : -1;
  };
  const int timer = timerfd_create(CLOCK_MONOTONIC, TFD_CLOEXEC);
  const itimerspec period{{0, 1'000'000}, {0, 1'000'000}};
  timerfd_settime(timer, 0, &period, nullptr);
  const double seconds = number("--seconds"), unplug = number("--unplug-after") / 1000;
  double time = 0;
  while (g_unplug == 0 && (seconds < 0 || time < seconds) && (unplug < 0 || time < unplug)) {
    pollfd on[2] = {{fd, POLLIN, 0}, {timer, POLLIN, 0}};
    if (poll(on, 2, 1000) < 0) continue;
    if ((on[1].revents & POLLIN) != 0) {
      uint64_t ticks = 0;
      if (read(timer, &ticks, sizeof ticks) == static_cast<ssize_t>(sizeof ticks)) {
        arm.advance(static_cast<double>(ticks) * 1e-3);
        time += static_cast<double>(ticks) * 1e-3;
        if (arm.about().streams) send(fd, arm);
      }
    }
    uhid_event event{};
    if ((on[0].revents & POLLIN) == 0 || read(fd, &event, sizeof event) < 0) continue;
    if (event.type != UHID_OUTPUT || event.u.output.size < 1) continue;
    arm.command({event.u.output.data + 1, event.u.output.size - 1u});  // byte 0: report id
    if (!arm.about().streams) send(fd, arm);
  }
  close(timer);
  return seconds < 0 || time < seconds;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) return std::fprintf(stderr, "usage: uhid_arm premium15|woodenhaptics [--serial S] ...\n"), 2;
  std::map<std::string, std::string> options;
  for (int i = 2; i + 1 < argc; i += 2) options[argv[i]] = argv[i + 1];
  std::signal(SIGUSR1, [](int) { g_unplug = 1; });
  const int fd = open("/dev/uhid", O_RDWR | O_CLOEXEC);
  if (fd < 0) return std::perror("/dev/uhid"), 1;
  const int replug = options.count("--replug-after") != 0 ? std::atoi(options["--replug-after"].c_str()) : -1;
  bool goes_on = true;
  do {
    EmulatedArm arm(argv[1], hapticd::emulator::defaultHand(argv[1]));
    if (!create(fd, arm, options.count("--serial") != 0 ? options["--serial"] : "0001"))
      return std::perror("UHID_CREATE2"), 1;
    g_unplug = 0;
    goes_on = serve(fd, arm, options);
    options.erase("--unplug-after");
    uhid_event event{};
    event.type = UHID_DESTROY;
    tell(fd, event);
    std::printf("%llu commands\n", static_cast<unsigned long long>(arm.commands()));
    if (replug >= 0) usleep(static_cast<useconds_t>(replug) * 1000);
  } while (goes_on && replug >= 0);
  return 0;
}

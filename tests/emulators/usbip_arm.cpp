// SPDX-License-Identifier: MIT
/// Plugs an emulated arm into this machine's kernel over USB/IP: the virtual host controller vhci_hcd gets one end of a
/// socket pair, so nothing listens on a network. USB core, usbfs, usbhid and hidraw above it are the kernel's own.
/// Root. Usage: usbip_arm KIND ...: see options.hpp
#include <endian.h>
#include <fcntl.h>
#include <poll.h>
#include <sched.h>
#include <sys/socket.h>
#include <sys/timerfd.h>
#include <unistd.h>

#include <cstring>
#include <stdexcept>
#include <utility>

#include "emulators/fault_orders.hpp"
#include "emulators/options.hpp"
#include "emulators/usb_arm.hpp"

namespace hapticd::emulator {
namespace {

constexpr const char* kHost = "/sys/devices/platform/vhci_hcd.0/";
enum : uint32_t { kSubmit = 1, kUnlink = 2, kSubmitted = 3, kUnlinked = 4 };

struct Submit {
  uint32_t flags, length, start_frame, packets, interval;
  uint8_t setup[8];
};
struct Answer {
  uint32_t status, actual, start_frame, packets, errors;
  uint8_t padding[8];
};
/// What precedes every message, big endian (Documentation/usb/usbip_protocol.rst).
struct Header {
  uint32_t command, number, device, direction, endpoint;
  union {
    Submit submit;
    Answer answer;
    uint32_t victim;
  };
};
static_assert(sizeof(Header) == 48);

bool readAll(int fd, void* to, size_t size) {
  for (auto* at = static_cast<uint8_t*>(to); size > 0;) {
    const ssize_t got = read(fd, at, size);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    at += got, size -= static_cast<size_t>(got);
  }
  return true;
}

/// One plugging-in.
class Plug {
 public:
  Plug(int fd, UsbArm& arm, const Options& options)
      : fd_(fd), arm_(arm), hold_(options.hold), orders_(options.faults) {}

  /// Until the host goes away or the arm is unplugged.
  void serve() {
    const int timer = timerfd_create(CLOCK_MONOTONIC, TFD_CLOEXEC);
    const itimerspec period{{0, 1'000'000}, {0, 1'000'000}};
    timerfd_settime(timer, 0, &period, nullptr);
    bool there = true;
    while (there && g_unplug == 0) {
      pollfd on[2] = {{fd_, POLLIN, 0}, {timer, POLLIN, 0}};
      if (poll(on, 2, 1000) < 0) continue;
      uint64_t ticks = 0;
      if ((on[1].revents & POLLIN) != 0 && read(timer, &ticks, sizeof ticks) == static_cast<ssize_t>(sizeof ticks)) {
        arm_.arm().holdStill(hold_ && g_begin == 0);
        arm_.advance(1e-3 * static_cast<double>(ticks));
        orders_.follow(arm_, 1e-3 * static_cast<double>(ticks), std::exchange(g_order, 0) != 0);
        there = feed();
      }
      if ((on[0].revents & (POLLIN | POLLHUP)) != 0) there = take() && feed();
    }
    close(timer);
  }

 private:
  struct Waiting {
    uint32_t number, length;
  };

  bool take() {
    Header h;
    if (!readAll(fd_, &h, sizeof h)) return false;
    if (be32toh(h.command) == kUnlink) return unlink(h);
    if (be32toh(h.command) != kSubmit) return false;
    const uint32_t length = be32toh(h.submit.length), number = be32toh(h.number);
    const bool in = be32toh(h.direction) == 1;
    Bytes data(in ? 0 : length);
    if (!data.empty() && !readAll(fd_, data.data(), data.size())) return false;
    if (h.endpoint == 0) {
      const int result = arm_.control(h.submit.setup, data);
      return answer(number, std::min(result, 0), in && result > 0 ? data : Bytes(), in ? 0 : length);
    }
    if (in) return waiting_.push_back({number, length}), true;
    arm_.out(data);
    return answer(number, 0, {}, length);
  }

  bool unlink(const Header& h) {
    const uint32_t victim = be32toh(h.victim);
    int32_t status = 0;
    for (auto it = waiting_.begin(); it != waiting_.end(); ++it)
      if (it->number == victim) {
        waiting_.erase(it);
        status = -ECONNRESET;
        break;
      }
    Header out{};
    out.command = htobe32(kUnlinked);
    out.number = h.number;
    out.answer.status = htobe32(static_cast<uint32_t>(status));
    return send(fd_, &out, sizeof out, MSG_NOSIGNAL) == static_cast<ssize_t>(sizeof out);
  }

  bool feed() {
    Bytes packet;
    while (!waiting_.empty() && (arm_.halted() || arm_.in(packet))) {
      const Waiting next = waiting_.front();
      waiting_.pop_front();
      if (packet.size() > next.length) packet.resize(next.length);
      if (!answer(next.number, arm_.halted() ? -EPIPE : 0, arm_.halted() ? Bytes() : packet, 0)) return false;
    }
    return true;
  }

  bool answer(uint32_t number, int status, const Bytes& data, uint32_t taken) {
    Header h{};
    h.command = htobe32(kSubmitted);
    h.number = htobe32(number);
    h.answer.status = htobe32(static_cast<uint32_t>(status));
    h.answer.actual = htobe32(data.empty() ? taken : static_cast<uint32_t>(data.size()));
    Bytes message(sizeof h + data.size());
    std::memcpy(message.data(), &h, sizeof h);
    std::copy(data.begin(), data.end(), message.begin() + sizeof h);
    return send(fd_, message.data(), message.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(message.size());
  }

  int fd_;
  UsbArm& arm_;
  std::deque<Waiting> waiting_;
  bool hold_;
  FaultOrders orders_;
};

int freePort() {
  std::FILE* status = std::fopen((std::string(kHost) + "status").c_str(), "r");
  if (status == nullptr) throw std::runtime_error("no vhci_hcd in this kernel; fix: modprobe vhci-hcd");
  char line[256], hub[8];
  int port = 0, state = 0, found = -1;
  constexpr int kFree = 4;
  while (found < 0 && std::fgets(line, sizeof line, status) != nullptr)
    if (std::sscanf(line, "%7s %d %d", hub, &port, &state) == 3 && hub[0] == 'h' && state == kFree) found = port;
  std::fclose(status);
  if (found < 0) throw std::runtime_error("every port of vhci_hcd is taken");
  return found;
}

int plugIn() {
  int ends[2];
  constexpr int kFullSpeed = 2;
  if (socketpair(AF_UNIX, SOCK_STREAM, 0, ends) != 0) throw std::runtime_error("no socket pair");
  const int port = freePort();
  const int attach = open((std::string(kHost) + "attach").c_str(), O_WRONLY | O_CLOEXEC);
  const int written = dprintf(attach, "%d %d %d %d", port, ends[1], 0x10000 + port + 1, kFullSpeed);
  if (attach < 0 || written <= 0) throw std::runtime_error("vhci_hcd takes no device; are you root?");
  close(attach);
  close(ends[1]);  // the kernel has its own
  return ends[0];
}

void run(const Options& options) {
  do {
    UsbArm arm(options.kind, options.hand, options.serial);
    if (arm.about().bus == Bus::kFtdi) arm.chip().beDifficult(2, 1);
    const int fd = plugIn();
    g_unplug = 0;
    tellTip(arm.arm());
    if (options.latency) arm.arm().measureLatency();
    Plug(fd, arm, options).serve();
    close(fd);
    std::printf("%llu commands, motors %s\n", static_cast<unsigned long long>(arm.arm().commands()),
                arm.arm().pushed() ? "on" : "off");
    arm.arm().meter().tell();
    std::fflush(stdout);
    if (options.replug_after >= 0 && g_end == 0) usleep(static_cast<useconds_t>(options.replug_after * 1e6));
  } while (options.replug_after >= 0 && g_end == 0);
}

}  // namespace
}  // namespace hapticd::emulator

int main(int argc, char** argv) {
  using namespace hapticd::emulator;
  try {
    const Options options = readOptions(argc, argv);
    const sched_param hardware{90};  // hardware waits for no program
    (void)sched_setscheduler(0, SCHED_FIFO, &hardware);
    run(options);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "%s: %s\n", argv[0], e.what());
    return 1;
  }
}

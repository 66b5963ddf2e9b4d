// SPDX-License-Identifier: MIT
/// The test arm `rig`. It has three sliding joints, so the torques of its joints are the force at the tip. The host
/// treats it as real hardware. It has no watchdog, so its motors hold the last command for ever. It logs every command,
/// cut and stop with its time (rig_page.hpp), and simulates the faults that a test asks for.
#include <fcntl.h>
#include <sys/mman.h>
#include <time.h>
#include <unistd.h>

#include <cstring>
#include <new>
#include <stdexcept>
#include <thread>

#include "hapticd/device.hpp"
#include "hapticd/device_pace.h"
#include "hapticd/device_silence.h"
#include "rig_page.hpp"

namespace hapticd::rig {
namespace {

uint64_t monotonic() noexcept HSP_RT {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return static_cast<uint64_t>(now.tv_sec) * 1'000'000'000u + static_cast<uint64_t>(now.tv_nsec);
}

struct Rig : Device {
  std::string file;
  std::array<double, 3> at{}, weight{};
  double max_force, rate;
  bool simulated, cuts, paces, lazy, guarded;

  static constexpr DeviceInfo kInfo{"org.hapticd.test.rig", "rig", "1.0.0", "MIT", "A test arm that logs."};
  static constexpr auto fields() {
    using F = Fields<Rig>;
    return std::array{
        F::text("page", &Rig::file, "", "File of the shared page; none: memory of the process."),
        F::vector3("position", &Rig::at, "m", -10, 10, "[0, -0.002, 0]", "Where the tip is, until the test moves it."),
        F::vector3("weight", &Rig::weight, "N", -1e300, 1e300, "[0, 0, 0]", "Of the arm, as its kinematics say it."),
        F::real("max_force", &Rig::max_force, "N", 0, 1000, 8.5, "Of the device."),
        F::real("rate", &Rig::rate, "Hz", 1, 1e5, 1000, "Of the samples, where they pace the loop."),
        F::boolean("simulated", &Rig::simulated, false, "It says that no hand can be hurt."),
        F::boolean("cuts", &Rig::cuts, true, "It has the extension hdv.cut."),
        F::boolean("guarded", &Rig::guarded, true, "Another process can switch it off, where it has a page file."),
        F::boolean("lazy", &Rig::lazy, false, "A thread of its own carries a cut to the motors, 5 ms later."),
        F::boolean("paces", &Rig::paces, false, "It has the extension hdv.pace.")};
  }

  ~Rig() { release(); }

  void open(hdv_info& info) {
    map();
    info.joint_count = 3;
    info.rate_hz = rate;
    info.max_force = max_force;
    info.buttons = 32;
    for (int i = 0; i < 3; ++i) info.position_min[i] = -10, info.position_max[i] = 10;
    info.capabilities = simulated ? static_cast<uint32_t>(HDV_C_SIMULATED) : 0u;
    if (paces) info.capabilities |= HDV_C_PACING;
    note(kOpened, 0, nullptr);
  }
  void start(const hdv_start&) {
    note(kStarted, 0, nullptr);
    running_.store(true);
    if (lazy) carrier_ = std::thread([this] { carryCuts(); });
  }

  hsp_status read(uint64_t now_ns, hdv_sample& sample) noexcept HSP_RT {
    hang(kHangInRead);
    const Wishes& wishes = page_->wishes;
    const uint32_t faults = wishes.faults.load();
    page_->reads.fetch_add(1);
    if ((faults & kLost) != 0) return HSP_E_IO;
    if ((faults & kSilent) == 0) {
      ++sample.sequence;
      sample.time_ns = wishes.stamp_ns != 0 ? wishes.stamp_ns : now_ns;
      std::memcpy(sample.position, wishes.position, sizeof wishes.position);
    }
    sample.flags = ((faults & kUncalibrated) == 0 ? static_cast<uint32_t>(HDV_S_CALIBRATED) : 0u) |
                   ((faults & kHardwareFault) != 0 ? static_cast<uint32_t>(HDV_S_FAULT) : 0u);
    sample.buttons = wishes.buttons;
    return HSP_OK;
  }

  hsp_status write(uint64_t now_ns, const hdv_command& command) noexcept HSP_RT {
    if ((page_->wishes.faults.load() & kWriteFails) != 0) return HSP_E_IO;
    if (command.mode == HDV_OFF) cut_.store(false);
    const bool on = command.mode == HDV_TORQUE && (!cut_.load() || lazy);
    note(kCommand, now_ns, on ? command.torque : nullptr);
    hang(kHangInWrite);
    return HSP_OK;
  }

  void stop() {
    running_.store(false);
    if (carrier_.joinable()) carrier_.join();
    note(kStopped, 0, nullptr);
  }
  void close() { note(kClosed, 0, nullptr); }

  const void* extension(const char* name) {
    if (std::strcmp(name, HDV_EXT_KINEMATICS) == 0) return &kKinematics;
    if (std::strcmp(name, HDV_EXT_CUT) == 0) return cuts ? &kCutting : nullptr;
    if (std::strcmp(name, HDV_EXT_PACE) == 0) return paces ? &kPacing : nullptr;
    if (std::strcmp(name, HDV_EXT_SILENCE) == 0) return &kSilence;
    return std::strcmp(name, kPageExtension) == 0 ? page_ : nullptr;
  }

 private:
  static Rig& of(hdv_device* device) { return *reinterpret_cast<Rig*>(device); }
  static const Rig& of(const hdv_device* device) { return *reinterpret_cast<const Rig*>(device); }

  void map() {
    release();
    void* memory = MAP_FAILED;
    if (file.empty()) {
      memory = mmap(nullptr, sizeof(Page), PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    } else {
      const int descriptor = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
      if (descriptor >= 0 && ftruncate(descriptor, sizeof(Page)) == 0)
        memory = mmap(nullptr, sizeof(Page), PROT_READ | PROT_WRITE, MAP_SHARED, descriptor, 0);
      descriptor_ = descriptor;
    }
    if (memory == MAP_FAILED) throw std::runtime_error("the page of the rig cannot be mapped");
    page_ = static_cast<Page*>(memory);
    if (page_->magic == Page::kMagic) return;  // an arm was opened with this page before, and its log is continued
    page_ = new (memory) Page;
    std::memcpy(page_->wishes.position, at.data(), sizeof page_->wishes.position);
    std::memcpy(page_->wishes.weight, weight.data(), sizeof page_->wishes.weight);
  }
  void release() {
    if (page_ != nullptr) munmap(page_, sizeof(Page));
    if (descriptor_ >= 0) ::close(descriptor_);
    page_ = nullptr;
    descriptor_ = -1;
  }

  /// Adds an entry to the log. @param torque [N] torques of the motors from now on; nullptr if the motors are free
  void note(uint32_t kind, uint64_t given_ns, const double* torque) noexcept HSP_RT {
    Entry& entry = page_->entries[page_->count.load() % Page::kCapacity];
    entry.time_ns = monotonic();
    entry.given_ns = given_ns;
    entry.kind = kind;
    entry.on = torque != nullptr && (torque[0] != 0 || torque[1] != 0 || torque[2] != 0) ? 1 : 0;
    for (int i = 0; i < 3; ++i) entry.torque[i] = page_->motors.torque[i] = torque != nullptr ? torque[i] : 0;
    page_->motors.on.store(entry.on);
    page_->count.fetch_add(1);
  }
  void hang(uint32_t where) noexcept {
    while ((page_->wishes.faults.load() & where) != 0) usleep(200);
  }

  static void cut(hdv_device* device) noexcept HSP_RT {
    of(device).cut_.store(true);
    if (!of(device).lazy) of(device).note(kCut, 0, nullptr);
  }
  static int32_t cutLeft(const hdv_device* device) noexcept HSP_RT {
    return !of(device).lazy || of(device).carried_.load() ? 1 : 0;
  }
  /// Tells the host how another process can silence the arm: by zeros written over `Page::motors`.
  static int32_t how(hdv_device* device, hdv_silence* to) {
    Rig& rig = of(device);
    if (rig.descriptor_ < 0 || !rig.guarded) return 0;
    to->kind = HDV_BY_PWRITE;
    to->fd = rig.descriptor_;
    to->offset = offsetof(Page, motors);
    to->size = sizeof(Motors);
    to->epoch = 1;
    return 1;
  }
  void carryCuts() noexcept {
    while (running_.load() && !cut_.load()) usleep(200);
    usleep(5000);
    if (cut_.load()) note(kCut, 0, nullptr);
    carried_.store(true);
  }
  static uint64_t wait(hdv_device* device, uint64_t until_ns) noexcept {
    Rig& rig = of(device);
    rig.hang(kHangInWait);
    const auto period = static_cast<uint64_t>(1e9 / rig.rate);
    rig.next_ns_ = std::max(rig.next_ns_ + period, monotonic());
    const uint64_t next = std::min(rig.next_ns_, until_ns);
    timespec at{static_cast<time_t>(next / 1'000'000'000u), static_cast<long>(next % 1'000'000'000u)};
    while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &at, nullptr) != 0) {
    }
    return next;
  }

  static hsp_status forward(const hdv_device* device, const double* q, double position[3],
                            double orientation[4]) noexcept HSP_RT {
    for (int i = 0; i < 3; ++i) position[i] = q[i];
    const double none[4] = {1, 0, 0, 0};
    std::memcpy(orientation, of(device).page_ != nullptr ? of(device).page_->wishes.orientation : none, sizeof none);
    return HSP_OK;
  }
  static hsp_status jacobian(const hdv_device*, const double*, double* J) noexcept HSP_RT {
    for (int i = 0; i < 18; ++i) J[i] = i % 4 == 0 && i < 9 ? 1 : 0;
    return HSP_OK;
  }
  static hsp_status gravity(const hdv_device* device, const double*, const double*, double* torque) noexcept HSP_RT {
    for (int i = 0; i < 3; ++i) torque[i] = of(device).page_ != nullptr ? of(device).page_->wishes.weight[i] : 0;
    return HSP_OK;
  }
  static hsp_status inverse(const hdv_device*, const double position[3], double* q) noexcept HSP_RT {
    for (int i = 0; i < 3; ++i) q[i] = position[i];
    return HSP_OK;
  }
  static constexpr hdv_ext_kinematics kKinematics{
      sizeof(hdv_ext_kinematics), 3, &forward, &jacobian, &gravity, &inverse};
  static constexpr hdv_ext_cut kCutting{sizeof(hdv_ext_cut), 0, &cut};
  static constexpr hdv_ext_silence kSilence{sizeof(hdv_ext_silence), 0, &cutLeft, &how};
  static constexpr hdv_ext_pace kPacing{sizeof(hdv_ext_pace), 0, &wait};

  Page* page_ = nullptr;
  int descriptor_ = -1;           ///< descriptor of the page file
  std::atomic<bool> cut_{false};  ///< set by a cut, and cleared by a command HDV_OFF
  std::atomic<bool> running_{false}, carried_{false};
  std::thread carrier_;
  uint64_t next_ns_ = 0;
};

}  // namespace
}  // namespace hapticd::rig

HAPTICD_DEVICES(hapticd::rig::Rig)

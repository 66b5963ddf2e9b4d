// SPDX-License-Identifier: MIT
/// `hapticd device calibrate`: lets an arm find its zero, with the user's help. The arm gets no force meanwhile.
#include <unistd.h>

#include <memory>
#include <optional>
#include <string>

#include "base/clock.hpp"
#include "base/shell_word.hpp"
#include "cli/device/file.hpp"
#include "cli/support/command.hpp"
#include "host/device_instance.hpp"

namespace hapticd::cli {
namespace {

struct CalibrationArguments {
  std::string file;
  bool yes = false;
};

/// Waits until the user presses Enter, if standard input is a terminal.
void waitForUser(const char* instructions, bool yes) {
  std::printf("%s\n", instructions);
  if (yes || isatty(STDIN_FILENO) == 0) return;
  std::printf("Press Enter when you are ready. ");
  std::fflush(stdout);
  for (int c = std::getchar(); c != '\n' && c != EOF; c = std::getchar()) {
  }
}

/// Warns of joints beyond their stops, where no joint can be: forces would have wrong directions there.
void warnOfStops(host::DeviceInstance& device, const hdv_sample& sample) {
  constexpr double kSlack = 0.05;  // [rad, m]
  const hdv_info& info = device.info();
  for (uint32_t i = 0; i < info.joint_count; ++i) {
    const double at = sample.position[i], least = info.position_min[i], most = info.position_max[i];
    if (least == most || (at >= least - kSlack && at <= most + kSlack)) continue;  // equal: its module names none
    std::fprintf(stderr,
                 "warning: joint %u is at %.4f, beyond its stops at %.4f and %.4f\n"
                 "  fix: correct the pose of the calibration, the scale of its position, or arm.limits\n",
                 i + 1, at, least, most);
  }
}

void printWhere(host::DeviceInstance& device) {
  hdv_sample sample{};
  std::array<double, 3> tip{};
  std::array<double, 4> orientation{};
  if (device.read(monotonicNow(), sample) < 0) return;
  std::printf("calibrated; joints");
  for (uint32_t i = 0; i < device.info().joint_count; ++i) std::printf(" %.4f", sample.position[i]);
  if (device.kinematics().forward(device.handle(), sample.position, tip.data(), orientation.data()) >= 0)
    std::printf(", tip at (%.4f, %.4f, %.4f) m in the device frame", tip[0], tip[1], tip[2]);
  std::printf("\n");
  warnOfStops(device, sample);
}

int calibrateDevice(const CalibrationArguments& options) {
  const auto loaded = loadDeviceOrReport(options.file);
  if (!loaded) return kBadInput;
  std::optional<SetupErrors> once(std::in_place);
  auto device = host::DeviceInstance::create(*loaded, logToTerminal);
  if (!device) return fail(kFailed, device.error());
  const hdv_ext_calibration* calibration = (*device)->calibration();
  if (calibration == nullptr) {
    std::printf("%s needs no calibration: its positions are absolute\n", loaded->name.c_str());
    return kWorked;
  }
  if (auto opened = (*device)->open(); !opened) return fail(kFailed, opened.error());
  once.reset();  // from now on each message is printed when it comes
  hdv_start how{};
  how.struct_size = sizeof how;
  how.rate_hz = (*device)->info().rate_hz;
  how.time_ns = monotonicNow();
  if (auto started = (*device)->start(how); !started) return fail(kFailed, started.error());
  waitForUser(calibration->instructions, options.yes);
  if (calibration->calibrate((*device)->handle()) < 0)
    return fail(kFailed, "device '" + loaded->name +
                             "': not calibrated\n  no force is sent to it\n  fix: follow the instructions above, then "
                             "hapticd device calibrate " +
                             shellWord(options.file));
  printWhere(**device);
  return kWorked;
}

}  // namespace

void addDeviceCalibrate(const Command& app, int& exit_code) {
  auto options = std::make_shared<CalibrationArguments>();
  const Command command =
      app.subcommand("device").addSubcommand("calibrate",
                                             "Calibrate the encoders of an arm. The command tells you what to do. The "
                                             "arm gets no force until it is calibrated.");
  command.addOption("file", options->file, "device file (YAML)").required();
  command.addFlag("-y,--yes", options->yes, "do not wait for Enter");
  command.footer("Example:\n  hapticd device calibrate config/devices/simulated-premium15.yaml");
  command.callback([options, &exit_code] { exit_code = calibrateDevice(*options); });
}

}  // namespace hapticd::cli

// SPDX-License-Identifier: MIT
/// `hapticd device record`: records what an arm sends, as text that `decode` reads. The motors stay off.
#include <atomic>
#include <csignal>
#include <memory>
#include <optional>
#include <string>

#include "capture/capture.hpp"
#include "cli/device/file.hpp"
#include "cli/support/command.hpp"
#include "cli/support/output_file.hpp"
#include "hapticd/device_capture.h"
#include "host/device_instance.hpp"

namespace hapticd::cli {
namespace {

constexpr const char* kCaptureHeader = "\"@seconds bytes\" from the arm, \"> @seconds bytes\" to it";

struct CaptureArguments {
  std::string file, out = "-";
  double seconds = 10;
};

std::atomic<bool> g_stop{false};

/// The file to which the transfers are written, and how many transfers there were.
struct Log {
  std::FILE* out = nullptr;
  double until = 0;  ///< [s] end of the recording
  size_t from_arm = 0, to_arm = 0;
  bool full = false;
};

int32_t take(void* who, uint64_t time_ns, uint32_t to_arm, const uint8_t* bytes, size_t count) {
  Log& log = *static_cast<Log*>(who);
  const double time = static_cast<double>(time_ns) * 1e-9;
  ++(to_arm != 0 ? log.to_arm : log.from_arm);
  if (count > 0)
    log.full = log.full || std::fprintf(log.out, "%s@%.6f %s\n", to_arm != 0 ? "> " : "", time,
                                        capture::hexText(bytes, count).c_str()) < 0;
  return log.full || g_stop.load() || time >= log.until ? 1 : 0;
}

int record(const CaptureArguments& options) {
  const auto loaded = loadDeviceOrReport(options.file);
  if (!loaded) return kBadInput;
  const OutputKind kind{"a recording of this command", {"# "}, kCaptureHeader};
  if (const std::string wrong = whyNotWritten(options.out, kind, {{options.file, "the device file"}}); !wrong.empty())
    return fail(kBadInput, wrong);
  std::optional<SetupErrors> once(std::in_place);
  auto device = host::DeviceInstance::create(*loaded, logToTerminal);
  if (!device) return fail(kFailed, device.error());
  const auto* extension =
      static_cast<const hdv_ext_capture*>((*device)->description().extension((*device)->handle(), HDV_EXT_CAPTURE));
  if (extension == nullptr)
    return fail(kBadInput, options.file + ": its module " + loaded->module +
                               " has no bytes to record, expected a device file of usb_hid, usb_bulk or vme");
  if (auto opened = (*device)->open(); !opened) return fail(kFailed, opened.error());
  once.reset();  // from now on each message is printed when it comes
  Log log;
  log.out = options.out == "-" ? stdout : std::fopen(options.out.c_str(), "w");
  if (log.out == nullptr) return fail(kBadInput, options.out + ": cannot be written");
  log.until = options.seconds;
  for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, [](int) { g_stop = true; });
  std::fprintf(log.out, "# %s, %s: %s\n", loaded->name.c_str(), options.file.c_str(), kCaptureHeader);
  const hsp_status status = extension->capture((*device)->handle(), &take, &log);
  const bool closed = (log.out == stdout ? std::fflush(log.out) : std::fclose(log.out)) == 0;
  std::fprintf(stderr, "%zu transfers from the arm, %zu to it\n", log.from_arm, log.to_arm);
  if (log.full || !closed) return fail(kFailed, options.out + ": cannot be written");
  if (status < 0) return fail(kFailed, "device '" + loaded->name + "': the transport failed; is it plugged in?");
  return log.from_arm > 0 ? kWorked
                          : fail(kFailed,
                                 "the arm sent nothing: an arm that only answers needs wire.exchange: poll, "
                                 "and an arm that waits for a first command needs wire.startup");
}

}  // namespace

void addDeviceRecord(const Command& app, int& exit_code) {
  auto options = std::make_shared<CaptureArguments>();
  const Command command = app.subcommand("device").addSubcommand(
      "record", "Record in a file, byte by byte, what an arm sends. Its motors stay off.");
  command.addOption("file", options->file, "device file (YAML)").required();
  command.addOption("-o,--out", options->out, "file to write; - for standard output");
  command.addOption("--for", options->seconds, "how long [s]; Ctrl-C ends it earlier").showDefault().within(0.001, 1e6);
  command.footer(
      "The layout of the reports need not be right yet: only usb, exchange, rate, endpoints and startup are used, and "
      "a\npolled arm gets the output report with its motors off.\n\n"
      "Example:\n"
      "  hapticd device record my-arm.yaml --for 5 -o capture.txt && hapticd device decode my-arm.yaml capture.txt");
  command.callback([options, &exit_code] { exit_code = record(*options); });
}

}  // namespace hapticd::cli

// SPDX-License-Identifier: MIT
/// `hapticd device decode` and `encode`: apply the wire format of a device file to bytes, without the arm.
#include <algorithm>
#include <filesystem>
#include <memory>
#include <sstream>
#include <string>

#include "base/shell_word.hpp"
#include "capture/hints.hpp"
#include "capture/plausible.hpp"
#include "capture/report_table.hpp"
#include "capture/row_range.hpp"
#include "capture/saturation.hpp"
#include "capture/time_series_hint.hpp"
#include "cli/device/content.hpp"
#include "cli/device/decoded_table.hpp"
#include "cli/device/encode_columns.hpp"
#include "cli/device/file.hpp"
#include "cli/device/joint_angles.hpp"
#include "cli/support/command.hpp"
#include "cli/support/output_file.hpp"
#include "document/csv.hpp"
#include "document/node.hpp"
#include "host/device_instance.hpp"

namespace hapticd::cli {
namespace {

struct DecodeArguments {
  std::string file, input = "-", out = "-";
  bool hex = false, raw = false, from_arm = false;
};

/// A device file's wire format, and what the file says about its arm.
struct Described {
  codec::Wire wire;
  size_t joints = 0;
  capture::ArmFacts arm;
  std::unique_ptr<host::DeviceInstance> device;
};

capture::ArmFacts factsOf(const scene::Device& device, size_t joints) {
  capture::ArmFacts facts;
  facts.joints = joints;
  if (const scene::Value* limits = givenIn(device.parameters, "arm.limits")) facts.limits = limits->numbers;
  if (const scene::Value* most = givenIn(device.parameters, "arm.max_torque")) facts.max_torque = most->numbers;
  facts.zeroed = numberIn(device.parameters, "calibration.method") > 1;  // pose
  facts.max_speed = numberIn(device.parameters, "health.max_speed", facts.max_speed);
  facts.least_rate = numberIn(device.parameters, "health.least_rate", facts.least_rate);
  if (facts.max_torque.size() == 1) facts.max_torque.assign(joints, facts.max_torque[0]);
  return facts;
}

/// Reads the device file, or prints all its problems.
std::optional<Described> describedIn(const std::string& file, int& exit_code) {
  exit_code = kBadInput;
  const auto loaded = loadDeviceOrReport(file);
  if (!loaded) return std::nullopt;
  auto device = host::DeviceInstance::create(*loaded, logToTerminal);
  if (!device) return exit_code = fail(kFailed, device.error()), std::nullopt;
  if (const scene::Value* wire = givenIn(loaded->parameters, "wire")) {
    const size_t joints = (*device)->kinematics().joint_count;
    return Described{codec::readWire(wire->text, joints), joints, factsOf(*loaded, joints), std::move(*device)};
  }
  exit_code = fail(kBadInput, file + ": its module " + loaded->module +
                                  " has no parameter wire, expected a device file of usb_hid, usb_bulk or vme");
  return std::nullopt;
}

int writeOut(const std::string& file, const std::string& text) {
  const bool standard = file == "-";
  std::FILE* out = standard ? stdout : std::fopen(file.c_str(), "wb");
  const bool written = out != nullptr && std::fwrite(text.data(), 1, text.size(), out) == text.size();
  const bool closed = out != nullptr && (standard ? std::fflush(out) : std::fclose(out)) == 0;
  return written && closed ? kWorked : fail(kFailed, file + ": cannot be written");
}

/// Returns the files that a command reads, over which it must not write.
Inputs inputsOf(const DecodeArguments& options) {
  return {{options.input, "the input"}, {options.file, "the device file"}};
}

int decode(const DecodeArguments& options) {
  int exit_code = kWorked;
  const auto described = describedIn(options.file, exit_code);
  if (!described) return exit_code;
  const OutputKind kind = tableKind("report,time,verdict");
  if (const std::string wrong = whyNotWritten(options.out, kind, inputsOf(options)); !wrong.empty())
    return fail(kBadInput, wrong);
  const auto bytes = contentOf(options.input);
  if (!bytes)
    return fail(kBadInput, options.input + ": " + bytes.error() +
                               (options.input == "-" || std::filesystem::exists(options.input)
                                    ? ""
                                    : "; hapticd device record writes a capture"));
  const auto form = options.hex ? capture::Form::kHex : options.raw ? capture::Form::kRaw : capture::Form::kGuess;
  const auto taken = capture::readCapture(*bytes, form);
  if (!taken) return fail(kBadInput, options.input + ": " + taken.error());
  const capture::Decoded decoded = capture::decodeCapture(described->wire, *taken);
  if (const int failed = writeOut(options.out, capture::csvOf(described->wire, described->joints, decoded));
      failed != 0)
    return failed;
  const std::string layout = capture::hintsOf(described->wire, *taken, decoded);
  std::fprintf(stderr, "read as %s: %s\n%s%s%s", taken->text ? "hexadecimal text" : "raw bytes",
               capture::summaryOf(decoded).c_str(), layout.c_str(),
               capture::timeSeriesHints(described->wire, decoded, described->arm.least_rate).c_str(),
               // numbers at wrong places say nothing about the scale
               layout.empty() ? capture::implausible(described->wire, described->arm, decoded).c_str() : "");
  if (decoded.reports.empty())
    return fail(kFailed, "no report in " + std::to_string(taken->bytes()) + " bytes, expected " +
                             std::to_string(described->wire.input.bytes()) + " bytes per report");
  return decoded.good() == decoded.reports.size() && decoded.lost == 0 ? kWorked : kFailed;
}

/// Returns the first line of a table that is neither empty nor a comment.
std::string firstLine(const std::string& text) {
  std::istringstream in(text);
  std::string line;
  while (std::getline(in, line) && (line.empty() || line[0] == '#')) line.clear();
  return line;
}

/// Returns true for "0.1 0.2 0.3" or "0.1;0.2": numbers without commas between them.
bool lacksCommas(const std::string& line) {
  const size_t first = line.find_first_not_of(" \t"), end = line.find_first_of(" ;\t", first);
  if (end == std::string::npos || line.find(',') != std::string::npos) return false;
  return document::toNumber(line.substr(first, end - first)).has_value() &&
         line.find_first_not_of(" ;\t\r", end) != std::string::npos;
}

/// Returns the same numbers, separated by commas.
std::string withCommas(const std::string& line) {
  std::string text, word;
  for (std::istringstream in(line); in >> word;) {
    while (!word.empty() && (word.back() == ';' || word.back() == '\r')) word.pop_back();
    if (!word.empty()) text += (text.empty() ? "" : ",") + word;
  }
  std::replace(text.begin(), text.end(), ';', ',');
  return text;
}

/// Returns the names of a table's columns: those in its first line, or without a header the torques or positions of all
/// joints.
std::vector<std::string> namesIn(const std::string& text, const std::vector<std::string>& known, size_t joints) {
  std::string name;
  std::vector<std::string> names;
  std::istringstream fields(firstLine(text));
  while (std::getline(fields, name, ',')) {
    name.erase(0, name.find_first_not_of(" \t\r"));
    name.erase(name.find_last_not_of(" \t\r") + 1);
    names.push_back(name);
  }
  const std::string begin = names.empty() ? "" : names[0];
  const bool numbers = document::toNumber(begin).has_value() || begin == "nan" || begin == "inf" || begin == "-inf";
  if (numbers || names.empty()) names.assign(known.begin(), known.begin() + static_cast<long>(joints));
  return names;
}

/// Returns a problem for each column with a number that the report cannot carry, at the first such line.
document::Problems beyondFields(const DecodeArguments& options, const Described& described,
                                const EncodeColumns& columns, const document::CsvTable& table) {
  document::Problems problems;
  for (size_t column = 0; column < columns.from.size(); ++column)
    for (size_t i = 0; i < table.rows(); ++i) {
      const std::string wrong = capture::beyondField(described.wire, !options.from_arm, columns.names[column],
                                                     table.row(i)[columns.from[column]]);
      if (wrong.empty()) continue;
      document::report(problems, options.input, table.lines[i], 0, columns.names[column], wrong);
      break;
    }
  return problems;
}

/// Appends a report to a transfer. Each packet of a transfer from the arm begins with bytes of the USB chip, which are
/// 0 here.
void appendReport(const codec::Framing& framing, bool from_arm, const std::vector<uint8_t>& report,
                  std::vector<uint8_t>& transfer) {
  for (const uint8_t byte : report) {
    while (from_arm && framing.used && transfer.size() % framing.packet < framing.header) transfer.push_back(0);
    transfer.push_back(byte);
  }
}

/// Returns every row as a report: all of them in one transfer of raw bytes, or each in a line of hexadecimal digits.
Result<std::string> encodeTable(const DecodeArguments& options, const Described& described,
                                const EncodeColumns& columns, const document::CsvTable& table) {
  std::string out;
  std::vector<uint8_t> transfer;
  std::vector<double> joints(HDV_MAX_JOINTS, 0.0);
  capture::Saturation saturation(described.arm.max_torque);
  for (size_t i = 0; i < table.rows(); ++i) {
    const std::string line = options.input + ": line " + std::to_string(table.lines[i]) + ": ";
    const auto values = columns.row(table.row(i), *described.device, joints);
    if (!values) return Error{line + values.error()};
    const auto bytes = capture::encodeRow(described.wire, !options.from_arm, columns.names, values->data(),
                                          static_cast<uint32_t>(i + 1));
    if (!bytes) return Error{bytes.error()};
    saturation.add(described.wire, !options.from_arm, columns.names, values->data(), table.lines[i]);
    if (!options.raw) transfer.clear();
    appendReport(described.wire.framing, options.from_arm, *bytes, transfer);
    if (!options.raw) out += capture::hexText(transfer.data(), transfer.size()) + "\n";
  }
  if (options.raw) out.assign(transfer.begin(), transfer.end());
  for (const std::string& what : saturation.findings())
    std::fprintf(stderr, "warning: %s: %s\n", options.input.c_str(), what.c_str());
  return out;
}

/// Reads the table of numbers from the input, or reports what is wrong with it.
std::optional<std::string> tableOf(const DecodeArguments& options) {
  const auto text = contentOf(options.input);
  if (!text)
    return (void)fail(kBadInput,
                      options.input + ": " + text.error() +
                          "\n  numbers may also come on standard input: echo 0.1,0,0 | hapticd device encode " +
                          shellWord(options.file)),
           std::nullopt;
  if (const std::string line = firstLine(*text); lacksCommas(line))
    return (void)fail(kBadInput, options.input + ": \"" + line.substr(0, 40) +
                                     "\", expected commas between the numbers: " + withCommas(line.substr(0, 40))),
           std::nullopt;
  PlainTable plain = plainTable(*text);
  if (plain.left_out > 0)
    std::fprintf(stderr, "note: %s: rows that are not a good report are left out: %zu\n", options.input.c_str(),
                 plain.left_out);
  return std::move(plain.text);
}

int encode(const DecodeArguments& options) {
  int exit_code = kWorked;
  const auto described = describedIn(options.file, exit_code);
  if (!described) return exit_code;
  const OutputKind bytes{"a file", {""}};  // bytes may be anything
  if (const std::string wrong = whyNotWritten(options.out, bytes, inputsOf(options)); !wrong.empty())
    return fail(kBadInput, wrong);
  const auto text = tableOf(options);
  if (!text) return kBadInput;
  const auto known = capture::columnsOf(described->wire, described->joints, !options.from_arm);
  const auto names = namesIn(*text, known, described->joints);
  const auto columns = encodeColumns(names, known, described->joints, !options.from_arm);
  if (!columns) return fail(kBadInput, options.input + ": " + columns.error());
  std::string header;
  for (const std::string& name : names) header += (header.empty() ? "" : ",") + name;
  document::Problems problems;
  const auto table = document::parseCsv(*text, options.input, {{header}}, problems);
  printProblems(problems, stderr);
  if (!table) return kBadInput;
  problems = beyondFields(options, *described, *columns, *table);
  printProblems(problems, stderr);
  if (!problems.empty()) return kBadInput;
  std::vector<size_t> joints;
  for (size_t i = 0; options.from_arm && i < columns->from.size() && joints.size() < described->joints; ++i)
    if (columns->names[i] == "position" + std::to_string(joints.size() + 1)) joints.push_back(columns->from[i]);
  warnOfDegrees(options.input, *table, joints, *described->device);
  const auto out = encodeTable(options, *described, *columns, *table);
  if (!out) return fail(kBadInput, out.error());
  return writeOut(options.out, *out);
}

void addDecode(const Command& device, int& exit_code) {
  auto options = std::make_shared<DecodeArguments>();
  const Command command =
      device.addSubcommand("decode", "Show a captured stream of an arm as numbers, as its device file reads it.");
  command.addOption("file", options->file, "device file (YAML)").required();
  command.addOption("capture", options->input, "captured bytes; - for standard input").showDefault();
  const Option hex =
      command.addFlag("--hex", options->hex, "the capture is text: one transfer per line, two digits per byte");
  command.addFlag("--raw", options->raw, "the capture is the bytes themselves, even if they read as text")
      .excludes(hex);
  command.addOption("-o,--out", options->out, "CSV file to write; - for standard output");
  command.footer(
      "A capture is raw bytes, or text with one transfer per line: \"01 ff 3c\", the E: lines of hid-recorder, lines "
      "of\n"
      "usbmon, hex dumps of Wireshark, or what `hapticd device record` writes. The output has one row per report: "
      "positions, torques and buttons in SI units,\n"
      "or the reason why the bytes are not a report. The exit code is 1 if a report is bad.\n\n"
      "Examples:\n  hapticd device decode my-arm.yaml capture.bin\n"
      "  printf '00 01 00 02 00 03 00 00 00 00 00 00 00 00\\n' | hapticd device decode "
      "config/devices/woodenhaptics.yaml --hex");
  command.callback([options, &exit_code] { exit_code = decode(*options); });
}

void addEncode(const Command& device, int& exit_code) {
  auto options = std::make_shared<DecodeArguments>();
  const Command command = device.addSubcommand("encode", "Write numbers as the bytes of an arm's reports.");
  command.addOption("file", options->file, "device file (YAML)").required();
  command.addOption("csv", options->input, "CSV file with the numbers; - for standard input").showDefault();
  command.addFlag("--from-arm", options->from_arm,
                  "encode reports from the arm (input), instead of commands to the arm (output)");
  command.addFlag("--raw", options->raw, "write the bytes themselves instead of hexadecimal text");
  command.addOption("-o,--out", options->out, "file to write; - for standard output");
  command.footer(
      "Each row of the CSV is one report. "
      "Its header names the columns: torque1,torque2 [N m, N], reference1, enable, follow,\n"
      "calibrate; with --from-arm position1, velocity1, torque1, buttons, sequence, starts, clock, fault, calibrated. "
      "Without a\n"
      "header they are the torques or, with --from-arm, the positions of all joints. "
      "Constants, counters, checksums and\n"
      "escapes are added. Tables of `device kinematics` are understood: tau1,... are the torques; with --from-arm,\n"
      "q1,... are the positions, or x,y,z is the tip in the device frame; other columns are left out. In a table\n"
      "written by `device decode`, only the rows of good reports are used.\n\n"
      "Examples:\n  echo 0.1,0,-0.1 | hapticd device encode config/devices/woodenhaptics.yaml\n"
      "  echo 0.1,1.5,1.6 | hapticd device encode --from-arm config/devices/woodenhaptics.yaml | "
      "hapticd device decode config/devices/woodenhaptics.yaml");
  command.callback([options, &exit_code] { exit_code = encode(*options); });
}

}  // namespace

void addDeviceDecode(const Command& app, int& exit_code) {
  addDecode(app.subcommand("device"), exit_code);
  addEncode(app.subcommand("device"), exit_code);
}

}  // namespace hapticd::cli

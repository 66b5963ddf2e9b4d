// SPDX-License-Identifier: MIT
/// `hapticd device new`: writes a commented device file to start from. It asks for what no option gives.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "cli/command.hpp"
#include "cli/questions.hpp"
#include "codec/checksum.hpp"
#include "codec/wire_correction.hpp"
#include "diagnostics/device/device_trial.hpp"
#include "document/node.hpp"

namespace hapticd::cli {
namespace {

namespace fs = std::filesystem;

struct NewDeviceArguments {
  std::string name, out, bus = "hid", kind = "phantom", id = "1234:0006";
  std::string checksum = "none";
  std::vector<double> lengths, twists;
  std::vector<double> counts{2000}, gear{10}, torque{0.5};  ///< one number for all joints, or one per joint
  int joints = 3, bits = 16, buttons = 1, report_id = 0;
  double force = 2;
  bool no_questions = false;
};

double ofJoint(const std::vector<double>& list, int joint) {
  return list[list.size() == 1 ? 0 : static_cast<size_t>(joint)];
}

/// Tells whether the arm is a chain whose axes are all parallel. The tip of such a chain stays in a plane, and no force
/// across the plane can be felt.
bool isPlanar(const NewDeviceArguments& o) {
  const auto straight = [](double twist) { return std::abs(std::sin(twist)) < 1e-6; };
  return o.kind == "chain" && o.joints > 1 && std::all_of(o.twists.begin(), o.twists.end(), straight);
}

std::string wrongLists(const NewDeviceArguments& o) {
  const auto joints = static_cast<size_t>(o.joints);
  for (const auto& [option, list] :
       {std::pair{"--counts", &o.counts}, std::pair{"--gear", &o.gear}, std::pair{"--torque", &o.torque}}) {
    if (list->size() != 1 && list->size() != joints)
      return fmt::format("{}: {} numbers, expected one, or one for each of the {} joints", option, list->size(),
                         o.joints);
    if (!std::all_of(list->begin(), list->end(), [](double value) { return value > 0; }))
      return fmt::format("{}: expected numbers above 0", option);
  }
  if (!o.twists.empty() && (o.kind != "chain" || o.twists.size() != joints))
    return fmt::format("--twists: {} numbers, expected one for each joint of a chain", o.twists.size());
  return "";
}

bool hasChecksum(const NewDeviceArguments& o) {
  return o.checksum != "none";
}

std::string wrongChecksum(const std::string& name) {
  static const std::vector<std::string> kPlain{"none", "sum", "xor", "sum8", "xor8"};
  const auto crcs = codec::namedCrcs();
  const bool known =
      std::find(kPlain.begin(), kPlain.end(), name) != kPlain.end() ||
      std::any_of(crcs.begin(), crcs.end(), [&](const codec::NamedCrc& one) { return name == one.name; });
  if (known) return "";
  if (name == "crc")
    return "--checksum crc: a CRC without a name needs its numbers, which only the file can give; expected the name of "
           "a CRC, such as crc16-modbus, or none";
  return "--checksum " + name + ": no checksum has this name" + codec::suggestMethod(name) +
         "; expected none, sum, xor or the name of a CRC, such as crc8, crc16 or crc16-modbus (driver/docs/devices.md "
         "lists all)";
}

/// Returns true for two numbers of one to four hexadecimal digits, such as 16c0:0486.
bool isUsbId(std::string_view id) {
  const auto isNumber = [](std::string_view digits) {
    uint16_t number = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number, 16);
    return digits.size() <= 4 && error == std::errc() && end == digits.data() + digits.size();
  };
  const size_t colon = id.find(':');
  return colon != id.npos && isNumber(id.substr(0, colon)) && isNumber(id.substr(colon + 1));
}

std::string wrongIn(const NewDeviceArguments& o) {
  const bool hid = o.bus == "hid", bulk = o.bus == "bulk";
  if (!hid && !bulk) return "--bus " + o.bus + ": expected hid or bulk";
  if (o.kind != "phantom" && o.kind != "delta" && o.kind != "chain")
    return "--kind " + o.kind + ": expected phantom, delta or chain";
  if (o.kind != "chain" && o.joints != 3)
    return "--joints " + std::to_string(o.joints) + ": a " + o.kind + " has 3 joints";
  if (o.joints < 1 || o.joints > 16) return "--joints " + std::to_string(o.joints) + ": expected 1 to 16";
  if (o.bits < 2 || o.bits > 64) return "--bits " + std::to_string(o.bits) + ": expected 2 to 64";
  const size_t lengths = o.kind == "phantom" ? 2 : o.kind == "delta" ? 8 : static_cast<size_t>(o.joints);
  if (!o.lengths.empty() && o.lengths.size() != lengths)
    return fmt::format("--lengths: {} numbers, expected {} for a {}", o.lengths.size(), lengths, o.kind);
  if (std::any_of(o.lengths.begin(), o.lengths.end(), [](double length) { return length < 0; }))
    return "--lengths: expected 0 m or more each; a link that points the other way has a twist, not a length below 0";
  if (const std::string wrong = wrongLists(o); !wrong.empty()) return wrong;
  if (!(o.force > 0)) return "--force: expected a number above 0";
  if (const std::string wrong = wrongChecksum(o.checksum); !wrong.empty()) return wrong;
  if (o.report_id < 0 || o.report_id > 255)
    return "--report-id " + std::to_string(o.report_id) + ": expected 1 to 255, or 0 if reports have none";
  if (o.buttons < 0 || o.buttons > 32) return "--buttons " + std::to_string(o.buttons) + ": expected 0 to 32";
  if (!isUsbId(o.id)) return "--id " + o.id + ": expected vendor:product, hexadecimal, such as 1234:0006";
  return "";
}

std::string lengthsQuestion(const std::string& kind) {
  if (kind == "phantom") return "Lengths of upper arm and forearm [m], separated by commas [0.2, 0.2]";
  if (kind == "delta") return "Lengths a, b, c, d, e, f, r, s [m], separated by commas [those of a Falcon]";
  return "Lengths of the links [m], one for each joint, separated by commas [0.2 each]";
}

void askAll(const Command& command, NewDeviceArguments& options) {
  Questions questions(command);
  const auto wrong = [&options] { return wrongIn(options); };
  questions.ask("--bus", "Bus: hid, bulk (USB)", options.bus, wrong);
  questions.ask("--id", "USB vendor and product, hexadecimal (lsusb prints them)", options.id, wrong);
  if (options.bus == "hid")
    questions.ask("--report-id", "HID report id: first byte of each report, 1 to 255; 0 if reports have none",
                  options.report_id, wrong);
  questions.ask("--kind", "Mechanism: phantom (two links on a turning base), delta, chain (any serial arm)",
                options.kind, wrong);
  if (options.kind == "chain") questions.ask("--joints", "Joints", options.joints, wrong);
  questions.askList("--lengths", lengthsQuestion(options.kind), options.lengths, wrong);
  if (options.kind == "chain")
    questions.askList("--twists", "Twist alpha from each joint's axis to the next [rad], 0: parallel [all 0]",
                      options.twists, wrong);
  questions.askList("--counts", "Encoder counts of one motor turn (four times its lines), or one for each joint [2000]",
                    options.counts, wrong);
  questions.askList("--gear", "Motor turns of one joint turn, or one for each joint [10]", options.gear, wrong);
  questions.ask("--bits", "Bits of a position in a report", options.bits, wrong);
  questions.ask("--buttons", "Buttons", options.buttons, wrong);
  questions.ask("--checksum",
                "Checksum of the arm's reports: none, sum, xor, or the name of a CRC, such as crc16-modbus",
                options.checksum, wrong);
  questions.askList("--torque", "Largest torque of a joint [N m], or one for each [0.5]", options.torque, wrong);
  questions.ask("--force", "Largest force at the tip, to begin with [N]", options.force, wrong);
}

std::string listOf(const std::vector<double>& numbers) {
  return fmt::format("[{:g}]", fmt::join(numbers, ", "));
}

std::string phantomOf(const NewDeviceArguments& o) {
  std::vector<double> all = o.lengths.empty() ? std::vector<double>{0.2, 0.2} : o.lengths;
  all.insert(all.end(), {0, 0, 0});
  return fmt::format("    lengths: {}     # m: upper arm, forearm; l3, l5, l6: see driver/docs/devices.md\n",
                     listOf(all)) +
         "    masses: [0, 0, 0, 0]          # kg: ma, mc, mbe, mdf; all 0: the weight is not carried; if left out, "
         "those "
         "of a Premium 1.5\n";
}

std::string deltaOf(const NewDeviceArguments& o) {
  return (o.lengths.empty() ? "    # lengths: [a, b, c, d, e, f, r, s]    # m; if left out, those of a Falcon\n"
                            : fmt::format("    lengths: {}    # m: a, b, c, d, e, f, r, s\n", listOf(o.lengths))) +
         "    masses: [0, 0, 0]             # kg: arm, rod, platform; all 0: the weight is not carried; if left out, "
         "guesses "
         "for a Falcon\n";
}

std::string chainOf(const NewDeviceArguments& o) {
  std::string text =
      "    dh:                           # a, alpha, d, theta: m, rad (standard Denavit-Hartenberg), one row per "
      "joint\n";
  for (int i = 0; i < o.joints; ++i)
    text += fmt::format("      - [{:g}, {:.9g}, 0, 0]\n", o.lengths.empty() ? 0.2 : ofJoint(o.lengths, i),
                        o.twists.empty() ? 0 : ofJoint(o.twists, i));
  if (isPlanar(o))
    text +=
        "      # Every alpha is 0: all axes are parallel, and the tip stays in a plane. A base that turns about the\n"
        "      # vertical has alpha 1.5707963 in the first row, and base_orientation below.\n";
  return text +
         "    # base_orientation: [0.7071068, -0.7071068, 0, 0]   # the first axis points up; if left out, toward "
         "the user\n"
         "    # masses: [...]               # kg, one per row; if left out, the weight is not carried\n"
         "    # centers: [[-0.1, 0, 0], ...] # m, one per row: the link's centre of mass, from its far end, in its "
         "frame;\n"
         "                                  # if left out, each mass is at the far end of its link, so the weight is "
         "too large\n";
}

std::string armOf(const NewDeviceArguments& o) {
  const std::string links = o.kind == "phantom" ? phantomOf(o) : o.kind == "delta" ? deltaOf(o) : chainOf(o);
  return fmt::format("  arm:\n    kind: {}\n", o.kind) + links +
         fmt::format(
             "    # limits: [[-1, 1], ...]      # rad, one row per joint; if left out, those of the mechanism\n"
             "    max_torque: {}             # N m at the joint: torque of the motor times its turns per turn of the "
             "joint\n",
             listOf(o.torque));
}

/// Returns how many bits a checksum takes, in whole bytes, from its name: 16 for crc16-modbus, 8 for crc5-usb.
int checksumBits(const std::string& name) {
  const size_t digits = name.find_first_of("0123456789");
  int bits = 8;  // of sum, xor
  if (digits != std::string::npos) std::from_chars(name.data() + digits, name.data() + name.size(), bits);
  return std::clamp((bits + 7) / 8 * 8, 8, 64);
}

/// Returns the line for a checksum over the first `size` bytes, or a comment that shows how to write one.
std::string checksumOf(const NewDeviceArguments& o, int size) {
  const bool given = hasChecksum(o);
  const std::string name = given ? o.checksum : "crc16-modbus";
  const int bits = checksumBits(name);
  return fmt::format("        {}- {{is: checksum, at: {}, type: u{}, method: {}, from: 0, to: {}{}}}{}\n",
                     given ? "" : "# ", size, bits, name, size, o.report_id > 0 ? ", over_id: true" : "",
                     given ? "" : fmt::format("      # then size: {}", size + bits / 8));
}

std::string wireOf(const NewDeviceArguments& o) {
  const std::string id = o.report_id > 0 ? fmt::format("      id: {}\n", o.report_id) : std::string();
  std::string text = fmt::format(
      "  wire:                           # driver/docs/devices.md has every key\n"
      "    exchange: stream              # or poll: the arm answers each command\n    rate: 1000                    # "
      "Hz\n"
      "    # watchdog: 0.02              # s: if the arm has a watchdog, the time after which it switches its motors "
      "off\n{}"
      "    input:                        # what the arm sends; bytes are counted without the report id\n",
      o.bus == "bulk" ? "    endpoints: {in: 0x81, out: 0x02}\n" : "");
  int bit = 16;
  std::string fields = "        - {is: counter, at: 0, type: u16}               # grows with each report\n";
  for (int i = 0; i < o.joints; ++i, bit += o.bits) {
    const std::string place = bit % 8 == 0 ? fmt::format("at: {}", bit / 8) : fmt::format("bit_offset: {}", bit);
    fields +=
        fmt::format("        - {{is: position, joint: {}, {}, type: i{}, scale: {:.9g}{}}}\n", i + 1, place, o.bits,
                    2 * M_PI / (ofJoint(o.counts, i) * ofJoint(o.gear, i)), o.bits <= 24 ? ", wraps: true" : "");
  }
  for (int i = 0; i < o.buttons; ++i, ++bit)
    fields += fmt::format("        - {{is: button, button: {}, bit_offset: {}, type: u1}}\n", i + 1, bit);
  const int payload = (bit + 7) / 8, size = payload + (hasChecksum(o) ? checksumBits(o.checksum) / 8 : 0);
  fields += checksumOf(o, payload);
  text +=
      id +
      fmt::format(
          "      size: {}\n      fields:                     # rad = raw * scale: 2 pi / (counts * turns of one joint "
          "turn)\n{}",
          size, fields);
  text += fmt::format(
      "    output:                       # what the arm gets\n{}      size: {}\n"
      "      fields:                     # N m = raw * scale\n",
      id, 2 * o.joints + 2);
  for (int i = 0; i < o.joints; ++i)
    text += fmt::format("        - {{is: torque, joint: {}, at: {}, type: i16, scale: {:.6g}}}\n", i + 1, 2 * i,
                        ofJoint(o.torque, i) / 32767);
  text += fmt::format("        - {{is: enable, at: {}, type: u8}}\n        - {{is: counter, at: {}, type: u8}}\n",
                      2 * o.joints, 2 * o.joints + 1);
  return text;
}

/// Returns the block `mount`. Only for a PHANToM is the rest position known here; for other mechanisms it depends on
/// their dimensions.
std::string mountOf(const NewDeviceArguments& o) {
  if (o.kind == "phantom")
    return "mount: {position: [0, 0, 0.09]}     # m: where the arm's frame is in the world; here the resting tip is\n"
           "                                     # 9 cm in front of the origin, where the scenes have their shapes\n";
  return "# mount: {position: [0, 0, 0]}      # m: where the arm's frame is in the world. The shapes of scenes are "
         "near\n"
         "                                     # the origin, so take (0, 0, 0.09) minus the resting tip, as `device "
         "kinematics` prints it\n";
}

std::string textOf(const NewDeviceArguments& o) {
  std::string pose;
  for (int i = 0; i < o.joints; ++i) pose += i > 0 ? ", 0" : "0";
  return fmt::format(
      "# {0}. Written by `hapticd device new`; each number is a guess until you have measured it.\n"
      "hapticd-device: 1\nmodule: usb_{1}\nname: {0}\n"
      "{9}"
      "limits: {{force: {2:g}, {10}passivity: true}}   # N: begin low; raise it when the force has the right "
      "direction\n{8}"
      "parameters:\n  usb: {{id: \"{3}\"}}\n"
      "  # device: {{max_force: 5, max_stiffness: 1000, mass: 0.2}}      # properties for `check` and `tune`\n{4}"
      "  calibration:\n    method: pose                  # or none, for absolute encoders; or device, if the arm finds "
      "its zero itself\n"
      "    pose: [{5}]{6}# rad: joint positions while the arm is held as described below\n    instructions: \"Hold "
      "every joint at its zero.\"\n{7}",
      o.name, o.bus, o.force, o.id, armOf(o), pose, "               ", wireOf(o),
      o.buttons > 0 ? "# in limits: enable: {button: 0}   # forces only while the button is held; buttons count from 0 "
                      "here, from 1 in wire\n"
                    : "",
      mountOf(o),
      // [N m] torque of the largest force at a lever of 0.1 m.
      o.joints > 3 ? fmt::format("torque: {:.2g}, ", 0.1 * o.force) : "");
}

bool usableDeviceName(const std::string& name) {
  for (const char c : name)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '_' && c != '-') return false;
  return !name.empty() && name.size() <= 40;
}

/// Prints what to do with the new file.
void printNextSteps(const NewDeviceArguments& options, const std::string& name) {
  const std::string twin = options.kind == "delta"
                               ? ""  // the simulated arm does not have this mechanism
                               : "  hapticd device twin " + name +
                                     "                 # the same arm simulated, to try a scene without the "
                                     "real arm\n";
  std::printf(
      "%s\n\nthen, step by step (driver/docs/devices.md, \"A new arm, step by step\"):\n"
      "  hapticd check %s                       # after each change\n"
      "  hapticd device decode %s CAPTURE       # captured bytes as joint positions\n"
      "  hapticd device record %s               # what the arm sends, motors off\n"
      "%s"
      "  hapticd device calibrate %s\n"
      "  hapticd run SCENE.yaml --device %s --view       # the arm in a page\n",
      name.c_str(), name.c_str(), name.c_str(), name.c_str(), twin.c_str(), name.c_str(), name.c_str());
  if (isPlanar(options))
    std::printf(
        "\nnote: every axis of arm.dh is parallel, so the tip stays in a plane and feels no force across it\n"
        "  fix: if your arm is not flat, give its twists: --twists 1.5707963,0,0, or alpha in arm.dh\n");
}

int makeNew(const Command& command, NewDeviceArguments options) {
  if (!usableDeviceName(options.name))
    return fail(kBadInput,
                "\"" + options.name + "\" is not a valid name of a device, expected letters, digits, _ and -");
  const fs::path file = options.out.empty() ? fs::path(options.name + ".yaml") : fs::path(options.out);
  std::error_code error;
  if (fs::exists(file, error))
    return fail(kBadInput, file.string() + " exists already, expected the name of a new file");
  if (!options.no_questions && isatty(STDIN_FILENO) != 0) askAll(command, options);
  if (const std::string wrong = wrongIn(options); !wrong.empty()) return fail(kBadInput, wrong);
  std::ofstream out(file);
  out << textOf(options) << std::flush;
  if (!out) {
    const bool begun = out.is_open();
    if (begun) fs::remove(file, error);  // a file that is not complete
    return fail(begun ? kFailed : kBadInput,
                file.string() + ": cannot be written, expected a disk with room and a folder that you may write to");
  }
  document::Problems problems = scene::loadDevice(file, catalog()).problems;
  if (problems.empty()) problems = diagnostics::tryDevice(file, catalog());
  printProblems(problems, stderr);
  const std::string name = file.string();
  if (!problems.empty())
    return fail(kFailed, name + " is written, but cannot be used yet\n  fix: mend these problems, then hapticd check " +
                             name + "; to begin anew with other options: rm " + name);
  printNextSteps(options, name);
  return kWorked;
}

}  // namespace

void addDeviceNew(const Command& app, int& exit_code) {
  auto options = std::make_shared<NewDeviceArguments>();
  const Command command = app.subcommand("device").addSubcommand(
      "new", "Write a commented device file to start from; asks on a terminal for what no option gives.");
  command.addOption("name", options->name, "name of the arm: letters, digits, _ and -").required();
  command.addOption("-o,--out", options->out, "file to write; default: NAME.yaml in the current folder");
  command.addOption("--bus", options->bus, "hid or bulk, both USB").showDefault();
  command.addOption("--id", options->id, "USB vendor:product, hexadecimal").showDefault();
  command.addOption("--kind", options->kind, "phantom, delta or chain").showDefault();
  command.addOption("--joints", options->joints, "number of joints of a chain").showDefault().wholeWithin(1, 16);
  const auto list = [command](const char* option, std::vector<double>& numbers, const char* doc) {
    command.addOption(option, numbers, doc).delimiter(',').oneValueEach();
  };
  list("--lengths", options->lengths, "link lengths [m], separated by commas");
  list("--twists", options->twists, "for a chain: angle alpha from each joint's axis to the next [rad]; default: 0");
  list("--counts", options->counts, "encoder counts of one motor turn, or one for each joint; default: 2000");
  list("--gear", options->gear, "motor turns of one joint turn, or one for each joint; default: 10");
  command.addOption("--bits", options->bits, "bits of a position in a report").showDefault();
  command.addOption("--report-id", options->report_id, "HID report id; 0: reports have none")
      .showDefault()
      .wholeWithin(0, 255);
  command
      .addOption("--checksum", options->checksum,
                 "checksum of the arm's reports: none, sum, xor, or the name of a CRC, such as crc16-modbus")
      .showDefault();
  command.addOption("--buttons", options->buttons, "buttons").showDefault().wholeWithin(0, 32);
  list("--torque", options->torque, "largest torque of a joint [N m], or one for each; default: 0.5");
  command.addOption("--force", options->force, "limit of the force at the tip [N]").showDefault();
  command.addFlag("--no-questions", options->no_questions, "ask nothing, take the defaults");
  command.footer(
      "The file is checked as soon as it is written. Every number in it is a guess until you have measured it.\n\n"
      "Examples:\n  hapticd device new my-arm\n"
      "  hapticd device new my-arm --kind phantom --id 16c0:0486 --lengths 0.21,0.17 --counts 4000 --gear 9.5 --bits "
      "24");
  command.callback([command, options, &exit_code] { exit_code = makeNew(command, *options); });
}

}  // namespace hapticd::cli

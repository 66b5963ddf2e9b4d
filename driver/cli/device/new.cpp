// SPDX-License-Identifier: MIT
/// `hapticd device new`: writes a commented device file to start from. It asks for what no option gives.
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "base/shell_word.hpp"
#include "cli/device/questions.hpp"
#include "cli/support/command.hpp"
#include "device_draft/device_draft.hpp"
#include "diagnostics/device/device_trial.hpp"
#include "document/node.hpp"

namespace hapticd::cli {
namespace {

namespace fs = std::filesystem;
using device_draft::DeviceDraft;

struct NewDeviceArguments {
  DeviceDraft draft;
  std::string out;
  bool no_questions = false;
};

std::string lengthsQuestion(const std::string& kind) {
  if (kind == "phantom") return "Lengths of upper arm and forearm [m], separated by commas [0.2, 0.2]";
  if (kind == "delta") return "Lengths a, b, c, d, e, f, r, s [m], separated by commas [those of a Falcon]";
  return "Lengths of the links [m], one for each joint, separated by commas [0.2 each]";
}

void askAll(const Command& command, DeviceDraft& draft) {
  Questions questions(command);
  const auto wrong = [&draft] { return device_draft::wrongIn(draft); };
  questions.ask("--bus", "Bus: hid, bulk (USB)", draft.bus, wrong);
  questions.ask("--id", "USB vendor and product, hexadecimal (lsusb prints them)", draft.id, wrong);
  if (draft.bus == "hid")
    questions.ask("--report-id", "HID report id: first byte of each report, 1 to 255; 0 if reports have none",
                  draft.report_id, wrong);
  questions.ask("--kind", "Mechanism: phantom (two links on a turning base), delta, chain (any serial arm)", draft.kind,
                wrong);
  if (draft.kind == "chain") questions.ask("--joints", "Joints", draft.joints, wrong);
  questions.askList("--lengths", lengthsQuestion(draft.kind), draft.lengths, wrong);
  if (draft.kind == "chain")
    questions.askList("--twists", "Twist alpha from each joint's axis to the next [rad], 0: parallel [all 0]",
                      draft.twists, wrong);
  questions.askList("--counts", "Encoder counts of one motor turn (four times its lines), or one for each joint [2000]",
                    draft.counts, wrong);
  questions.askList("--gear", "Motor turns of one joint turn, or one for each joint [10]", draft.gear, wrong);
  questions.ask("--bits", "Bits of a position in a report", draft.bits, wrong);
  questions.ask("--buttons", "Buttons", draft.buttons, wrong);
  questions.ask("--checksum",
                "Checksum of the arm's reports: none, sum, xor, or the name of a CRC, such as crc16-modbus",
                draft.checksum, wrong);
  questions.askList("--torque", "Largest torque of a joint [N m], or one for each [0.5]", draft.torque, wrong);
  questions.ask("--force", "Largest force at the tip, to begin with [N]", draft.force, wrong);
}

/// Prints what to do with the new file.
void printNextSteps(const DeviceDraft& draft, const std::string& file) {
  const std::string name = shellWord(file);
  std::printf(
      "%s\n\nthen, step by step (%s, \"A new arm, step by step\"):\n"
      "  hapticd check %s                       # after each change\n"
      "  hapticd device decode %s CAPTURE       # captured bytes as joint positions\n"
      "  hapticd device record %s               # what the arm sends, motors off\n"
      "  hapticd device twin %s                 # the same arm simulated, to try a scene without the real arm\n"
      "  hapticd device calibrate %s\n"
      "  hapticd run SCENE.yaml --device %s --view       # the arm in a page\n",
      file.c_str(), guide("devices.md").c_str(), name.c_str(), name.c_str(), name.c_str(), name.c_str(), name.c_str(),
      name.c_str());
  if (draft.isPlanar())
    std::printf(
        "\nnote: every axis of arm.dh is parallel, so the tip stays in a plane and feels no force across it\n"
        "  fix: if your arm is not flat, give its twists: --twists 1.5707963,0,0, or alpha in arm.dh\n");
}

int makeNew(const Command& command, NewDeviceArguments options) {
  DeviceDraft& draft = options.draft;
  if (!draft.isNameUsable())
    return fail(kBadInput, "\"" + draft.name + "\" is not a valid name of a device, expected letters, digits, _ and -");
  const fs::path file = options.out.empty() ? fs::path(draft.name + ".yaml") : fs::path(options.out);
  std::error_code error;
  if (fs::exists(file, error))
    return fail(kBadInput, file.string() + " exists already, expected the name of a new file");
  if (!options.no_questions && isatty(STDIN_FILENO) != 0) askAll(command, draft);
  if (const std::string wrong = device_draft::wrongIn(draft); !wrong.empty()) return fail(kBadInput, wrong);
  std::ofstream out(file);
  out << deviceFileOf(draft) << std::flush;
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
    return fail(kFailed, name +
                             " is written, but cannot be used yet\n  fix: correct these problems, then hapticd check " +
                             shellWord(name) + "; to begin anew with other options: rm " + shellWord(name));
  printNextSteps(draft, name);
  return kWorked;
}

}  // namespace

void addDeviceNew(const Command& app, int& exit_code) {
  auto options = std::make_shared<NewDeviceArguments>();
  DeviceDraft& draft = options->draft;
  const Command command = app.subcommand("device").addSubcommand(
      "new", "Write a commented device file to start from; asks on a terminal for what no option gives.");
  command.addOption("name", draft.name, "name of the arm: letters, digits, _ and -").required();
  command.addOption("-o,--out", options->out, "file to write; default: NAME.yaml in the current folder");
  command.addOption("--bus", draft.bus, "hid or bulk, both USB").showDefault();
  command.addOption("--id", draft.id, "USB vendor:product, hexadecimal").showDefault();
  command.addOption("--kind", draft.kind, "phantom, delta or chain").showDefault();
  command.addOption("--joints", draft.joints, "number of joints of a chain").showDefault().wholeWithin(1, 16);
  const auto list = [command](const char* option, std::vector<double>& numbers, const char* doc) {
    command.addOption(option, numbers, doc).delimiter(',').oneValueEach();
  };
  list("--lengths", draft.lengths, "link lengths [m], separated by commas");
  list("--twists", draft.twists, "for a chain: angle alpha from each joint's axis to the next [rad]; default: 0");
  list("--counts", draft.counts, "encoder counts of one motor turn, or one for each joint; default: 2000");
  list("--gear", draft.gear, "motor turns of one joint turn, or one for each joint; default: 10");
  command.addOption("--bits", draft.bits, "bits of a position in a report").showDefault();
  command.addOption("--report-id", draft.report_id, "HID report id; 0: reports have none")
      .showDefault()
      .wholeWithin(0, 255);
  command
      .addOption("--checksum", draft.checksum,
                 "checksum of the arm's reports: none, sum, xor, or the name of a CRC, such as crc16-modbus")
      .showDefault();
  command.addOption("--buttons", draft.buttons, "buttons").showDefault().wholeWithin(0, 32);
  list("--torque", draft.torque, "largest torque of a joint [N m], or one for each; default: 0.5");
  command.addOption("--force", draft.force, "limit of the force at the tip [N]").showDefault();
  command.addFlag("--no-questions", options->no_questions, "ask nothing, take the defaults");
  command.footer(
      "The file is checked as soon as it is written. Every number in it is a guess until you have measured it.\n\n"
      "Examples:\n  hapticd device new my-arm\n"
      "  hapticd device new my-arm --kind phantom --id 16c0:0486 "
      "--lengths 0.21,0.17 --counts 4000 --gear 9.5 --bits 24");
  command.callback([command, options, &exit_code] { exit_code = makeNew(command, *options); });
}

}  // namespace hapticd::cli

// SPDX-License-Identifier: MIT
#include "diagnostics/machine/arm_checks.hpp"

#include <filesystem>
#include <fstream>
#include <optional>
#include <string_view>

#include "base/shell_word.hpp"
#include "diagnostics/device/arm_controls.hpp"
#include "host/catalog.hpp"

namespace hapticd::diagnostics {
namespace {

namespace fs = std::filesystem;

/// Checks what happens to the force of one arm when the daemon has gone.
Finding silenced(const ArmControls& found, const std::string& file) {
  if (found.watchdog)
    return {found.arm, Verdict::kOk,
            "its hardware switches the motors off when commands stop" +
                std::string(found.opened ? "" : ", as its file says (wire.watchdog)"),
            "", ""};
  if (found.silenced_after_us)
    return {found.arm, Verdict::kWarn,
            "a guard process switches its motors off when the daemon is gone or stands still; nothing does when the "
            "machine itself stops",
            "when the kernel hangs, the power fails or its cable is pulled, it may hold the last force",
            "give wire.watchdog if its hardware has one; else keep a switch of its power within reach"};
  return {found.arm, Verdict::kWarn,
          std::string("nothing is known that switches its motors off when the daemon is gone") +
              (found.opened ? "" : "; the arm is not plugged in, so it could not be asked"),
          "after SIGKILL, or when the machine dies, it may hold the last force",
          "keep a switch of its power within reach; all of its controls: hapticd device controls " + shellWord(file)};
}

/// Returns the fix that a module names in a message, or that of an arm that is not there.
std::string fixOf(const std::string& message) {
  constexpr std::string_view kFix = "fix: ";
  const size_t at = message.find(kFix);
  if (at == std::string::npos) return "plug it in and switch it on; hapticd device list shows what is on the buses";
  const size_t begin = at + kFix.size();
  return message.substr(begin, message.find('\n', begin) - begin);
}

/// Returns a warning if the arm could not be opened. An absent arm is not a fault of the machine, but nothing about it
/// was tested.
std::optional<Finding> missing(const ArmControls& found) {
  if (found.opened) return std::nullopt;
  constexpr std::string_view kRefused = "cannot be opened: ";  // a refusal of a module begins with the arm and this
  const std::string line = found.why.substr(0, found.why.find('\n'));
  const size_t told = line.find(kRefused);
  const std::string what = told == line.npos ? std::string(kRefused) + line : line.substr(told);
  return Finding{found.arm, Verdict::kWarn, what,
                 "what follows is what its file says; nothing of the arm itself was tried", fixOf(found.why)};
}

std::string lowerCase(std::string text) {
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return text;
}

/// Returns true if a line of an installed udev rule has both numbers. Rule files that sort after 73 do not count,
/// because they come too late to give access to the person at the seat.
bool hasRule(const std::string& vendor, const std::string& product) {
  for (const char* dir : kUdevFolders) {
    std::error_code code;
    for (const auto& file : fs::directory_iterator(dir, code)) {
      if (file.path().extension() != ".rules" || file.path().filename().string() >= "73") continue;
      std::ifstream in(file.path());
      for (std::string line; std::getline(in, line);)
        if (line.find("\"" + vendor + "\"") != std::string::npos &&
            line.find("\"" + product + "\"") != std::string::npos)
          return true;
    }
  }
  return false;
}

std::optional<Finding> withoutRule(const ArmControls& found, const std::string& file) {
  const size_t colon = found.usb_id.find(':');
  if (colon == std::string::npos) return std::nullopt;
  if (hasRule(lowerCase(found.usb_id.substr(0, colon)), lowerCase(found.usb_id.substr(colon + 1)))) return std::nullopt;
  const auto generator = host::ownFile("share/hapticd/generate-rules", "udev/generate-rules");
  return Finding{
      found.arm, Verdict::kWarn, "no installed udev rule names its id " + found.usb_id, "only root can open it",
      (generator ? shellWord(generator->string()) : "in the folder of hapticd's sources: udev/generate-rules") + " " +
          shellWord(fs::absolute(file).string()) + " | sudo tee " +
          shellWord("/etc/udev/rules.d/70-" + fs::path(file).stem().string() + ".rules") +
          " && sudo udevadm control --reload && sudo udevadm trigger"};
}

std::optional<Finding> repeats(const ArmControls& found, const std::string& file) {
  if (!found.repeats_pass) return std::nullopt;
  return Finding{
      found.arm, Verdict::kWarn, "its reports have no counter and no time",
      "firmware that hangs and sends its last report for ever is not noticed",
      "let the firmware count its reports (is: counter); all controls: hapticd device controls " + shellWord(file)};
}

std::optional<Finding> pushesLess(const ArmControls& found) {
  if (found.slow.empty()) return std::nullopt;
  return Finding{found.arm, Verdict::kWarn, found.slow, "stiff models feel softer than their stiffness",
                 "let it send its samples more often, and give that as wire.rate"};
}

}  // namespace

std::vector<Finding> checkArm(const std::string& file, host::Catalog& catalog) {
  document::Problems problems;
  const auto found = controlsOfFile(file, catalog, problems);
  if (!found)
    return {{file, Verdict::kFail, problems.empty() ? "cannot be used" : problems.front().text(),
             "no run opens this arm",
             "correct that; hapticd check " + shellWord(file) + " shows every problem of the file and its module"}};
  std::vector<Finding> findings;
  for (const std::string& doubt : found->doubts)
    findings.push_back({found->arm, Verdict::kWarn, doubt, "forces or simulated hands may go wrong",
                        "correct its module; hapticd device check " + shellWord(file) + " examines all of it"});
  if (found->simulated) {
    findings.push_back({found->arm, Verdict::kOk, "a simulated arm has no motors", "", ""});
    return findings;
  }
  for (const auto& one : {missing(*found), withoutRule(*found, file)})
    if (one) findings.push_back(*one);
  findings.push_back(silenced(*found, file));
  for (const auto& one : {pushesLess(*found), repeats(*found, file)})
    if (one) findings.push_back(*one);
  return findings;
}

}  // namespace hapticd::diagnostics

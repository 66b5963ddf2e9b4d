// SPDX-License-Identifier: MIT
#include "diagnostics/device/device_trial.hpp"

#include <algorithm>
#include <cctype>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/shell_word.hpp"
#include "diagnostics/device/arm_table.hpp"
#include "diagnostics/device/corrected_keys.hpp"
#include "diagnostics/device/decimal_commas.hpp"
#include "diagnostics/device/enable_button.hpp"
#include "diagnostics/device/unit_warnings.hpp"
#include "document/node.hpp"
#include "host/call_trail.hpp"
#include "host/device_instance.hpp"
#include "host/kinematics_check.hpp"
#include "scene/device_draft.hpp"

namespace hapticd::diagnostics {
namespace {

using document::Node;

/// Returns the node of a path such as "wire.input.fields[3].at", or the last node on this path that exists.
/// @param to_key returns the key itself if the path ends in one, not its value
const Node* walk(const Node* at, const std::string& path, bool to_key) {
  for (size_t i = 0; i < path.size();) {
    const size_t end = std::min(path.find_first_of(".[", i + 1), path.size());
    const Node* next = nullptr;
    if (path[i] == '[') {
      const size_t index = std::strtoul(path.c_str() + i + 1, nullptr, 10);
      if (at->isSequence() && index < at->items.size()) next = &at->items[index];
    } else {
      const std::string key = path.substr(path[i] == '.' ? i + 1 : i, end - i - (path[i] == '.' ? 1 : 0));
      for (const document::Entry& entry : at->entries)
        if (entry.key.scalar == key && next == nullptr) next = to_key && end == path.size() ? &entry.key : &entry.value;
    }
    if (next == nullptr) return at;
    at = next;
    i = end;
  }
  return at;
}

/// Returns the key in a message such as "NAME: wire.rate: ...", and where it begins; "" if there is none.
std::string keyIn(const std::string& message, const Node& parameters, size_t& begin) {
  for (begin = 0; begin < message.size();) {
    const size_t end = message.find(": ", begin);
    if (end == std::string::npos) break;
    const std::string key = message.substr(begin, end - begin);
    if (parameters.find(key.substr(0, key.find_first_of(".["))) != nullptr) return key;
    begin = end + 2;
  }
  begin = 0;
  return "";
}

/// Returns true for a message about a value that the module did not get, because it was wrong or missing.
bool follows(const std::string& key, const document::Problems& known) {
  if (key.empty()) return !known.empty();
  return std::any_of(known.begin(), known.end(), [&](const document::Problem& problem) {
    const std::string above = problem.key, all = "parameters." + key;
    const bool inside = above.rfind(all, 0) == 0 || all.rfind(above, 0) == 0;
    return inside && above.size() > std::string("parameters").size();
  });
}

/// Splits the message of a module, which has one line for each thing that is wrong.
std::vector<std::string> linesOf(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

/// The beginning of messages of DeviceInstance about the module itself, not about its parameters.
constexpr const char* kOfModule = "module '";

/// Reports an error of the module itself at the place where the file names the module, because it names no key of the
/// file.
void placeAtModule(const std::string& error, const Node& root, const std::string& file, document::Problems& problems) {
  const Node* module = root.find("module");
  const Node& at = module != nullptr ? *module : root;
  for (const std::string& line : linesOf(error)) document::report(problems, file, at.line, at.column, "module", line);
}

/// Returns true for a message about a key, not about its value.
bool isOfKey(const std::string& what) {
  return what.starts_with("unknown key") || what.starts_with("belongs one level up");
}

/// Adds its line to each key whose value a message gives, as in "wire.input.size (line 12) is 62".
std::string withLines(const std::string& what, const Node& parameters) {
  const auto mayBeOfKey = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 ||
           std::string_view("_.[]").find(c) != std::string_view::npos;
  };
  std::string text;
  for (size_t begin = 0; begin < what.size();) {
    const auto from = what.begin() + static_cast<std::ptrdiff_t>(begin);
    const std::string word(from, std::max(std::find_if_not(from, what.end(), mayBeOfKey), from + 1));
    begin += word.size();
    text += word;
    const size_t point = word.rfind('.');
    if (point == std::string::npos || what.compare(begin, 4, " is ") != 0) continue;
    const Node* key = walk(&parameters, word, true);
    if (key->isScalar() && key->scalar == word.substr(point + 1)) text += " (line " + std::to_string(key->line) + ")";
  }
  return text;
}

/// Reports the messages of a module about its parameters, each with the line and column of its parameter in the file.
void placeComplaints(const std::string& error, const scene::Device& draft, const Node& root, const std::string& file,
                     const document::Problems& known, document::Problems& problems) {
  const Node& parameters = *root.find("parameters");
  for (const std::string& message : linesOf(error)) {
    size_t begin = 0;
    const std::string key = keyIn(message, parameters, begin);
    if (follows(key, known)) continue;
    if (key.empty() && message.find(kOfModule) != std::string::npos) {
      placeAtModule(message, root, file, problems);
      continue;
    }
    std::string what = key.empty() ? message : message.substr(begin + key.size() + 2);
    const Node* at = walk(&parameters, key, isOfKey(what));
    what = withLines(what, parameters);
    if (at->isSequence()) what += adviceOnCommas(draft, key, *at);
    document::report(problems, file, at->line, at->column, key.empty() ? "parameters" : "parameters." + key, what);
  }
}

/// The answer of the child process: "+" if it made the instance, then a line for each doubt; or "-" and the error.
constexpr char kMade = '+', kNotMade = '-';

std::string madeInChild(const scene::Device& device, host::ChildProgress& trail) {
  host::followCalls(&trail);
  const auto made = host::DeviceInstance::create(device, nullptr);
  if (!made) return kNotMade + made.error();
  std::string said(1, kMade);
  if (const std::string wrong = host::wrongInverse((*made)->kinematics(), (*made)->handle()); !wrong.empty())
    said += wrong + "\n";
  for (const std::string& doubt : host::doubtsAboutKinematics((*made)->kinematics(), (*made)->handle()))
    said += doubt + "\n";
  return said;
}

}  // namespace

/// Reports a doubt about the kinematics at the key of the device file that causes it, if it is known; otherwise at the
/// name of the module.
static void placeDoubt(const std::string& doubt, const Node& root, const std::string& file,
                       document::Problems& warnings) {
  if (const auto stuck = stuckJoint(root, file); stuck && doubt.find("inverse()") != std::string::npos)
    return warnings.push_back(*stuck);
  if (hasLimitsBeyondATurn(root) && doubt.find("inverse()") != std::string::npos) return;  // it follows from them
  const Node* parameters = root.find("parameters");
  const Node* arm = parameters != nullptr && parameters->isMap() ? parameters->find("arm") : nullptr;
  const Node* centers = arm != nullptr && arm->isMap() ? arm->find("centers") : nullptr;
  if (centers == nullptr || doubt.find("pull the tip down") == std::string::npos)
    return placeAtModule(doubt, root, file, warnings);
  document::report(
      warnings, file, centers->line, centers->column, "parameters.arm.centers",
      "with these the masses pull the tip up, so the motors would pull the arm down; expected [x, y, z] of "
      "each link, in m from its far end, in its frame: a link of 0.2 m has about -0.1 m along x");
}

ModuleTrial tryModule(const scene::Device& device) {
  constexpr int kLimitMs = 10'000;
  host::ChildProgress trail;
  const auto said = host::runInChild([&] { return madeInChild(device, trail); }, kLimitMs);
  if (!said) {
    const std::string call = trail.call();
    return {"its module '" + device.module + "' " + said.error() + (call.empty() ? "" : ", in " + call + "()") +
                "; correct it in " + device.library.filename().string() + "; hapticd device check " +
                shellWord(device.file.string()) + " tries every call",
            {}};
  }
  if (said->front() == kNotMade) return {said->substr(1), {}};
  return {"", linesOf(said->substr(1))};
}

document::Problems tryDevice(const std::filesystem::path& file, host::Catalog& catalog, const document::Problems& known,
                             document::Problems* warnings) {
  document::Problems problems;
  const auto draft = scene::deviceDraft(file, catalog);
  if (!draft) return problems;  // this is a scene, or its module is unknown
  const ModuleTrial trial = tryModule(*draft);
  document::Problems unread;  // not reported here, because the loader of the file reports them
  auto root = document::readFileOn(file, unread);
  if (!root) return problems;
  root = withCorrectedParameters(std::move(*root), *draft);
  const Node* parameters = root->find("parameters");
  checkEnableButton(withCorrectedWire(*root, *draft), file.string(), problems);
  checkHd(*root, file.string(), problems);
  if (parameters != nullptr && !trial.error.empty())
    placeComplaints(trial.error, *draft, *root, file.string(), known, problems);
  else if (!trial.error.empty() && known.empty())
    placeAtModule(trial.error, *root, file.string(), problems);
  for (const std::string& doubt : trial.doubts)
    if (warnings != nullptr && known.empty()) placeDoubt(doubt, *root, file.string(), *warnings);
  document::sortByPlace(problems);
  return problems;
}

}  // namespace hapticd::diagnostics

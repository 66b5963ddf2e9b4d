// SPDX-License-Identifier: MIT
#include "diagnostics/reading/number_slips.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "diagnostics/reading/far_limits.hpp"
#include "diagnostics/reading/given_values.hpp"
#include "document/table.hpp"

namespace hapticd::diagnostics {

using document::Node;

namespace {

/// Returns true for a number with a meaningless leading zero, such as "05" or "-0800".
bool idleZero(const std::string& text) {
  const size_t first = text.find_first_not_of("+-");
  return first != std::string::npos && first + 1 < text.size() && text[first] == '0' &&
         text.find_first_not_of("0123456789", first) == std::string::npos;
}

/// Returns true if a model of the scene stands far from the world's origin, too: it may be there for an arm.
bool hasFarModel(const Node& root) {
  const Node* models = root.find("models");
  return models != nullptr && std::any_of(models->items.begin(), models->items.end(), [](const Node& model) {
           return largest(numbersIn(find(model, {"pose", "position"}))) > kFar;
         });
}

}  // namespace

void warnOfZeros(const Node& root, const std::string& file, document::Problems& warnings) {
  if (root.isScalar() && !root.quoted && idleZero(root.scalar))
    document::report(warnings, file, root.line, root.column, "",
                     "\"" + root.scalar +
                         "\" begins with a zero: a comma separates numbers, and decimals have a point (0." +
                         root.scalar + " is one number, 0," + root.scalar + " is two)");
  for (const Node& item : root.items) warnOfZeros(item, file, warnings);
  for (const document::Entry& entry : root.entries) {
    const std::string& key = entry.key.scalar;
    const bool of_usb = key == "usb" || key == "vendor" || key == "product" || key == "vid" || key == "pid";
    if (!of_usb) warnOfZeros(entry.value, file, warnings);  // 0486 is a number of USB, and hexadecimal
  }
}

void warnOfMount(const Node* position, const std::string& key, const std::string& file, document::Problems& warnings) {
  const double most = largest(numbersIn(position));
  if (most <= kFar) return;
  document::report(
      warnings, file, position->line, position->column, key,
      fmt::format("the arm stands {:g} m from the world's origin, where scenes have their shapes; the value must be "
                  "in m: {:g} mm is {:g} m",
                  most, most, most / 1000));
}

void warnOfMounts(const Node& root, const std::string& file, document::Problems& warnings) {
  if (hasFarModel(root)) return;
  if (const Node* device = root.find("device"))
    warnOfMount(find(*device, {"mount", "position"}), "device.mount.position", file, warnings);
  const Node* devices = root.find("devices");
  const std::vector<const Node*> arms =
      devices != nullptr ? document::elementsOf(*devices) : std::vector<const Node*>{};
  for (size_t i = 0; i < arms.size(); ++i)
    warnOfMount(find(*arms[i], {"mount", "position"}), fmt::format("devices[{}].mount.position", i), file, warnings);
}

void warnOfTurn(const Node* orientation, const std::string& key, const std::string& file,
                document::Problems& warnings) {
  constexpr double kMost = 0.7;  // least last number; read as w, it means a turn of at most 91 degrees
  const std::vector<double> q = numbersIn(orientation);
  const bool read =
      orientation != nullptr && std::all_of(orientation->items.begin(), orientation->items.end(),
                                            [](const Node& item) { return document::toNumber(item.scalar); });
  if (!read || q.size() != 4 || q[0] != 0 || q[3] < kMost || (q[1] != 0 && q[2] != 0)) return;
  if (q[1] == 0 && q[2] == 0)
    return document::report(
        warnings, file, orientation->line, orientation->column, key,
        "the order is w, x, y, z, so this is a half turn about z; expected [1, 0, 0, 0] where no turn was meant; "
        "[0, 0, 0, -1] is the same half turn without this warning");
  document::report(
      warnings, file, orientation->line, orientation->column, key,
      fmt::format("the order is w, x, y, z, so this is a half turn about [{0:g}, {1:g}, {2:g}]; if it was written as "
                  "x, y, z, w, write [{2:g}, 0, {0:g}, {1:g}]; if not, reverse all signs",
                  q[1], q[2], q[3]));
}

void warnOfTurns(const Node& root, const std::string& file, document::Problems& warnings, const std::string& key) {
  for (const document::Entry& entry : root.entries) {
    const std::string path = key.empty() ? entry.key.scalar : key + "." + entry.key.scalar;
    if (entry.key.scalar == "orientation") warnOfTurn(&entry.value, path, file, warnings);
    warnOfTurns(entry.value, file, warnings, path);
  }
  for (size_t i = 0; i < root.items.size(); ++i)
    if (root.items[i].isMap()) warnOfTurns(root.items[i], file, warnings, fmt::format("{}[{}]", key, i));
}

}  // namespace hapticd::diagnostics

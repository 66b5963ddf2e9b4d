// SPDX-License-Identifier: MIT
#include "diagnostics/device/enable_button.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>

#include "diagnostics/reading/given_values.hpp"

namespace hapticd::diagnostics {
namespace {

using document::Node;

/// Returns the buttons of the reports, counted from 1; nothing if the file describes no reports, or gives a button a
/// number that no button has, because that one may be meant.
std::optional<std::set<int>> buttonsIn(const Node& root) {
  const Node* fields = find(root, {"parameters", "wire", "input", "fields"});
  if (fields == nullptr || !fields->isSequence()) return std::nullopt;
  std::set<int> buttons;
  for (const Node& field : fields->items) {
    const Node *is = find(field, {"is"}), *button = find(field, {"button"});
    if (is == nullptr || is->scalar != "button") continue;
    const double number = button != nullptr ? document::toNumber(button->scalar).value_or(0) : 0;
    if (!(number >= 1 && number <= 32)) return std::nullopt;
    buttons.insert(static_cast<int>(number));
  }
  return buttons;
}

/// Returns the number of joints in the fields of both reports; 0 if the file describes none.
int wiredJoints(const Node& root) {
  int most = 0;
  for (const char* report : {"input", "output"}) {
    const Node* fields = find(root, {"parameters", "wire", report, "fields"});
    if (fields == nullptr || !fields->isSequence()) continue;
    for (const Node& field : fields->items) {
      const Node* joint = find(field, {"joint"});
      const double number = joint != nullptr ? document::toNumber(joint->scalar).value_or(0) : 0;
      if (number >= 1 && number <= 16) most = std::max(most, static_cast<int>(number));
    }
  }
  return most;
}

/// Returns the whole number of a node, or -1.
int wholeOf(const Node& node) {
  const double number = node.isScalar() ? document::toNumber(node.scalar).value_or(-1) : -1;
  return number >= 0 && number <= 1000 ? static_cast<int>(number) : -1;
}

}  // namespace

std::string enableButtonText(int button) {
  return fmt::format("button {} (counted from 0; button: {} of a wire format)", button, button + 1);
}

void checkEnableButton(const Node& root, const std::string& file, document::Problems& problems) {
  const Node* button = find(root, {"limits", "enable", "button"});
  const double number = button == nullptr ? -1 : document::toNumber(button->scalar).value_or(-1);
  const auto buttons = buttonsIn(root);
  if (!(number >= 0 && number < 32) || !buttons || buttons->count(static_cast<int>(number) + 1) > 0) return;
  std::string expected;
  for (const int known : *buttons)
    expected += fmt::format("{}{} (button: {} there)", expected.empty() ? "" : " or ", known - 1, known);
  if (expected.empty()) expected = "a field {is: button, button: 1, ...} there, and 0 here";
  document::report(problems, file, button->line, button->column, "limits.enable.button",
                   fmt::format("wire.input has no button {:g} (counted from 0), so forces could never be enabled; in "
                               "wire.input, buttons count from 1; expected {}",
                               number, expected));
}

void checkHd(const Node& root, const std::string& file, document::Problems& problems) {
  const Node *joints = find(root, {"hd", "joints"}), *buttons = find(root, {"hd", "buttons"});
  const int count = wiredJoints(root);
  for (size_t i = 0; joints != nullptr && joints->isSequence() && count > 0 && i < joints->items.size(); ++i) {
    const Node& row = joints->items[i];
    if (!row.isSequence() || row.items.empty() || wholeOf(row.items[0]) < count || wholeOf(row.items[0]) > 15) continue;
    document::report(problems, file, row.items[0].line, row.items[0].column, fmt::format("hd.joints[{}][0]", i),
                     fmt::format("the arm has no joint {} (counted from 0): wire has {} joints, so expected 0 to {}",
                                 wholeOf(row.items[0]), count, count - 1));
  }
  const auto known = buttonsIn(root);
  const int most = known && !known->empty() ? *known->rbegin() : 0;
  for (size_t i = 0; buttons != nullptr && buttons->isSequence() && known && i < buttons->items.size(); ++i) {
    const Node& button = buttons->items[i];
    if (wholeOf(button) < most || wholeOf(button) > 31) continue;
    document::report(problems, file, button.line, button.column, fmt::format("hd.buttons[{}]", i),
                     fmt::format("the arm has no {}; ", enableButtonText(wholeOf(button))) +
                         (most == 0   ? "wire.input has no button: remove this one"
                          : most == 1 ? "expected 0, its only button"
                                      : fmt::format("expected 0 to {}", most - 1)));
  }
}

}  // namespace hapticd::diagnostics

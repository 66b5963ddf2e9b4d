// SPDX-License-Identifier: MIT
#include "diagnostics/enable_button.hpp"

#include <fmt/format.h>

#include <optional>
#include <set>

#include "diagnostics/node_path.hpp"

namespace hapticd::diagnostics {
namespace {

using document::Node;

/// Returns the buttons of the reports, counted from 1; nothing if the file describes no reports.
std::optional<std::set<int>> buttonsIn(const Node& root) {
  const Node* fields = find(root, {"parameters", "wire", "input", "fields"});
  if (fields == nullptr || !fields->isSequence()) return std::nullopt;
  std::set<int> buttons;
  for (const Node& field : fields->items) {
    const Node *is = find(field, {"is"}), *button = find(field, {"button"});
    if (is == nullptr || is->scalar != "button" || button == nullptr) continue;
    const double number = document::toNumber(button->scalar).value_or(0);
    if (number >= 1 && number <= 32) buttons.insert(static_cast<int>(number));
  }
  return buttons;
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

}  // namespace hapticd::diagnostics

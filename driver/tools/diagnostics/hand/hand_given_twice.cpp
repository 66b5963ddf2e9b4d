// SPDX-License-Identifier: MIT
#include "diagnostics/hand/hand_given_twice.hpp"

#include <fmt/format.h>

#include <string>
#include <vector>

#include "document/table.hpp"

namespace hapticd::diagnostics {
namespace {

void judge(const document::Node& device, const std::string& key, const document::Node& top, const std::string& file,
           document::Problems& warnings) {
  const document::Node* own = device.isMap() ? device.find("hand") : nullptr;
  if (own == nullptr || !own->isMap()) return;
  std::string both;
  for (const document::Entry& entry : own->entries)
    if (top.find(entry.key.scalar) != nullptr) both += (both.empty() ? "" : ", ") + entry.key.scalar;
  document::report(
      warnings, file, own->line, own->column, key + ".hand",
      fmt::format("the scene gives hand in line {}, too; {}, and the rest of both is joined; write one hand", top.line,
                  both.empty() ? "no key is in both" : "of the keys in both, these here hold: " + both));
  const document::Node* script = top.find("script");
  if (script == nullptr || script->scalar != "path" || own->find("script") == nullptr || top.find("path") != nullptr ||
      own->find("path") != nullptr)
    return;
  document::report(warnings, file, script->line, script->column, "hand.script",
                   fmt::format("is path, but no path names a file; and it has no effect, because the hand in line {} "
                               "gives a script, too",
                               own->line));
}

}  // namespace

void warnOfHandGivenTwice(const document::Node& root, const std::string& file, document::Problems& warnings) {
  const document::Node* top = root.isMap() ? root.find("hand") : nullptr;
  if (top == nullptr || !top->isMap()) return;
  if (const document::Node* device = root.find("device")) judge(*device, "device", *top, file, warnings);
  if (const document::Node* devices = root.find("devices")) {
    const std::vector<const document::Node*> elements = document::elementsOf(*devices);
    for (size_t i = 0; i < elements.size(); ++i)
      judge(*elements[i], fmt::format("devices[{}]", i), *top, file, warnings);
  }
}

}  // namespace hapticd::diagnostics

// SPDX-License-Identifier: MIT
#include "document.hpp"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <utility>

#include "document/correction.hpp"
#include "document/foreign_file.hpp"
#include "document/node.hpp"
#include "model_file.hpp"

namespace hapticd {
namespace {

using Json = nlohmann::json;
using document::Node;
constexpr std::size_t kMostProblems = 20;
// A tree needs about 250 times the size of its YAML text, or 20 times that of its JSON text. A part file needs only its
// own size.
constexpr std::size_t kMostYaml = 2u << 20, kMostJson = 32u << 20;

constexpr const char* kImport = "hapticd import";

[[noreturn]] void throwAll(const document::Problems& problems, std::vector<std::string> odd = {}) {
  std::string all;
  for (const document::Problem& problem : problems) all.append(all.empty() ? "" : "\n").append(problem.text());
  ModelFileError error(all);
  error.odd = std::move(odd);
  throw error;
}

[[noreturn]] void throwOne(const std::string& file, const std::string& what) {
  document::Problems problems;
  document::report(problems, file, 1, 1, "", what);
  throwAll(problems);
}

Json scalarOf(const Node& node) {
  if (node.quoted) return node.scalar;
  if (node.scalar == "true") return true;
  if (node.scalar == "false") return false;
  if (const auto number = document::toNumber(node.scalar)) return *number;
  return node.scalar;
}

Json treeOf(const Node& node) {
  switch (node.kind) {
    case Node::Kind::kScalar:
      return scalarOf(node);
    case Node::Kind::kSequence: {
      Json list = Json::array();
      for (const Node& item : node.items) list.push_back(treeOf(item));
      return list;
    }
    case Node::Kind::kMap: {
      Json map = Json::object();
      for (const document::Entry& entry : node.entries)  // of a key that is given twice, the first counts
        if (!map.contains(entry.key.scalar)) map[entry.key.scalar] = treeOf(entry.value);
      return map;
    }
    default:
      return nullptr;
  }
}

bool looksLikeJson(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  return first != std::string::npos && text[first] == '{';
}

/// Returns the value at `path`; if there is none, the innermost value on this path, and sets `is_there` to false.
const Node& nodeAt(const Node& root, const Path& path, bool& is_there) {
  const Node* node = &root;
  for (const PathStep& step : path) {
    const Node* inner = nullptr;
    if (!step.key.empty()) {
      inner = node->find(step.key);
    } else if (step.index < node->items.size()) {
      inner = &node->items[step.index];
    }
    if (inner == nullptr) {
      is_there = false;
      break;
    }
    node = inner;
  }
  return *node;
}

std::string nameOf(const Path& path) {
  std::string name;
  for (const PathStep& step : path) {
    if (step.key.empty()) {
      name.append("[").append(std::to_string(step.index)).append("]");
    } else {
      name.append(name.empty() ? "" : ".").append(step.key);
    }
  }
  return name;
}

}  // namespace

void Problems::add(const Path& path, const std::string& what) {
  if (!full()) found_.push_back({path, what});
}

bool Problems::full() const {
  return found_.size() >= kMostProblems;
}

namespace {

/// Returns the unit of a value of a model file, by the name of its key.
const char* unitOf(const Path& path) {
  constexpr std::pair<const char*, const char*> kUnits[] = {{"points", "m"},    {"vertices", "m"},    {"radius", "m"},
                                                            {"mass", "kg"},     {"stiffness", "N/m"}, {"young", "Pa"},
                                                            {"thickness", "m"}, {"damping", "N s/m"}};
  for (const PathStep& step : path)
    for (const auto& [key, unit] : kUnits)
      if (step.key == key) return unit;
  return "";
}

/// Returns the message with what the file gives before what was expected.
std::string withGiven(const Node& node, const Path& path, const std::string& what) {
  if (!what.starts_with("expected ") || node.isMap() || (node.isSequence() && node.items.empty())) return what;
  if (node.isSequence()) return "a list of " + std::to_string(node.items.size()) + ", " + what;
  const std::string hint =
      document::toNumber(node.scalar) && !node.quoted ? "" : document::suggestNumber(node.scalar, unitOf(path));
  return document::describe(node) + ", " + what + hint;
}

}  // namespace

document::Problems Problems::placed() const {
  document::Problems all = of_text_, unread;
  // empty for JSON that the YAML reader does not accept; then there are no positions
  const auto root = document::readOn(text_, file_, unread);
  for (const Problem& problem : found_) {
    document::Place place{file_, 1, 1};
    std::string what = problem.what;
    if (root) {
      bool is_there = true;
      const Node& node = nodeAt(*root, problem.path, is_there);
      place.line = node.line, place.column = node.column;
      if (is_there) what = withGiven(node, problem.path, what);
    }
    all.push_back({place, nameOf(problem.path), what});
  }
  document::dropFollowUps(all);
  document::sortByPlace(all);
  return all;
}

std::vector<std::string> Problems::texts() const {
  std::vector<std::string> all;
  if (!any()) return all;
  for (const document::Problem& problem : placed()) all.push_back(problem.text());
  return all;
}

bool Problems::about(const std::string& key) const {
  return std::any_of(found_.begin(), found_.end(), [&key](const Problem& problem) {
    return std::any_of(problem.path.begin(), problem.path.end(),
                       [&key](const PathStep& step) { return step.key == key; });
  });
}

void Problems::throwIfAny(std::vector<std::string> odd) const {
  if (any()) throwAll(placed(), std::move(odd));
}

std::string readModelText(const std::string& path) {
  document::Problems problems;
  auto text = document::readFile(path, kMostJson, problems);
  if (text) return *std::move(text);
  std::error_code error;
  const auto size = std::filesystem::file_size(path, error);
  if (error || size <= kMostJson) throwOne(path, problems.front().what);  // such as: Permission denied
  // To make a large file of another kind smaller would not help.
  if (const std::string foreign = document::foreignFile("", path); !foreign.empty()) throwOne(path, foreign);
  throwOne(path, problems.front().what +
                     "; expected a model file (format hapticd-model/1) of at most 32 MiB, or a part (.hpart), which " +
                     "may be larger: " + kImport);
}

Json parseDocument(const std::string& text, const std::string& file, Problems& problems) {
  if (looksLikeJson(text)) {
    Json json = Json::parse(text, nullptr, false);
    if (!json.is_discarded()) return json;
  }
  if (text.size() > kMostYaml)
    throwOne(
        file,
        std::string("is larger than 2 MiB, the most for YAML; write it as JSON (up to 32 MiB), or make a part file: ") +
            kImport);
  document::Problems of_text;
  const auto root = document::readOn(text, file, of_text);
  if (!root) throwAll(of_text);
  problems.add(of_text);
  return treeOf(*root);
}

}  // namespace hapticd

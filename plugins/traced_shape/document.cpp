// SPDX-License-Identifier: MIT
#include "document.hpp"

#include <yaml-cpp/yaml.h>

#include <charconv>
#include <filesystem>
#include <fstream>
#include <limits>

#include "model_file.hpp"

namespace hapticd {
namespace {

using Json = nlohmann::json;
constexpr std::size_t kMostProblems = 20;
// Every value takes a byte or more, so that only aliases make a tree larger than its text.
constexpr std::size_t kSpareNodes = 10'000;
constexpr int kDeepest = 64;
// A tree takes some 250 times the bytes of its YAML, and 20 times those of its JSON; a part file takes its own.
constexpr std::size_t kMostYaml = 2u << 20, kMostJson = 32u << 20;

constexpr const char* kPartWay = "hapticd import";

Json scalarOf(const YAML::Node& node) {
  const std::string& text = node.Scalar();
  if (node.Tag() == "!") return text;  // quoted
  if (text == ".nan" || text == ".NaN" || text == ".NAN") return std::numeric_limits<double>::quiet_NaN();
  if (text == ".inf" || text == "+.inf" || text == ".Inf") return std::numeric_limits<double>::infinity();
  if (text == "-.inf" || text == "-.Inf") return -std::numeric_limits<double>::infinity();
  if (text == "true") return true;
  if (text == "false") return false;
  const char *first = text.data(), *last = first + text.size();
  if (first != last && *first == '+') ++first;
  double value = 0;
  const auto [end, error] = std::from_chars(first, last, value);
  if (error == std::errc::result_out_of_range && end == last)
    return std::numeric_limits<double>::infinity();  // reported as not finite
  if (error == std::errc() && end == last && first != last && std::isalpha(static_cast<unsigned char>(*first)) == 0)
    return value;
  return text;
}

Json treeOf(const YAML::Node& node, std::size_t& left, int depth) {
  if (left-- == 0 || depth > kDeepest) throw YAML::ParserException(node.Mark(), "too large or too deep");
  switch (node.Type()) {
    case YAML::NodeType::Scalar:
      return scalarOf(node);
    case YAML::NodeType::Sequence: {
      Json list = Json::array();
      for (const YAML::Node& item : node) list.push_back(treeOf(item, left, depth + 1));
      return list;
    }
    case YAML::NodeType::Map: {
      Json map = Json::object();
      for (const auto& item : node) {
        if (!item.first.IsScalar()) throw YAML::ParserException(item.first.Mark(), "a key that is no text");
        if (map.contains(item.first.Scalar()))
          throw YAML::ParserException(item.first.Mark(), "key " + item.first.Scalar() + " appears twice");
        map[item.first.Scalar()] = treeOf(item.second, left, depth + 1);
      }
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

/// Where the value at `path` stands, or the nearest value around it.
YAML::Mark markOf(YAML::Node node, const Path& path) {
  YAML::Mark mark = node.Mark();
  for (const PathStep& step : path) {
    YAML::Node inner;
    if (node.IsMap() && !step.key.empty()) {
      inner.reset(node[step.key]);
    } else if (node.IsSequence() && step.index < node.size()) {
      inner.reset(node[step.index]);
    }
    if (!inner.IsDefined() || inner.Mark().is_null()) break;
    node.reset(inner);
    mark = node.Mark();
  }
  return mark;
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

std::string line(const std::string& file, int row, int column, const std::string& what) {
  std::string text = file;
  text.append(":").append(std::to_string(row)).append(":").append(std::to_string(column));
  return text.append(": ").append(what);
}

}  // namespace

void Problems::add(const Path& path, const std::string& what) {
  if (!full()) found_.push_back({path, what});
}

bool Problems::full() const {
  return found_.size() >= kMostProblems;
}

void Problems::throwIfAny() const {
  if (found_.empty()) return;
  YAML::Node root;
  try {
    root = YAML::Load(text_);
  } catch (const YAML::Exception&) {  // JSON that YAML does not read: no positions
  }
  std::string all;
  for (const Problem& problem : found_) {
    const YAML::Mark mark = root.IsDefined() ? markOf(root, problem.path) : YAML::Mark::null_mark();
    const std::string name = nameOf(problem.path);
    all.append(all.empty() ? "" : "\n");
    all.append(line(file_, mark.line + 1, mark.column + 1, name.empty() ? problem.what : name + ": " + problem.what));
  }
  throw ModelFileError(all);
}

std::string readModelText(const std::string& path) {
  std::error_code unknown;
  if (std::filesystem::exists(path, unknown) && !std::filesystem::is_regular_file(path, unknown))  // a pipe would wait
    throw ModelFileError(path + ":1:1: not a regular file, expected a model file");
  std::ifstream in(path, std::ios::binary | std::ios::ate);
  if (!in) throw ModelFileError(path + ":1:1: cannot be read, expected a model file (format hapticd-model/1)");
  const std::streamoff size = in.tellg();
  if (size < 0 || static_cast<std::size_t>(size) > kMostJson)
    throw ModelFileError(path +
                         ":1:1: larger than 32 MiB, expected a model file; for more, make a part file: " + kPartWay);
  std::string text(static_cast<std::size_t>(size), '\0');
  in.seekg(0);
  in.read(text.data(), size);
  if (!in) throw ModelFileError(path + ":1:1: cannot be read, expected a model file (format hapticd-model/1)");
  return text;
}

Json parseDocument(const std::string& text, const std::string& file) {
  if (looksLikeJson(text)) {
    Json json = Json::parse(text, nullptr, false);
    if (!json.is_discarded()) return json;
  }
  if (text.size() > kMostYaml)
    throw ModelFileError(file +
                         ":1:1: larger than 2 MiB as YAML; give it as JSON (32 MiB), or as a part file: " + kPartWay);
  try {
    std::size_t left = text.size() + kSpareNodes;
    return treeOf(YAML::Load(text), left, 0);
  } catch (const YAML::Exception& e) {
    throw ModelFileError(line(file, e.mark.line + 1, e.mark.column + 1, "not YAML or JSON: " + e.msg));
  }
}

}  // namespace hapticd

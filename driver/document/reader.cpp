// SPDX-License-Identifier: MIT
#include "document/reader.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "base/nearest_word.hpp"
#include "base/passed_files.hpp"
#include "base/regular_file.hpp"
#include "document/absent_file.hpp"
#include "document/correction.hpp"
#include "document/suggestion.hpp"
#include "document/table.hpp"

namespace hapticd::document {
namespace {

/// Allowed error of a quaternion's length. It is large, because people write few digits.
constexpr double kUnitTolerance = 1e-3;
constexpr size_t kLongestName = 100;

std::string wordOf(const Node& node) {
  return node.isScalar() && !node.quoted ? node.scalar : "";
}

}  // namespace

std::string numberText(double value) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

std::string expectedOf(const Range& range) {
  const std::string unit = range.unit[0] != '\0' ? std::string(" ") + range.unit : "";
  const bool low = range.min > -1e300, high = range.max < 1e300;
  if (range.min == range.max) return numberText(range.min) + unit;
  if (low && high) return numberText(range.min) + " to " + numberText(range.max) + unit;
  if (low) return numberText(range.min) + unit + " or more";
  if (high) return numberText(range.max) + unit + " or less";
  return "a number" + (unit.empty() ? "" : " in" + unit);
}

std::string joined(const std::string& parent, const std::string& key) {
  return parent.empty() ? key : parent + "." + key;
}

bool normalise(Eigen::Quaterniond& q) {
  const double length = q.norm();
  if (!(std::abs(length - 1) <= kUnitTolerance)) return false;
  q.coeffs() /= length;
  return true;
}

std::optional<double> Reader::number(const Node& node, const std::string& key, const Range& range) {
  const std::optional<double> value = node.isScalar() && !node.quoted ? toNumber(node.scalar) : std::nullopt;
  if (!value) {
    problem(node, key,
            describe(node) + " is not a number, expected " + expectedOf(range) +
                (node.isScalar() ? suggestNumber(node.scalar, range.unit) : ""));
  } else if (!std::isfinite(*value)) {
    problem(node, key, node.scalar + " is not finite, expected " + expectedOf(range));
  } else if (*value < range.min || *value > range.max) {
    const std::string unit = range.unit[0] != '\0' ? std::string(" ") + range.unit : "";
    problem(node, key,
            node.scalar + unit + " is out of range, expected " + expectedOf(range) +
                suggestOtherUnit(*value, {range.min, range.max}, range.unit).advice);
  } else {
    return value;
  }
  return std::nullopt;
}

std::optional<double> Reader::whole(const Node& node, const std::string& key, const Range& range) {
  const std::optional<double> value = number(node, key, range);
  if (!value || *value == std::floor(*value)) return value;
  problem(node, key, node.scalar + " is not a whole number, expected " + expectedOf(range));
  return std::nullopt;
}

std::optional<bool> Reader::boolean(const Node& node, const std::string& key) {
  const std::string word = wordOf(node);
  if (word == "true" || word == "yes" || word == "on") return true;
  if (word == "false" || word == "no" || word == "off") return false;
  problem(node, key, describe(node) + " is neither true nor false, expected true or false");
  return std::nullopt;
}

std::optional<size_t> Reader::choice(const Node& node, const std::string& key, std::span<const std::string> choices) {
  for (size_t i = 0; node.isScalar() && i < choices.size(); ++i)
    if (node.scalar == choices[i]) return i;
  const std::vector<std::string> all(choices.begin(), choices.end());
  const bool word = node.isScalar() && !toNumber(node.scalar);  // a number is not a misspelt choice
  const std::string meant = word ? suggestion(node.scalar, all) : "";
  problem(node, key,
          describe(node) + " is an invalid value, expected one of " +
              listedFor(node.isScalar() ? node.scalar : "", all, 40) + meant);
  return std::nullopt;
}

std::optional<std::string> Reader::text(const Node& node, const std::string& key) {
  if (node.isScalar()) return node.scalar;
  problem(node, key, describe(node) + ", expected a text");
  return std::nullopt;
}

std::optional<std::string> Reader::name(const Node& node, const std::string& key) {
  std::optional<std::string> given = text(node, key);
  if (!given) return std::nullopt;
  bool good = !given->empty() && given->size() <= kLongestName && given->front() != ' ' && given->back() != ' ';
  for (const char c : *given) good = good && static_cast<unsigned char>(c) >= 0x20 && c != ',' && c != '"' && c != 0x7f;
  if (good) return given;
  problem(node, key,
          describe(node) + " is not a valid name, expected 1 to " + std::to_string(kLongestName) +
              " characters without commas, quotes, or blanks at the ends");
  return std::nullopt;
}

std::optional<std::filesystem::path> Reader::existingFile(const Node& node, const std::string& key) {
  if (!node.isScalar() || node.scalar.empty()) {
    problem(node, key, describe(node) + ", expected the path of a file");
    return std::nullopt;
  }
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::path written(node.scalar);
  fs::path full = fs::absolute(file_.parent_path() / written, error).lexically_normal();
  const auto where = whereToOpen(full.string());
  if (!where) {
    problem(node, key, full.string() + " " + where.error());
    return std::nullopt;
  }
  if (const fs::file_status status = fs::status(*where, error); fs::exists(status)) {
    const std::string other = notAFile(status.type());
    if (other.empty()) return full;
    problem(node, key, full.string() + " " + other);
  } else {
    problem(node, key,
            "there is no file " + full.string() + ", expected the path of a file" +
                (written.is_absolute() ? "" : ", relative to the file that names it") +
                (toNumber(node.scalar) ? "" : neighbourMeant(full, file_)) + suggestPath(node.scalar));
  }
  return std::nullopt;
}

std::optional<Eigen::Vector3d> Reader::vector3(const Node& node, const std::string& key, const Range& range) {
  if (!node.isSequence() || node.items.size() != 3) {
    problem(node, key,
            (node.isSequence() ? "a list of " + std::to_string(node.items.size()) : describe(node)) +
                ", expected a list of 3 numbers, " + expectedOf(range) + suggestList(node, 3));
    return std::nullopt;
  }
  Eigen::Vector3d v;
  bool good = true;
  for (int i = 0; i < 3; ++i) {
    const auto value = number(node.items[static_cast<size_t>(i)], key + "[" + std::to_string(i) + "]", range);
    good = good && value;
    v[i] = value.value_or(0);
  }
  return good ? std::optional(v) : std::nullopt;
}

/// Returns a quaternion as a file gives it: [w, x, y, z].
static std::string listText(const Eigen::Quaterniond& q) {
  const auto part = [](double x) { return numberText(std::round(x * 1e7) / 1e7 + 0.0); };
  return "[" + part(q.w()) + ", " + part(q.x()) + ", " + part(q.y()) + ", " + part(q.z()) + "]";
}

/// Returns the rotation that was probably meant by a quaternion of another length, or "" if it is 0.
static std::string nearestRotation(const Eigen::Quaterniond& q) {
  return q.norm() > 1e-6 ? "; with length 1 it is " + listText(q.normalized()) : "";
}

/// Returns the quaternion of a mapping with axis and angle, as a hint; "" if the node is none.
static std::string turnOf(const Node& node) {
  const Node *axis = node.isMap() ? node.find("axis") : nullptr, *angle = node.isMap() ? node.find("angle") : nullptr;
  if (axis == nullptr || angle == nullptr || !axis->isSequence() || axis->items.size() != 3) return "";
  Eigen::Vector3d v;
  for (size_t i = 0; i < 3; ++i) v[static_cast<int>(i)] = toNumber(axis->items[i].scalar).value_or(0);
  const double given = toNumber(angle->scalar).value_or(0);
  if (!(v.norm() > 0) || !v.allFinite() || !std::isfinite(given)) return "";
  const bool degrees = std::abs(given) > 2 * M_PI;
  const Eigen::Quaterniond q(Eigen::AngleAxisd(degrees ? given * M_PI / 180 : given, v.normalized()));
  return numberText(given) + (degrees ? " degrees" : " rad") + " about this axis are " + listText(q);
}

std::optional<Eigen::Quaterniond> Reader::quaternion(const Node& node, const std::string& key) {
  constexpr const char* kNoDegrees =
      "expected a unit quaternion [w, x, y, z]; 90 degrees about y are [0.7071068, 0, 0.7071068, 0]";
  if (const std::string turn = turnOf(node); !turn.empty()) {
    problem(node, key, describe(node) + ", expected a unit quaternion [w, x, y, z]; " + turn);
    return std::nullopt;
  }
  if (!node.isSequence() || node.items.size() != 4) {
    problem(
        node, key,
        (node.isSequence() ? "a list of " + std::to_string(node.items.size()) : describe(node)) + ", " + kNoDegrees);
    return std::nullopt;
  }
  for (const Node& item : node.items)
    if (const auto value = toNumber(item.scalar);
        item.isScalar() && value && std::isfinite(*value) && std::abs(*value) > 2) {
      problem(item, key, item.scalar + " does not belong to a rotation, " + kNoDegrees);
      return std::nullopt;
    }
  std::array<double, 4> v{};
  for (size_t i = 0; i < 4; ++i) {
    const auto value = number(node.items[i], key + "[" + std::to_string(i) + "]", {-2, 2});
    if (!value) return std::nullopt;
    v[i] = *value;
  }
  Eigen::Quaterniond q(v[0], v[1], v[2], v[3]);
  if (normalise(q)) return q;
  problem(node, key,
          "the quaternion has length " + numberText(q.norm()) + ", expected 1 within 0.001 (order w, x, y, z)" +
              nearestRotation(q));
  return std::nullopt;
}

namespace {

/// Returns the path of a key in a table and the tables within, such as "limits.force"; "" if it is not there.
std::string pathIn(const Table& table, const std::string& name) {
  if (table.find(name) != nullptr) return name;
  for (const Key& key : table.keys)
    if (const std::string path = key.type == Type::kObject ? pathIn(*key.table, name) : ""; !path.empty())
      return key.name + ("." + path);
  return "";
}

/// Returns the path without its last key; "" if it has only one.
std::string parentOf(const std::string& path) {
  return path.substr(0, path.find('.') == path.npos ? 0 : path.rfind('.'));
}

/// Returns a hint where an unknown key belongs: under another key, in another file, or under `parameters`; else "".
/// @param near true if a key of this table has a similar name, so that the key is probably misspelt: then keys within
/// the mappings of other tables are not suggested
std::string belongsTo(const Table& table, const std::string& name, bool near) {
  if (const std::string path = pathIn(table, name); !path.empty())
    return "; " + name + " belongs under the key " + parentOf(path);
  const bool may_be_parameter = table.find("parameters") != nullptr;
  const std::string parameter = "; a parameter of the plugin or module belongs under parameters";
  std::string there;
  for (const Elsewhere& other : table.elsewhere) {
    const std::string path = pathIn(*other.table, name), parent = parentOf(path);
    if (path.empty() || (!parent.empty() && (near || !there.empty()))) continue;
    there += there.empty() ? "; " + name + " belongs in " + other.where : ", or in " + std::string(other.where);
    if (parent.empty()) continue;
    there += ", under " + parent;
    return may_be_parameter ? parameter + there : there;
  }
  return there.empty() && may_be_parameter ? parameter : there;
}

/// Returns true if a key of exactly this name belongs in another place. @param place the hint of belongsTo()
bool hasAnotherPlace(const std::string& place, const std::string& name) {
  return place.find(" " + name + " belongs ") != place.npos;
}

/// Returns a hint if the value of an unknown key has only keys of this table, which then stand one level too deep.
std::string tooDeep(const Table& table, const Node& value) {
  const bool all = value.isMap() && !value.entries.empty() &&
                   std::all_of(value.entries.begin(), value.entries.end(),
                               [&table](const Entry& one) { return table.find(one.key.scalar) != nullptr; });
  return all ? "; its keys (" + value.entries[0].key.scalar + ", ...) belong one level up, without this key" : "";
}

/// Returns the key of the table that a misspelt key probably stands for. Returns nullptr if there is none, if that key
/// is given as well, or if the word as it is spelt belongs in another place.
const Key* meantKey(const Node& node, const Entry& entry, const Table& table) {
  const std::string& name = entry.key.scalar;
  const std::string meant = nearestWord(name, table.names());
  if (meant.empty() || entry.value.isNull() || node.find(meant) != nullptr) return nullptr;
  return hasAnotherPlace(belongsTo(table, name, true), name) ? nullptr : table.find(meant);
}

/// Returns a hint about an unknown key: how it is spelt, or where it or its value belongs.
/// @param empty a key without a value before it, under which it may belong; nullptr if there is none
std::string hintAbout(const Entry& entry, const Table& table, const std::string* empty) {
  const std::string &name = entry.key.scalar, meant = suggestion(name, table.names());
  if (empty != nullptr) return meant + "; indent it further than " + *empty + ", if it belongs there";
  const std::string place = belongsTo(table, name, !meant.empty());
  return (hasAnotherPlace(place, name) ? "" : meant) + place + tooDeep(table, entry.value);
}

/// Returns the key of this name in the mappings of a table; nullptr if there is none.
const Key* keyWithin(const Table& table, const std::string& name) {
  for (const Key& key : table.keys) {
    if (key.type != Type::kObject) continue;
    if (const Key* known = key.table->find(name)) return known;
    if (const Key* known = keyWithin(*key.table, name)) return known;
  }
  return nullptr;
}

}  // namespace

void Reader::judge(const Node& node, const std::string& path, const Key* key) {
  if (key == nullptr || node.isNull()) return;
  if (key->type == Type::kReal) number(node, path, key->range);
  if (key->type == Type::kInteger) whole(node, path, key->range);
  if (key->type == Type::kBool) boolean(node, path);
  if (key->type == Type::kChoice) choice(node, path, detail::texts(key->choices));
  if (key->type == Type::kVector3) vector3(node, path, key->range);
  if (key->type == Type::kQuaternion) quaternion(node, path);
}

void Reader::object(const Node& node, const std::string& key, const Table& table, void* object) {
  if (!node.isMap()) {
    problem(node, key, describe(node) + ", expected a mapping with " + listed(table.names()) + suggestMapping(node));
    return;
  }
  std::vector<const Key*> misspelt;    // keys that were given misspelt: their values are checked too
  const std::string* empty = nullptr;  // a key without a value: unknown keys after it probably belong under it
  for (const Entry& entry : node.entries) {
    const std::string path = joined(key, entry.key.scalar);
    if (const Key* known = table.find(entry.key.scalar)) {
      empty = entry.value.isNull() ? &entry.key.scalar : nullptr;
      if (empty != nullptr)
        problem(entry.key, path, std::string("no value given, expected ") + known->expected());
      else
        known->store(*this, entry.value, path, *known, object);
    } else {
      problem(entry.key, path,
              "unknown key, expected one of " + listedFor(entry.key.scalar, table.names(), 20) +
                  hintAbout(entry, table, empty),
              ProblemKind::kUnknownKey);
      const Key* meant = empty == nullptr ? meantKey(node, entry, table) : nullptr;
      if (meant == nullptr) judge(entry.value, path, keyWithin(table, entry.key.scalar));
      if (meant == nullptr || meant->store == nullptr) continue;
      if (std::find(misspelt.begin(), misspelt.end(), meant) != misspelt.end()) continue;
      misspelt.push_back(meant);
      meant->store(*this, entry.value, path, *meant, object);
    }
  }
  for (const Key& wanted : table.keys)
    if (wanted.required && node.find(wanted.name) == nullptr &&
        std::find(misspelt.begin(), misspelt.end(), &wanted) == misspelt.end())
      problem(node, joined(key, wanted.name),
              "missing, expected " + wanted.expected() + (wanted.type == Type::kList ? "; [] for none" : ""));
}

}  // namespace hapticd::document

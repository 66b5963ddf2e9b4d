// SPDX-License-Identifier: MIT
#include "codec/tree.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <vector>

#include "base/nearest_word.hpp"
#include "document/correction.hpp"
#include "document/json_text.hpp"
#include "document/suggestion.hpp"

namespace hapticd::codec {
namespace {

using Json = nlohmann::ordered_json;

const Json& jsonOf(const void* value) {
  return *static_cast<const Json*>(value);
}

std::string shortText(double number) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", number);
  return text;
}

/// Returns a value as messages show it.
std::string shown(const Json& value) {
  constexpr size_t kLongest = 40;
  std::string text = document::jsonLine(value);
  if (text.size() > kLongest) text = text.substr(0, kLongest) + "...";
  return text;
}

/// Returns the number that a text with hexadecimal digits, such as 7e, probably means; NaN if it is no such text.
double suggestHex(const std::string& text, double least, double most) {
  const bool hex =
      text.size() >= 2 && text.size() <= 8 && text.find_first_not_of("0123456789abcdefABCDEF") == std::string::npos;
  const double value = hex ? static_cast<double>(std::strtoul(text.c_str(), nullptr, 16)) : std::nan("");
  return value >= least && value <= most ? value : std::nan("");
}

}  // namespace

/// A value that is read for a key that a mapping lacks.
struct Tree::Instead {
  const void* mapping;
  std::string key, path;  ///< path of the key that is meant
  const void* value;      ///< nullptr if nothing is given there
  std::string written;    ///< path of the value in the file
};

struct Document::Data {
  Json json;
  std::string name;
  std::vector<std::string> problems;
  std::vector<Tree::Instead> instead;
};

Document::Document(const std::string& json, std::string name) : data_(new Data{Json(), std::move(name), {}, {}}) {
  data_->json = document::parseJson(json);
  if (data_->json.is_discarded()) throw std::invalid_argument(data_->name + ": cannot be read, expected a mapping");
}

Document::~Document() = default;

Tree Document::root() const {
  return {&data_->json, data_->name, data_.get()};
}

void Document::check() const {
  std::string all;
  for (const std::string& problem : data_->problems) all += (all.empty() ? "" : "\n") + problem;
  if (!all.empty()) throw std::invalid_argument(all);
}

std::vector<ReadInstead> Document::readInstead() const {
  std::vector<ReadInstead> all;
  for (const Tree::Instead& one : data_->instead) all.push_back({one.written, one.path});
  return all;
}

const Tree::Instead* Tree::insteadOf(const std::string& key) const {
  for (const Instead& one : static_cast<Document::Data*>(data_)->instead)
    if (one.mapping == value_ && one.key == key) return &one;
  return nullptr;
}

void Tree::readInstead(const char* key, const Tree& value) const {
  if (value_ == nullptr || jsonOf(value_).contains(key) || insteadOf(key) != nullptr) return;
  const bool given = value.value_ != nullptr && !jsonOf(value.value_).is_null();
  static_cast<Document::Data*>(data_)->instead.push_back(
      {value_, key, path_ + "." + key, given ? value.value_ : nullptr, value.path_});
}

void Tree::fail(const std::string& what) const {
  constexpr size_t kMost = 100;
  auto& problems = static_cast<Document::Data*>(data_)->problems;
  const std::string text = path_ + ": " + what;
  const bool known = std::find(problems.begin(), problems.end(), text) != problems.end();
  if (!known && problems.size() < kMost) problems.push_back(text);
}

size_t Tree::problems() const {
  return static_cast<Document::Data*>(data_)->problems.size();
}

bool Tree::has(const char* key) const {
  if (value_ == nullptr || !jsonOf(value_).is_object()) return false;
  const Instead* instead = insteadOf(key);
  // A number or text under a misspelt key is only read where it is needed: the key may mean another thing.
  const bool block = instead != nullptr && instead->value != nullptr && jsonOf(instead->value).is_structured();
  return jsonOf(value_).contains(key) || block;
}

bool Tree::isMapping() const {
  if (value_ == nullptr) return false;
  if (jsonOf(value_).is_object()) return true;
  fail(shown(jsonOf(value_)) + ", expected a mapping");
  return false;
}

Tree Tree::at(const char* key) const {
  const std::string path = path_ + "." + key;
  if (value_ != nullptr)
    if (const Instead* instead = insteadOf(key)) return {instead->value, instead->written, data_};
  if (has(key)) return {&jsonOf(value_)[key], path, data_};
  if (isMapping()) fail("lacks the key \"" + std::string(key) + "\"");
  return {nullptr, path, data_};
}

Tree Tree::item(size_t index) const {
  return {value_ == nullptr ? nullptr : &jsonOf(value_)[index], path_ + "[" + std::to_string(index) + "]", data_};
}

size_t Tree::count() const {
  if (value_ == nullptr) return 0;
  const Json& json = jsonOf(value_);
  if (json.is_array()) return json.size();
  fail(shown(json) + ", expected a list");
  return 0;
}

double Tree::number(double least, double most, const char* unit) const {
  const double allowed = std::clamp(0.0, least, most);
  if (value_ == nullptr) return allowed;
  const Json& json = jsonOf(value_);
  double value = std::nan("");
  if (json.is_number()) value = json.get<double>();
  if (json.is_string()) {
    const std::string& text = json.get_ref<const std::string&>();
    char* end = nullptr;
    const double parsed = std::strtod(text.c_str(), &end);
    if (end != text.c_str() && *end == '\0') value = parsed;
  }
  if (value >= least && value <= most) return value;
  const std::string range =
      (least == most ? shortText(least) : "a number from " + shortText(least) + " to " + shortText(most)) +
      (*unit != '\0' ? " " : "") + unit;
  std::string meant;
  double taken = allowed;  // the value with which other checks go on
  if (json.is_string() && std::isnan(value)) {
    const std::string& text = json.get_ref<const std::string&>();
    const double hex = *unit == '\0' ? suggestHex(text, least, most) : std::nan("");
    if (!std::isnan(hex)) taken = hex;
    meant = std::isnan(hex) ? document::suggestNumber(text) : "; if it is hexadecimal, write 0x" + text;
  }
  if (const auto other = document::suggestOtherUnit(value, {least, most}, unit); !other.advice.empty())
    meant = other.advice, taken = other.meant;
  fail(shown(json) + ", expected " + range + meant);
  return taken;
}

double Tree::whole(double least, double most, const char* unit) const {
  const size_t before = problems();
  const double value = number(least, most, unit);
  if (problems() == before && value != std::floor(value)) fail(shown(jsonOf(value_)) + ", expected a whole number");
  return std::floor(value);
}

uint64_t Tree::bits(unsigned width) const {
  if (value_ == nullptr) return 0;
  const uint64_t ones = width >= 64 ? ~uint64_t{0} : (uint64_t{1} << width) - 1;
  const Json& json = jsonOf(value_);
  std::string text = json.is_string() ? json.get<std::string>() : json.is_number_integer() ? json.dump() : "";
  const bool negative = !text.empty() && text[0] == '-';
  if (negative) text.erase(0, 1);
  const bool hex = text.size() > 2 && text[0] == '0' && (text[1] == 'x' || text[1] == 'X');
  char* end = nullptr;
  errno = 0;
  const uint64_t value = std::strtoull(text.c_str(), &end, hex ? 16 : 10);
  const bool good = !text.empty() && text[0] >= '0' && text[0] <= '9' && *end == '\0' && errno == 0;
  if (good && !negative && value <= ones) return value;
  if (good && negative && value <= ones / 2 + 1) return (~value + 1) & ones;
  char meant[64] = "";
  if (good && !negative && width < 64 && value >> width == 1)  // as books write polynomials
    std::snprintf(meant, sizeof meant, "; without its highest bit it is 0x%llx",
                  static_cast<unsigned long long>(value & ones));
  fail(shown(json) + ", expected a whole number of " + std::to_string(width) + " bits" + meant);
  return 0;
}

bool Tree::boolean() const {
  if (value_ == nullptr) return false;
  const Json& json = jsonOf(value_);
  if (json.is_boolean()) return json.get<bool>();
  if (json == "true" || json == "yes" || json == "on") return true;
  if (json == "false" || json == "no" || json == "off") return false;
  fail(shown(json) + ", expected true or false");
  return false;
}

std::string Tree::text() const {
  if (value_ == nullptr) return "";
  const Json& json = jsonOf(value_);
  if (json.is_string()) return json.get<std::string>();
  fail(shown(json) + ", expected text");
  return "";
}

bool Tree::only(std::span<const char* const> keys, std::span<const char* const> around,
                std::span<const char* const> within, const char* where) const {
  if (!isMapping()) return false;
  bool all_known = true;
  const std::vector<std::string> names(keys.begin(), keys.end());
  for (const auto& [key, value] : jsonOf(value_).items()) {
    if (std::find(names.begin(), names.end(), key) != names.end()) continue;
    all_known = false;
    const Tree unknown{&value, path_ + "." + key, data_};
    if (std::find(around.begin(), around.end(), key) != around.end()) {
      unknown.fail("belongs one level up, beside " + path_.substr(path_.rfind('.') + 1) + ", not inside of it");
      continue;
    }
    const bool inside = std::find(within.begin(), within.end(), key) != within.end();
    unknown.fail(
        "unknown key, expected one of " + document::listed(names, names.size()) +
        (inside ? "; " + key + " belongs one level deeper, inside " + where : document::suggestion(key, names)));
    const std::string meant = inside ? "" : nearestWord(key, names);
    if (!meant.empty()) readInstead(meant.c_str(), unknown);
  }
  return all_known;
}

}  // namespace hapticd::codec

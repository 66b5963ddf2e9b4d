// SPDX-License-Identifier: MIT
#include "codec/tree.hpp"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <stdexcept>

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

/// What a value looks like in a message.
std::string shown(const Json& value) {
  constexpr size_t kLongest = 40;
  std::string text = value.dump(-1, ' ', false, Json::error_handler_t::replace);
  if (text.size() > kLongest) text = text.substr(0, kLongest) + "...";
  return text;
}

}  // namespace

struct Document::Data {
  Json json;
  std::string name;
};

Document::Document(const std::string& json, std::string name) : data_(new Data{Json(), std::move(name)}) {
  data_->json = Json::parse(json, nullptr, false);
  if (data_->json.is_discarded()) throw std::invalid_argument(data_->name + ": cannot be read, expected a mapping");
}

Document::~Document() = default;

Tree Document::root() const {
  return {&data_->json, data_->name};
}

void Tree::fail(const std::string& what) const {
  throw std::invalid_argument(path_ + ": " + what);
}

bool Tree::has(const char* key) const {
  const Json& json = jsonOf(value_);
  return json.is_object() && json.contains(key);
}

Tree Tree::at(const char* key) const {
  const Json& json = jsonOf(value_);
  if (!json.is_object()) fail(shown(json) + ", expected a mapping");
  if (!json.contains(key)) fail("lacks the key " + std::string(key));
  return {&json[key], path_ + "." + key};
}

Tree Tree::item(size_t index) const {
  return {&jsonOf(value_)[index], path_ + "[" + std::to_string(index) + "]"};
}

size_t Tree::count() const {
  const Json& json = jsonOf(value_);
  if (!json.is_array()) fail(shown(json) + ", expected a list");
  return json.size();
}

double Tree::number(double least, double most) const {
  const Json& json = jsonOf(value_);
  double value = std::nan("");
  if (json.is_number()) value = json.get<double>();
  if (json.is_string()) {
    const std::string& text = json.get_ref<const std::string&>();
    char* end = nullptr;
    const double parsed = std::strtod(text.c_str(), &end);
    if (end != text.c_str() && *end == '\0') value = parsed;
  }
  if (!(value >= least && value <= most))
    fail(shown(json) + ", expected a number from " + shortText(least) + " to " + shortText(most));
  return value;
}

double Tree::whole(double least, double most) const {
  const double value = number(least, most);
  if (value != std::floor(value)) fail(shown(jsonOf(value_)) + ", expected a whole number");
  return value;
}

bool Tree::boolean() const {
  const Json& json = jsonOf(value_);
  if (json.is_boolean()) return json.get<bool>();
  if (json == "true" || json == "yes" || json == "on") return true;
  if (json == "false" || json == "no" || json == "off") return false;
  fail(shown(json) + ", expected true or false");
}

std::string Tree::text() const {
  const Json& json = jsonOf(value_);
  if (!json.is_string()) fail(shown(json) + ", expected text");
  return json.get<std::string>();
}

void Tree::only(std::initializer_list<const char*> keys) const {
  const Json& json = jsonOf(value_);
  if (!json.is_object()) fail(shown(json) + ", expected a mapping");
  for (const auto& [key, value] : json.items()) {
    bool known = false;
    for (const char* name : keys) known = known || key == name;
    if (known) continue;
    std::string all;
    for (const char* name : keys) all += (all.empty() ? "" : ", ") + std::string(name);
    throw std::invalid_argument(path_ + "." + key + ": unknown key, expected one of " + all);
  }
}

}  // namespace hapticd::codec

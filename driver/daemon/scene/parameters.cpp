// SPDX-License-Identifier: MIT
#include "scene/parameters.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string_view>
#include <utility>

#include "base/counted.hpp"
#include "base/nearest_word.hpp"
#include "document/correction.hpp"
#include "document/suggestion.hpp"
#include "hapticd/abi.h"

namespace hapticd::scene {

using namespace document;
namespace {

constexpr size_t kShownProblems = 8;  ///< most problems reported for one array, because more would say the same

/// True if the id is the name of a group: the id of some parameter begins with "id.".
bool isGroup(const host::ClassInfo& info, const std::string& id) {
  for (const host::ParamInfo& param : info.params)
    if (param.id.size() > id.size() && param.id.compare(0, id.size(), id) == 0 && param.id[id.size()] == '.')
      return true;
  return false;
}

/// Returns the ids of a group without the group's name, such as "script" for "hand.script"; for "" all ids.
std::vector<std::string> idsIn(const host::ClassInfo& info, const std::string& group) {
  std::vector<std::string> ids;
  for (const std::string& id : info.paramIds())
    if (group.empty())
      ids.push_back(id);
    else if (id.size() > group.size() && id.compare(0, group.size(), group) == 0 && id[group.size()] == '.')
      ids.push_back(id.substr(group.size() + 1));
  return ids;
}

/// Returns the ids with each group as one name, such as "arm" for "arm.kind" and "arm.dh": a list of all ids of a
/// module with groups is too long to be read.
std::vector<std::string> withGroupsAsOne(const std::vector<std::string>& ids) {
  std::vector<std::string> names;
  for (const std::string& id : ids)
    if (const std::string name = id.substr(0, id.find('.')); std::find(names.begin(), names.end(), name) == names.end())
      names.push_back(name);
  return names;
}

/// Returns the id whose last name is this word, if a parameter of a group was given outside of its group.
std::string idEndingWith(const std::string& word, const std::vector<std::string>& ids) {
  for (const std::string& id : ids)
    if (id.ends_with("." + word)) return id;
  return "";
}

std::string countText(const host::ParamInfo& p) {
  // one row, which may be left out: no other number of numbers is right
  if (p.min_count == 0 && p.columns > 1 && p.max_count == p.columns)
    return "0 or " + std::to_string(p.columns) + " numbers";
  std::string text = p.min_count == p.max_count ? std::to_string(p.min_count) + " numbers"
                     : p.max_count == UINT32_MAX
                         ? "at least " + std::to_string(p.min_count) + " numbers"
                         : std::to_string(p.min_count) + " to " + std::to_string(p.max_count) + " numbers";
  if (p.columns > 1 && p.max_count > p.columns) text += " in rows of " + std::to_string(p.columns);
  return text;
}

}  // namespace

/// Returns the index of the choice that a misspelt one probably means.
static std::optional<double> suggestChoice(const std::string& word, const std::vector<std::string>& choices) {
  const std::string meant = nearestWord(word, choices);
  if (meant.empty()) return std::nullopt;
  return static_cast<double>(std::find(choices.begin(), choices.end(), meant) - choices.begin());
}

/// Returns the number of the range that is nearest to the given one (to 0 if the node is not a number), so that the
/// rest of a file with problems can still be judged.
static double heldIn(const Node& node, const Range& range) {
  const auto given = node.isScalar() ? toNumber(node.scalar) : std::nullopt;
  return std::clamp(given && std::isfinite(*given) ? *given : 0.0, range.min, range.max);
}

void ParameterReader::overrideFrom(Reader& in) {
  in_ = &in;
  given_.assign(given_.size(), 0);
}

void ParameterReader::read(const Node& node, const std::string& key, const std::string& prefix,
                           const std::string& skip) {
  if (!node.isMap()) {
    in_->problem(node, key,
                 describe(node) + ", expected a mapping with " + document::listed(idsIn(info_, prefix)) +
                     document::suggestMapping(node));
    for (const Node& item : node.items)  // keys with dashes before them
      if (item.isMap()) read(item, key, prefix, skip);
    return;
  }
  std::set<std::string_view> known;
  for (const Entry& entry : node.entries) {
    const bool again = !known.insert(entry.key.scalar).second;
    if (!skip.empty() && entry.key.scalar == skip) continue;
    const std::string id = joined(prefix, entry.key.scalar), path = joined(key, entry.key.scalar);
    const int index = info_.indexOf(id);
    if (again) {  // given twice: the parser has reported it
      Value unused;
      if (index >= 0 && !entry.value.isNull())
        readValue(entry.value, path, info_.params[static_cast<size_t>(index)], unused);
      continue;
    }
    if (index >= 0 && entry.value.isNull())
      nothing(entry, path, static_cast<uint32_t>(index));
    else if (index >= 0)
      readOne(entry.value, path, static_cast<uint32_t>(index));
    else if (isGroup(info_, id))
      read(entry.value, path, id);
    else
      unknown(node, entry, path, id);
  }
}

void ParameterReader::nothing(const Entry& entry, const std::string& key, uint32_t index) {
  const host::ParamInfo& param = info_.params[index];
  given_[index] = entry.key.line;
  seen_[index] = true;
  std::string expected = "a text";
  if (param.kind == HSP_REAL || param.kind == HSP_INT)
    expected = document::expectedOf({param.min, param.max, param.unit.c_str()});
  if (param.kind == HSP_BOOL) expected = "true or false";
  if (param.kind == HSP_ENUM) expected = "one of " + document::listed(param.choices, 40);
  if (param.kind == HSP_PATH) expected = "the path of a file";
  if (param.kind == HSP_ARRAY) expected = "a list of " + countText(param);
  if (param.kind == HSP_DATA) expected = "a mapping";
  in_->problem(entry.key, key, "no value given, expected " + expected);
}

void ParameterReader::unknown(const Node& around, const Entry& entry, const std::string& key, const std::string& id) {
  std::vector<std::string> ids = info_.paramIds();
  if (ids.empty())
    return in_->problem(entry.key, key, "unknown key: " + info_.name + " has no parameters", ProblemKind::kUnknownKey);
  constexpr const char* kOfTheFile[] = {"name", "mount", "limits", "admittance", "hand", "hd", "module"};
  const bool of_the_file =
      info_.kind == host::Kind::kDevice &&
      std::any_of(std::begin(kOfTheFile), std::end(kOfTheFile), [&](const char* one) { return id == one; });
  if (of_the_file)
    return in_->problem(
        entry.key, key,
        "belongs at the top of the device file, beside parameters, because it is not a parameter of " + info_.name);
  // Catalogues of USB devices give two numbers; hapticd takes one text, because YAML would read 0486 as a number.
  if ((id == "usb.vendor" || id == "usb.product" || id == "usb.vid" || id == "usb.pid") && info_.indexOf("usb.id") >= 0)
    return in_->problem(entry.key, key,
                        "unknown parameter of " + info_.name +
                            "; expected one key for both numbers: id: \"VENDOR:PRODUCT\", in hexadecimal, "
                            "such as \"16c0:0486\"");
  constexpr size_t kMostListed = 24;
  // Within a group only names of this group are suggested, because names of other groups are not valid here.
  const std::string group = id.substr(0, id.find('.') == id.npos ? 0 : id.rfind('.'));
  if (!group.empty()) std::erase_if(ids, [&](const std::string& one) { return one.rfind(group + ".", 0) != 0; });
  const std::vector<std::string> names = withGroupsAsOne(idsIn(info_, group));
  if (group.empty()) ids.insert(ids.begin(), names.begin(), names.end());
  const std::string inside = group.empty() ? idEndingWith(id, ids) : "";
  const std::string meant = inside.empty() ? nearestWord(id, ids) : inside;
  in_->problem(
      entry.key, key,
      "unknown parameter of " + info_.name + ", expected one of " + document::listedFor(id, names, kMostListed) +
          (inside.empty() ? document::suggestion(id, ids) : " (did you mean \"" + inside + "\"?)") +
          (names.size() > kMostListed && info_.kind == host::Kind::kShape ? "; see hapticd plugin info " + info_.name
                                                                          : ""),
      meant.empty() || entry.value.isNull() ? ProblemKind::kUnknownKey : ProblemKind::kMisspeltKey);
  if (!meant.empty() && around.find(meant.substr(meant.rfind('.') + 1)) == nullptr) judgeAs(meant, entry, key);
}

void ParameterReader::judgeAs(const std::string& meant, const Entry& entry, const std::string& key) {
  const int index = info_.indexOf(meant);
  if (index >= 0 && given_[static_cast<size_t>(index)] == 0 && !entry.value.isNull())
    readOne(entry.value, key, static_cast<uint32_t>(index));
  else if (index < 0 && isGroup(info_, meant) && entry.value.isMap())
    read(entry.value, key, meant);
}

void ParameterReader::readOne(const Node& node, const std::string& key, uint32_t index) {
  const host::ParamInfo& param = info_.params[index];
  if (given_[index] != 0)
    return in_->problem(node, key,
                        "given twice (first in line " + std::to_string(given_[index]) +
                            (given_as_[index].empty() || given_as_[index] == key ? "" : ", as " + given_as_[index]) +
                            "), expected each parameter once");
  given_[index] = node.line;
  given_as_[index] = key;
  seen_[index] = true;
  Value value;
  value.id = param.id;
  value.index = index;
  value.kind = param.kind;
  value.place = in_->place(node);
  if (!readValue(node, key, param, value)) return;
  for (Value& before : values_)
    if (before.index == index) return (void)(before = std::move(value));
  values_.push_back(std::move(value));
}

/// Returns the choice that a usual word of the field stands for: a serial arm is a chain.
static std::optional<size_t> otherWordFor(const Node& node, const std::vector<std::string>& choices) {
  constexpr std::array kWords{std::pair{"serial", "chain"}, std::pair{"open_chain", "chain"}, std::pair{"dh", "chain"},
                              std::pair{"parallel", "delta"}};
  for (const auto& [word, meant] : kWords)
    for (size_t i = 0; node.isScalar() && node.scalar == word && i < choices.size(); ++i)
      if (choices[i] == meant) return i;
  return std::nullopt;
}

bool ParameterReader::readValue(const Node& node, const std::string& key, const host::ParamInfo& param, Value& value) {
  const Range range{param.min, param.max, param.unit.c_str()};
  std::optional<double> number;
  switch (param.kind) {
    case HSP_REAL:
      number = in_->number(node, key, range);
      break;
    case HSP_INT:
      number = in_->whole(node, key, range);
      break;
    case HSP_BOOL:
      if (const auto flag = in_->boolean(node, key)) number = *flag ? 1 : 0;
      break;
    case HSP_ENUM:
      if (const auto index = in_->choice(node, key, param.choices))
        number = static_cast<double>(*index);
      else if (const auto meant = otherWordFor(node, param.choices))
        number = static_cast<double>(*meant),
        in_->problems().back().what += " (did you mean \"" + param.choices[*meant] + "\"?)";
      else if (node.isScalar())  // reported; the likely choice lets the rest of the file be judged
        number = suggestChoice(node.scalar, param.choices);
      break;
    case HSP_PATH:
      return readPath(node, key, value);
    case HSP_TEXT:
      if (const auto text = in_->text(node, key)) return value.text = *text, true;
      return false;
    case HSP_ARRAY:
      return readArray(node, key, param, value);
    case HSP_DATA:
      return value.text = toJson(node), true;
    default:
      in_->problem(node, key, "has a kind that this hapticd does not know; install a newer hapticd");
      return false;
  }
  value.number = number.value_or(heldIn(node, range));
  return number || ((param.kind == HSP_REAL || param.kind == HSP_INT) && node.isScalar() && toNumber(node.scalar));
}

bool ParameterReader::readPath(const Node& node, const std::string& key, Value& value) {
  // A file in /dev appears only when the device is plugged in, so it is not checked here but when it is opened.
  if (info_.kind == host::Kind::kDevice && node.isScalar() && node.scalar.rfind("/dev/", 0) == 0)
    return value.text = node.scalar, true;
  const auto file = in_->existingFile(node, key);
  if (file) value.text = file->string();
  return file.has_value();
}

/// Returns the unit of each column: "m, rad, m, rad" has one unit for each column of four. A single unit is the unit of
/// all columns.
static std::vector<std::string> unitsOf(const host::ParamInfo& param) {
  std::vector<std::string> units(1);
  for (const char c : param.unit) {
    if (c == ',')
      units.emplace_back();
    else if (c != ' ' || !units.back().empty())
      units.back() += c;
  }
  return units.size() == param.columns ? units : std::vector<std::string>{param.unit};
}

/// Returns advice for a list of which some numbers are beyond the range because their decimal commas separate numbers.
static std::string suggestDecimalsBeyond(const Node& list, const host::ParamInfo& param) {
  const bool beyond = std::any_of(list.items.begin(), list.items.end(), [&param](const Node& item) {
    const auto number = item.isScalar() ? toNumber(item.scalar) : std::nullopt;
    return number && (*number < param.min || *number > param.max);
  });
  return beyond ? suggestDecimals(list, 2) : "";
}

/// Returns what is wrong with a text in the place of a list.
static std::string notAList(const Node& node, const host::ParamInfo& param) {
  const std::string hint = suggestList(node, param.min_count);
  return describe(node) + " is not a number, expected a list of " + countText(param) + hint +
         (hint.empty() && param.def_text ? "; such as " + *param.def_text : "");
}

bool ParameterReader::readArray(const Node& node, const std::string& key, const host::ParamInfo& param, Value& value) {
  const size_t before = in_->problems().size();
  bool shaped = true;  // a list of the right length is kept even if its numbers are wrong, so that it can be judged
  const std::vector<std::string> units = unitsOf(param);
  if (const std::string advice = suggestDecimalsBeyond(node, param); !advice.empty())
    return in_->problem(node, key, "zeros and whole numbers take turns" + advice), false;
  const auto add = [&](const Node& item, const std::string& path, size_t column) {
    const Range of_column{param.min, param.max, units[column % units.size()].c_str()};
    const bool shown = in_->problems().size() - before < kShownProblems;
    const auto number = shown ? in_->number(item, path, of_column) : std::nullopt;
    value.numbers.push_back(number.value_or(heldIn(item, of_column)));
  };
  if (node.isScalar() && param.min_count > 1 && !toNumber(node.scalar)) {
    in_->problem(node, key, notAList(node, param));
  } else if (node.isScalar()) {
    add(node, key, 0);
  } else if (node.isSequence()) {
    for (size_t i = 0; i < node.items.size(); ++i) {
      const Node& item = node.items[i];
      const std::string path = key + "[" + std::to_string(i) + "]";
      if (item.isSequence() && param.columns > 1 && item.items.size() != param.columns) {
        shaped = false;
        in_->problem(item, path,
                     "it has " + counted(item.items.size(), "number") + ", expected " + std::to_string(param.columns));
      } else if (item.isSequence())
        for (size_t j = 0; j < item.items.size(); ++j) add(item.items[j], path + "[" + std::to_string(j) + "]", j);
      else
        add(item, path, i);
    }
  } else {
    shaped = false;
    in_->problem(node, key, describe(node) + ", expected a list of " + countText(param));
  }
  if (!shaped || (node.isScalar() && in_->problems().size() != before)) return false;
  const size_t count = value.numbers.size();
  const bool ragged = param.columns > 1 && count % param.columns != 0;
  if (!ragged && count >= param.min_count && count <= param.max_count) return true;
  const std::string advice = count > param.min_count ? document::suggestDecimals(node, 1) : "";
  in_->problem(node, key, counted(count, "number") + ", expected " + countText(param) + advice);
  return false;
}

void ParameterReader::requireAll(const Node& at, const std::string& key) {
  for (uint32_t i = 0; i < info_.params.size(); ++i) {
    const host::ParamInfo& param = info_.params[i];
    if ((param.flags & HSP_P_REQUIRED) == 0) continue;
    if (!seen_[i]) in_->problem(at, joined(key, param.id), "missing, " + info_.name + " needs it: " + param.doc);
  }
}

}  // namespace hapticd::scene

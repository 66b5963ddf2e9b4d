// SPDX-License-Identifier: MIT
#include "control/request.hpp"

#include <cmath>
#include <cstdlib>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <vector>

#include "base/descriptors.hpp"
#include "base/mark_text.hpp"
#include "base/nearest_word.hpp"

namespace hapticd::control {

namespace {

using Json = nlohmann::json;
using Kind = Request::Kind;

constexpr int kMaxDepth = 8;
constexpr size_t kMaxText = 4096;
constexpr double kMaxPlace = 10;         ///< [m] largest coordinate: no arm reaches farther
constexpr double kFinestDrawing = 1e-5;  ///< [m] smallest tolerance: no screen shows less
constexpr double kFewestTriangles = 1000, kMostTriangles = 16777216;
constexpr double kMostFrames = 1e15;  ///< largest number of a frame: a double holds it exactly

/// A kind of request: its word, the keys that it must have, and the keys that it may have.
struct RequestForm {
  const char* word;
  Kind kind;
  std::set<std::string> needs, may;
};

const std::array<RequestForm, 25>& forms() {
  static const std::array<RequestForm, 25> all = {
      {{"status", Kind::kStatus, {}, {}},
       {"list", Kind::kList, {}, {}},
       {"snapshot", Kind::kSnapshot, {}, {}},
       {"events", Kind::kEvents, {}, {"after"}},
       {"subscribe", Kind::kSubscribe, {}, {}},
       {"get", Kind::kGet, {"model"}, {"parameter"}},
       {"enable", Kind::kEnable, {"model"}, {}},
       {"disable", Kind::kDisable, {"model"}, {}},
       {"move", Kind::kMove, {"model", "position"}, {"orientation", "seconds"}},
       {"set", Kind::kSet, {"model", "parameter", "value"}, {"consent"}},
       {"add", Kind::kAdd, {"file"}, {"model", "files"}},
       {"remove", Kind::kRemove, {"model"}, {}},
       {"reload", Kind::kReload, {}, {"file", "files"}},
       {"hold", Kind::kHold, {}, {"device"}},
       {"clear", Kind::kClear, {}, {"device"}},
       {"mark", Kind::kMark, {"text"}, {}},
       {"dump", Kind::kDump, {}, {}},
       {"geometry", Kind::kGeometry, {"model"}, {"tolerance", "triangles", "as"}},
       {"vertices", Kind::kVertices, {"model"}, {"after"}},
       {"feature", Kind::kFeature, {"model", "number"}, {}},
       {"lead", Kind::kLead, {}, {"model", "hand", "force"}},
       {"unlead", Kind::kUnlead, {}, {"model", "hand", "force"}},
       {"state", Kind::kState, {}, {}},
       {"bell", Kind::kBell, {}, {}},
       {"stop", Kind::kStop, {}, {}}}};
  return all;
}

const RequestForm* formOf(const std::string& word) {
  for (const RequestForm& form : forms())
    if (word == form.word) return &form;
  return nullptr;
}

std::vector<std::string> words() {
  std::vector<std::string> all;
  for (const RequestForm& form : forms()) all.emplace_back(form.word);
  return all;
}

std::string listed(const std::vector<std::string>& names) {
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  return list;
}

std::string didYouMean(const std::string& word, const std::vector<std::string>& known) {
  const std::string nearest = nearestWord(word, known);
  return nearest.empty() ? "" : " (did you mean \"" + nearest + "\"?)";
}

/// Returns a value as JSON for a message; what is long is cut off.
std::string shown(const Json& value) {
  constexpr size_t kLongest = 60;
  const std::string text = value.dump(-1, ' ', true, Json::error_handler_t::replace);
  return text.size() <= kLongest ? text : text.substr(0, kLongest) + "...";
}

/// Returns what a key must have as its value, with unit and range.
std::string expected(const char* key) {
  static const std::map<std::string_view, const char*> all = {
      {"model", "the name of a model"},
      {"device", "the name of a device"},
      {"hand", "the name of the device whose simulated hand is led"},
      {"force", "the name of the device to push on"},
      {"parameter", "the name of a parameter"},
      {"file", "the absolute path of a scene"},
      {"files", "a list of at most 250 absolute paths, every path once"},
      {"text", kMarkExpected},
      {"value", "a number without quotes, or a word in quotes such as \"true\""},
      {"tolerance", "a number from 0.00001 to 1 m"},
      {"triangles", "a whole number from 1000 to 16777216"},
      {"after", "a whole number from 0 to 10^15"},
      {"number", "the number of a surface or feature, a whole number from 0 to 4294967295"},
      {"position", "a list of 3 numbers [x, y, z] from -10 to 10 m, world frame"},
      {"orientation", "a unit quaternion, a list of 4 numbers [w, x, y, z] of length 1"},
      {"seconds", "a number from 0.05 to 600 s"}};
  return all.at(key);
}
static_assert(kMostDescriptors == 250 && kMaxPlace == 10 && kFinestDrawing == 1e-5 && kMostFrames == 1e15 &&
                  kFewestTriangles == 1000 && kMostTriangles == 16777216,
              "the ranges in expected() are those that are checked");

/// Returns a hint if the line contains what many programs write for a number that is not finite: JSON has no such
/// numbers.
std::string noJsonNumber(std::string_view line) {
  for (const char* word : {"NaN", "nan", "Infinity", "inf"})
    if (line.find(word) != std::string_view::npos) return std::string("; JSON has no number ") + word;
  return "";
}

/// Returns why a line is no JSON object, with the place.
std::string placeOfError(std::string_view line) {
  try {
    const Json parsed = Json::parse(line.begin(), line.end());
    const std::string type = parsed.type_name();
    const std::string article = parsed.is_null() ? "" : parsed.is_array() ? "an " : "a ";
    return "the line is " + article + type + ": ";
  } catch (const Json::parse_error& error) {
    return "the line is not valid JSON at byte " + std::to_string(error.byte) + ": ";
  } catch (const Json::exception&) {
    return "a number of the line is too large for JSON (1.8e308 at most): ";
  }
}

/// Takes values out of a request and keeps every complaint.
class FieldReader {
 public:
  explicit FieldReader(const Json& json) : json_(json) {}

  void text(const char* key, std::string& to) {
    const Json* value = find(key);
    if (value == nullptr) return;
    if (!value->is_string() || value->get_ref<const std::string&>().empty() ||
        value->get_ref<const std::string&>().size() > kMaxText)
      return complain(key, expected(key) + ", 1 to " + std::to_string(kMaxText) + " bytes of text");
    to = value->get<std::string>();
    if (to.find('\0') != std::string::npos) complain(key, expected(key) + ", without zero bytes");
  }
  void markText(const char* key, std::string& to) {
    const Json* value = find(key);
    if (value == nullptr) return;
    if (value->is_string()) to = value->get<std::string>();
    if (!isMarkText(to)) complain(key, expected(key));
  }
  void number(const char* key, double low, double high, double& to, bool whole = false) {
    const Json* value = find(key);
    if (value == nullptr) return;
    const double given = value->is_number() ? value->get<double>() : NAN;
    if (!(given >= low && given <= high) || (whole && given != std::floor(given))) return complain(key, expected(key));
    to = given;
  }
  template <class T>
  void whole(const char* key, double low, double high, T& to) {
    double given = static_cast<double>(to);
    number(key, low, high, given, true);
    to = static_cast<T>(given);
  }
  void numberOrWord(const char* key, double low, double high, double& to, std::string& word) {
    const Json* value = find(key);
    if (value == nullptr || !value->is_string()) return number(key, low, high, to);
    text(key, word);
    char* end = nullptr;
    std::strtod(word.c_str(), &end);
    if (end != word.c_str() && *end == '\0') complain(key, expected(key));
  }
  template <size_t N>
  void numbers(const char* key, double bound, std::array<double, N>& to) {
    const Json* value = find(key);
    if (value == nullptr) return;
    bool good = value->is_array() && value->size() == N;
    for (size_t i = 0; i < N && good; ++i) {
      to[i] = (*value)[i].is_number() ? (*value)[i].template get<double>() : NAN;
      good = std::abs(to[i]) <= bound;
    }
    if (!good) complain(key, expected(key));
  }
  /// Reads a list of absolute paths without repetitions.
  void paths(const char* key, size_t most, std::vector<std::string>& to) {
    const Json* value = find(key);
    if (value == nullptr) return;
    std::set<std::string> known;
    bool good = value->is_array() && value->size() <= most;
    for (size_t i = 0; good && i < value->size(); ++i) {
      const std::string path = (*value)[i].is_string() ? (*value)[i].get<std::string>() : "";
      good = path.size() <= kMaxText && path[0] == '/' && path.find('\0') == std::string::npos &&
             known.insert(path).second;
      to.push_back(path);
    }
    if (!good) complain(key, expected(key));
  }
  /// Reads a key whose only permitted value is the word `only`. @param to becomes true if the key is there
  void word(const char* key, const char* only, bool& to) {
    const Json* value = find(key);
    if (value == nullptr) return;
    if (!value->is_string() || *value != only) return complain(key, Json(only).dump());
    to = true;
  }
  void flag(const char* key, bool& to) {
    const Json* value = find(key);
    if (value == nullptr) return;
    if (!value->is_boolean()) return complain(key, "true or false");
    to = value->get<bool>();
  }
  bool has(const char* key) const { return json_.contains(key); }
  void complain(const std::string& key, const std::string& wanted) {
    if (!complaints_.empty()) complaints_ += "; ";
    complaints_ += "\"" + key + "\": expected " + wanted;
    if (const Json* given = find(key.c_str())) complaints_ += ", got " + shown(*given);
  }
  const std::string& complaints() const { return complaints_; }

 private:
  const Json* find(const char* key) const {
    const auto it = json_.find(key);
    return it == json_.end() ? nullptr : &*it;
  }
  const Json& json_;
  std::string complaints_;
};

/// Returns which keys of a request are missing, and which are not part of it; "" if there are none.
std::string wrongKeys(const Json& json, const RequestForm& form) {
  constexpr size_t kMostNamed = 5;  // so that the answer stays short, however many wrong keys a request has
  std::string wrong;
  const auto add = [&wrong](const std::string& what) { wrong += (wrong.empty() ? "" : "; ") + what; };
  std::vector<std::string> known(form.needs.begin(), form.needs.end());
  known.insert(known.end(), form.may.begin(), form.may.end());
  for (const std::string& key : form.needs)
    if (!json.contains(key))
      add("\"" + key + "\" is missing in \"" + form.word + "\", expected " + expected(key.c_str()));
  size_t unknown = 0;
  for (const auto& [key, value] : json.items())
    if (key != "do" && key != "id" && form.needs.count(key) == 0 && form.may.count(key) == 0 && ++unknown <= kMostNamed)
      add(shown(key) + " is not a key of \"" + form.word + "\"" + didYouMean(key, known));
  if (unknown > kMostNamed) add("nor are " + std::to_string(unknown - kMostNamed) + " others");
  if (unknown > 0)
    wrong += ", expected " + (known.empty() ? "no other key than \"do\" and \"id\"" : "the keys " + listed(known));
  return wrong;
}

/// Reads the "id" of a request. @return what is wrong with it, or ""
std::string readId(const Json& json, std::string* id) {
  constexpr size_t kLongest = 128;
  const auto given = json.find("id");
  if (given == json.end()) return "";
  const std::string text = given->dump(-1, ' ', false, Json::error_handler_t::replace);
  if ((!given->is_number() && !given->is_string()) || text.size() > kLongest)
    return "\"id\": expected a number or a text of at most " + std::to_string(kLongest) + " bytes, got " +
           shown(*given);
  if (id != nullptr) *id = text;
  return "";
}

void readOrientation(FieldReader& take, Request& request) {
  request.turns = take.has("orientation");
  if (!request.turns) return;
  const size_t before = take.complaints().size();
  take.numbers("orientation", 2, request.orientation);
  if (take.complaints().size() > before) return;
  double square = 0;
  for (const double part : request.orientation) square += part * part;
  const double length = std::sqrt(square);
  constexpr double kRounding = 1e-3;
  if (!(std::abs(length - 1) <= kRounding)) return take.complain("orientation", expected("orientation"));
  for (double& part : request.orientation) part /= length;
}

/// Watches a request while it is parsed: it must not be nested too deeply, and must not have a key twice, because some
/// readers take the first and others the last.
class Watch {
 public:
  bool operator()(int depth, Json::parse_event_t event, const Json& parsed) {
    deep = deep || depth > kMaxDepth;
    if (event == Json::parse_event_t::object_start) keys_.emplace_back();
    if (event == Json::parse_event_t::object_end && !keys_.empty()) keys_.pop_back();
    if (event == Json::parse_event_t::key && !keys_.empty() && !keys_.back().insert(parsed.get<std::string>()).second)
      twice = parsed.get<std::string>();
    return !deep;
  }
  bool deep = false;
  std::string twice;  ///< a key that is given twice, or ""

 private:
  std::vector<std::set<std::string>> keys_;  ///< the keys so far of each open object
};

void readValues(FieldReader& take, Request& request) {
  take.text("model", request.model);
  take.text("device", request.device);
  take.text("hand", request.hand);
  take.text("force", request.force);
  take.text("parameter", request.parameter);
  take.text("file", request.file);
  take.paths("files", kMostDescriptors, request.files);
  take.markText("text", request.text);
  take.numberOrWord("value", -1e300, 1e300, request.value, request.word);
  take.number("tolerance", kFinestDrawing, 1, request.tolerance);
  take.word("as", "memory", request.as_memory);
  take.whole("after", 0, kMostFrames, request.after);
  take.whole("number", 0, 4294967295.0, request.number);
  take.whole("triangles", kFewestTriangles, kMostTriangles, request.triangles);
  take.flag("consent", request.consent);
  take.numbers("position", kMaxPlace, request.position);
  readOrientation(take, request);
  if (take.has("seconds")) take.number("seconds", 0.05, 600, request.seconds.emplace(0));
}

}  // namespace

Result<Request> parseRequest(std::string_view line, std::string* id) {
  if (line.size() > kMaxRequestBytes)
    return Error{"the request has " + std::to_string(line.size()) + " bytes, expected at most " +
                 std::to_string(kMaxRequestBytes)};
  Watch watch;
  const Json json = Json::parse(line.begin(), line.end(), std::ref(watch), false);
  if (watch.deep || !json.is_object())
    return Error{(watch.deep ? "lists and objects are nested more than " + std::to_string(kMaxDepth) + " deep: "
                             : placeOfError(line)) +
                 "expected one JSON object in one line, such as {\"do\": \"status\"}" + noJsonNumber(line)};
  if (!watch.twice.empty())
    return Error{Json(watch.twice.substr(0, 64)).dump(-1, ' ', true, Json::error_handler_t::replace) +
                 " is given twice, expected every key once"};
  if (const std::string wrong = readId(json, id); !wrong.empty()) return Error{wrong};
  const auto word = json.find("do");
  const RequestForm* form =
      word != json.end() && word->is_string() ? formOf(word->get_ref<const std::string&>()) : nullptr;
  if (form == nullptr) {
    const bool text = word != json.end() && word->is_string();
    return Error{"\"do\": expected one of " + listed(words()) +
                 (word != json.end() ? ", got " + shown(*word) : ", but the key is missing") +
                 (text ? didYouMean(word->get_ref<const std::string&>(), words()) : "")};
  }
  if (const std::string wrong = wrongKeys(json, *form); !wrong.empty()) return Error{wrong};
  Request request;
  request.kind = form->kind;
  FieldReader take(json);
  readValues(take, request);
  if (!request.file.empty() && request.file[0] != '/') take.complain("file", expected("file"));
  const bool leads = form->kind == Kind::kLead || form->kind == Kind::kUnlead;
  if (leads && take.has("model") + take.has("hand") + take.has("force") != 1)
    take.complain(form->word, "exactly one of the keys \"model\", \"hand\" and \"force\"");
  if (!take.complaints().empty()) return Error{take.complaints()};
  return request;
}

std::string refusal(const std::string& why, const std::string& code) {
  return Json{{"ok", false}, {"code", code}, {"error", why}}.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string withId(const std::string& answer, const std::string& id) {
  return id.empty() || answer.empty() || answer[0] != '{' ? answer : "{\"id\":" + id + "," + answer.substr(1);
}

}  // namespace hapticd::control

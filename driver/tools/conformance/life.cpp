// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>
#include <set>
#include <vector>

#include "base/clock.hpp"
#include "conformance/building_blocks.hpp"

namespace hapticd::conformance {
namespace {

using Eigen::Vector3d;

bool blank(const char* words) {
  return words == nullptr || words[0] == '\0';
}

/// Returns true for a name that a scene and a command line can use without quotes.
bool plainId(const char* id) {
  for (; *id != '\0'; ++id)
    if (std::isalnum(static_cast<unsigned char>(*id)) == 0 && std::strchr("_.-", *id) == nullptr) return false;
  return true;
}

/// Returns what is wrong with the texts of a class, or "".
std::string wrongTexts(const hsp_class& c) {
  struct Member {
    const char *name, *text, *expected;
  };
  if (blank(c.id) || std::strchr(c.id, '.') == nullptr)
    return "the id of the class, \"" + std::string(blank(c.id) ? "" : c.id) +
           "\", is not a reverse domain name; expected one such as org.example.shape.sphere";
  for (const Member& member : {Member{"version", c.version, "a version such as 1.0.0"},
                               Member{"license", c.license, "the name of a licence such as MIT"},
                               Member{"doc", c.doc, "one or two sentences that say what the shape is"}})
    if (blank(member.text))
      return std::string("the class has no ") + member.name + " (hsp_class." + member.name + " is empty); expected " +
             member.expected;
  return "";
}

/// Returns what is wrong with the default of a parameter, or "".
std::string wrongDefault(const hsp_param& p) {
  const bool number = p.kind == HSP_REAL || p.kind == HSP_INT;
  if (number && !(p.min <= p.def && p.def <= p.max))
    return "its default, " + text(p.def) + ", is out of its range; expected " + text(p.min) + " to " + text(p.max);
  if (p.kind == HSP_ENUM && !(p.def >= 0 && p.def < p.choice_count))
    return "its default, choice " + text(p.def) + ", is not one of its " + std::to_string(p.choice_count) +
           " choices, which count from 0";
  return "";
}

/// Returns what is wrong with the description of a parameter, or "".
std::string wrongParam(const hsp_param& p) {
  if (blank(p.doc)) return "its doc is empty; expected a sentence that says what it does";
  if (p.unit == nullptr) return "its unit is NULL; expected a unit, or \"\" where it has none";
  if ((p.flags & HSP_P_LIVE) != 0 && p.kind > HSP_ENUM)
    return "it is a path, a text or a list and has HSP_P_LIVE, but nothing can change it while the shape is active; "
           "expected HSP_P_LIVE on numbers, switches and choices alone";
  if (!plainId(p.id)) return "a scene cannot name it; expected an id of letters, digits, _ . and - alone";
  return wrongDefault(p);
}

Verdict descriptorComplete(const Recipe& recipe, uint64_t) {
  auto made = Subject::make(recipe);
  if (!made) return made.error();
  const hsp_class& c = (*made)->description();
  if (std::string wrong = wrongTexts(c); !wrong.empty()) return wrong;
  for (uint32_t i = 0; i < c.param_count; ++i) {
    const hsp_param& p = paramAt(c, i);
    if (blank(p.id)) return "the parameter with index " + std::to_string(i) + " has no id; expected a name for scenes";
    if (const std::string wrong = wrongParam(p); !wrong.empty())
      return "parameter \"" + std::string(p.id) + "\": " + wrong;
  }
  return "";
}

/// Warns of live parameters that may change the force without consent, because a hand feels a stiffness that jumps as a
/// blow.
Verdict liveConsent(const Recipe& recipe, uint64_t) {
  const auto objection = [](const hsp_param& p) -> std::string {
    const std::string unit = p.unit != nullptr ? p.unit : "";
    const bool force = unit == "N" || unit == "N/m" || unit == "N s/m" || unit == "N m" || unit == "N m/rad";
    return force && (p.flags & HSP_P_LIVE) != 0 && (p.flags & HSP_P_SAFETY) == 0 ? p.id : "";
  };
  return warningOfParams(
      recipe, objection, ", ",
      " may change the force under a hand without anybody's consent; expected HSP_P_LIVE | HSP_P_SAFETY");
}

Verdict idUnique(const Recipe& recipe, uint64_t) {
  auto library = host::Library::open(recipe.file);
  if (!library) return library.error();
  auto entry = (*library)->shapes();
  if (!entry) return entry.error();
  std::set<std::string> ids;
  for (uint32_t i = 0; i < (*entry)->class_count; ++i) {
    const hsp_class* c = (*entry)->classes[i];
    if (c == nullptr) return "class " + std::to_string(i + 1) + " of hsp_plugin_entry.classes is NULL";
    if (!ids.insert(c->id).second || !ids.insert(c->name).second)
      return std::string("two classes of the file have the same id or name: ") + c->id + ", " + c->name;
    std::set<std::string> params;
    for (uint32_t k = 0; k < c->param_count; ++k)
      if (!params.insert(paramAt(*c, k).id).second)
        return "class " + std::string(c->name) + ": two parameters have the id " + paramAt(*c, k).id;
  }
  return "";
}

/// Measures the loading of the file. The fastest of three tries counts, because the machine may be busy or the disk
/// slow.
Verdict scanTimeLimit(const Recipe& recipe, uint64_t) {
  double least = HUGE_VAL;
  for (int i = 0; i < 3 && least >= 1; ++i) {
    const Nanoseconds begun = monotonicNow();
    auto library = host::Library::open(recipe.file);
    if (!library) return library.error();
    least = std::min(least, static_cast<double>(monotonicNow() - begun) * 1e-9);
  }
  return least < 1 ? ""
                   : "the file took " + text(least) +
                         " s to load; expected less than 1 s: do the work of static constructors in activate()";
}

Verdict unknownExtension(const Recipe& recipe, uint64_t) {
  const Made made(recipe);
  if (!made.error.empty()) return made.error;
  for (const char* name : {"", "hsp.nothing/1", "hsp.surfaces/999", "HSP.SURFACES/1"})
    if (made.subject->extension(name) != nullptr)
      return std::string("extension(\"") + name +
             "\") did not return NULL; expected NULL for every name that the shape does not know, compared whole";
  return "";
}

Verdict setOutOfRange(const Recipe& recipe, uint64_t) {
  auto made = Subject::make(recipe);
  if (!made) return made.error();
  const hsp_class& c = (*made)->description();
  for (uint32_t i = 0; i < c.param_count; ++i) {
    const hsp_param& p = paramAt(c, i);
    if (p.kind > HSP_ENUM) continue;
    const double most = p.kind == HSP_ENUM ? p.choice_count - 1.0 : p.kind == HSP_BOOL ? 1 : p.max;
    for (const double bad : {std::nan(""), p.kind == HSP_REAL || p.kind == HSP_INT ? p.min - 1 - std::abs(p.min) : -1,
                             most + 1 + std::abs(most)}) {
      if (std::isinf(bad)) continue;
      hsp_value value{}, before{}, after{};
      value.kind = p.kind;
      value.number = bad;
      c.get((*made)->handle(), i, &before);
      if (c.set((*made)->handle(), i, &value) >= 0)
        return "set() accepted " + text(bad) + " for " + p.id + ", which is out of its range; expected HSP_E_ARG";
      c.get((*made)->handle(), i, &after);
      if (after.number != before.number)
        return std::string(p.id) + " changed from " + text(before.number) + " to " + text(after.number) +
               " although set() refused the value " + text(bad) + "; expected the old value";
    }
  }
  hsp_value value{};
  value.kind = HSP_REAL;
  return c.set((*made)->handle(), c.param_count + 7, &value) >= 0
             ? "set() accepted a parameter index that does not exist; expected HSP_E_ARG"
             : "";
}

/// Returns a text about a parameter whose value was lost when another one was set, or "". This happens if two lines of
/// the parameter table name the same member.
std::string sharedMember(Subject& subject, const std::vector<double>& values, uint32_t set) {
  const hsp_class& c = subject.description();
  for (uint32_t i = 0; i < set; ++i) {
    hsp_value got{};
    if (std::isnan(values[i]) || c.get(subject.handle(), i, &got) < 0 || got.number == values[i]) continue;
    return std::string(paramAt(c, i).id) + " became " + text(got.number) + " when " + paramAt(c, set).id +
           " was set; expected a member of its own for each line of the table";
  }
  return "";
}

Verdict paramRoundtrip(const Recipe& recipe, uint64_t) {
  auto made = Subject::make(recipe);
  if (!made) return made.error();
  const hsp_class& c = (*made)->description();
  std::vector<double> values(c.param_count, std::nan(""));
  for (uint32_t i = 0; i < c.param_count; ++i) {
    const hsp_param& p = paramAt(c, i);
    if (p.kind > HSP_ENUM) continue;
    hsp_value value{}, got{};
    value.kind = p.kind;
    value.number = p.kind == HSP_REAL ? p.def + (0.25 + 0.003 * i) * (std::min(p.max, p.def + 1) - p.def) : p.def;
    if (c.set((*made)->handle(), i, &value) < 0)
      return "set() refused " + text(value.number) + " for " + p.id + ", which is in its range";
    if (c.get((*made)->handle(), i, &got) < 0 || got.number != value.number)
      return std::string(p.id) + " was set to " + text(value.number) + ", but get() returned " + text(got.number);
    if (std::string shared = sharedMember(**made, values, i); !shared.empty()) return shared;
    values[i] = value.number;
  }
  return "";
}

Verdict activateTwice(const Recipe& recipe, uint64_t) {
  const Made made(recipe);
  if (!made.error.empty()) return made.error;
  hsp_report report{};
  if (made.subject->activateRaw(1, report) >= 0)
    return "an active instance accepted a second activate(); expected HSP_E_STATE";
  const hsp_class& c = made.subject->description();
  hsp_value value{};
  if (c.param_count == 0) return "";
  value.kind = paramAt(c, 0).kind;
  value.number = paramAt(c, 0).def;
  value.text = "x";
  return c.set(made.subject->handle(), 0, &value) >= 0 ? "an active instance accepted set(); expected HSP_E_STATE" : "";
}

}  // namespace

std::vector<ConformanceTest> lifeTests() {
  return {
      {"scan-time-limit", "the file loads within a second", &scanTimeLimit},
      {"descriptor-complete", "every function, name, unit and default is there", &descriptorComplete},
      {"id-unique", "no id, name or parameter occurs twice", &idUnique},
      {"units", "units are SI", &unitsSi},
      {"live-force-consent", "what changes a force under a hand asks for consent", &liveConsent},
      {"unknown-extension-returns-null", "an unknown extension is NULL", &unknownExtension},
      {"set-out-of-range-rejected", "values out of range change nothing", &setOutOfRange},
      {"param-roundtrip", "get() returns what set() was given", &paramRoundtrip},
      {"activate-twice-rejected", "active instances refuse activate() and set()", &activateTwice},
  };
}

}  // namespace hapticd::conformance

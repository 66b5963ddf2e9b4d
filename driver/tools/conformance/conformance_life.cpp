// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>
#include <set>
#include <vector>

#include "base/clock.hpp"
#include "conformance/conformance_parts.hpp"

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

std::string descriptorComplete(const Recipe& recipe, uint64_t) {
  auto made = Subject::make(recipe);
  if (!made) return made.error();
  const hsp_class& c = (*made)->description();
  if (blank(c.id) || std::strchr(c.id, '.') == nullptr)
    return "id is not a reverse domain name; expected one such as org.example.sphere";
  if (blank(c.version) || blank(c.license) || blank(c.doc)) return "version, license or doc is missing";
  for (uint32_t i = 0; i < c.param_count; ++i) {
    const hsp_param& p = paramAt(c, i);
    if (blank(p.id)) return "parameter " + std::to_string(i) + " (from 0) has no id";
    if (blank(p.doc)) return std::string(p.id) + ": its doc is empty; expected a sentence";
    if (p.unit == nullptr) return std::string(p.id) + ": its unit is NULL; expected \"\" where it has none";
    if ((p.flags & HSP_P_LIVE) != 0 && p.kind > HSP_ENUM)
      return std::string(p.id) +
             ": HSP_P_LIVE on a path, text or list, which nothing can change while the shape is active; expected it on "
             "numbers, switches and choices alone";
    if (!plainId(p.id))
      return "parameter \"" + std::string(p.id) +
             "\": expected an id of letters, digits, _ . and - alone: a scene names it";
    const bool number = p.kind == HSP_REAL || p.kind == HSP_INT;
    if (number && !(p.min <= p.def && p.def <= p.max)) return std::string(p.id) + ": its default is out of its range";
    if (p.kind == HSP_ENUM && !(p.def >= 0 && p.def < p.choice_count))
      return std::string(p.id) + ": its default is not one of its choices";
  }
  return "";
}

/// Warns of live parameters that may change the force without consent, because a hand feels a stiffness that jumps as a
/// blow.
std::string liveConsent(const Recipe& recipe, uint64_t) {
  const auto objection = [](const hsp_param& p) -> std::string {
    const std::string unit = p.unit != nullptr ? p.unit : "";
    const bool force = unit == "N" || unit == "N/m" || unit == "N s/m" || unit == "N m" || unit == "N m/rad";
    return force && (p.flags & HSP_P_LIVE) != 0 && (p.flags & HSP_P_SAFETY) == 0 ? p.id : "";
  };
  return warningOfParams(
      recipe, objection, ", ",
      " may change the force under a hand without anybody's consent; expected HSP_P_LIVE | HSP_P_SAFETY");
}

std::string idUnique(const Recipe& recipe, uint64_t) {
  auto library = host::Library::open(recipe.file);
  if (!library) return library.error();
  auto entry = (*library)->shapes();
  if (!entry) return entry.error();
  std::set<std::string> ids;
  for (uint32_t i = 0; i < (*entry)->class_count; ++i) {
    const hsp_class* c = (*entry)->classes[i];
    if (c == nullptr) return "a class is NULL";
    if (!ids.insert(c->id).second || !ids.insert(c->name).second)
      return std::string("two classes have the same id or name: ") + c->id;
    std::set<std::string> params;
    for (uint32_t k = 0; k < c->param_count; ++k)
      if (!params.insert(paramAt(*c, k).id).second)
        return std::string("two parameters have the same id: ") + paramAt(*c, k).id;
  }
  return "";
}

/// Measures the loading of the file. The fastest of three tries counts, because the machine may be busy or the disk
/// slow.
std::string scanTimeLimit(const Recipe& recipe, uint64_t) {
  double least = HUGE_VAL;
  for (int i = 0; i < 3 && least >= 1; ++i) {
    const Nanoseconds begun = monotonicNow();
    auto library = host::Library::open(recipe.file);
    if (!library) return library.error();
    least = std::min(least, static_cast<double>(monotonicNow() - begun) * 1e-9);
  }
  return least < 1 ? "" : "loading took " + text(least) + " s; expected less than 1 s";
}

std::string unknownExtension(const Recipe& recipe, uint64_t) {
  const Made made(recipe);
  if (!made.error.empty()) return made.error;
  for (const char* name : {"", "hsp.nothing/1", "hsp.surfaces/999", "HSP.SURFACES/1"})
    if (made.subject->extension(name) != nullptr) return std::string("extension \"") + name + "\" is not NULL";
  return "";
}

std::string setOutOfRange(const Recipe& recipe, uint64_t) {
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
      if (c.set((*made)->handle(), i, &value) >= 0) return std::string(p.id) + " took " + text(bad);
      c.get((*made)->handle(), i, &after);
      if (after.number != before.number) return std::string(p.id) + " was changed by a refused value";
    }
  }
  hsp_value value{};
  value.kind = HSP_REAL;
  return c.set((*made)->handle(), c.param_count + 7, &value) >= 0 ? "set() accepted a parameter that does not exist"
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

std::string paramRoundtrip(const Recipe& recipe, uint64_t) {
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
    if (c.set((*made)->handle(), i, &value) < 0) return std::string(p.id) + " refused " + text(value.number);
    if (c.get((*made)->handle(), i, &got) < 0 || got.number != value.number)
      return std::string(p.id) + " returned " + text(got.number) + " for " + text(value.number);
    if (std::string shared = sharedMember(**made, values, i); !shared.empty()) return shared;
    values[i] = value.number;
  }
  return "";
}

std::string activateTwice(const Recipe& recipe, uint64_t) {
  const Made made(recipe);
  if (!made.error.empty()) return made.error;
  hsp_report report{};
  if (made.subject->activateRaw(1, report) >= 0) return "a second activate() was accepted";
  const hsp_class& c = made.subject->description();
  hsp_value value{};
  if (c.param_count == 0) return "";
  value.kind = paramAt(c, 0).kind;
  value.number = paramAt(c, 0).def;
  value.text = "x";
  return c.set(made.subject->handle(), 0, &value) >= 0 ? "set() was accepted while active" : "";
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

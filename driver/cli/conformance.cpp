#include "cli/conformance.hpp"

#include <malloc.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <random>
#include <set>

#include "base/clock.hpp"
#include "cli/lock_count.hpp"
#include "servo/claim.hpp"
#include "servo/guard.hpp"

namespace hapticd::cli {

namespace {

using Eigen::Vector3d;
constexpr double kDt = 1e-3;
constexpr int kSteps = 2000;

/// Gives an instance, or is why there is none.
struct Made {
  std::unique_ptr<Subject> subject;
  std::string error;
  explicit Made(const Recipe& recipe, uint32_t probes = 1) {
    auto made = Subject::make(recipe);
    if (!made) {
      error = made.error();
      return;
    }
    subject = std::move(*made);
    if (auto active = subject->activate(probes); !active) error = active.error();
  }
};

std::string text(double value) {
  char words[32];
  std::snprintf(words, sizeof words, "%.6g", value);
  return words;
}

/// A smooth closed path through and around the shape, from a corner outside its box and back to it.
Vector3d onPath(const Subject& subject, double part, double phase = 0) {
  const auto [low, high] = subject.bounds();
  const Vector3d half = 0.65 * (high - low).cwiseMax(1e-3), middle = (low + high) / 2;
  const double angle = 2 * M_PI * part;
  return middle +
         half.cwiseProduct(Vector3d(std::cos(angle + phase), std::cos(2 * angle + phase), std::cos(3 * angle - phase)));
}

const hsp_param& paramAt(const hsp_class& c, uint32_t i) {
  return *HSP_AT(const hsp_param, c.params, c.params[0].struct_size, i);
}

bool blank(const char* words) {
  return words == nullptr || words[0] == '\0';
}

std::string descriptorComplete(const Recipe& recipe, uint64_t) {
  auto made = Subject::make(recipe);
  if (!made) return made.error();
  const hsp_class& c = (*made)->description();
  if (blank(c.id) || std::strchr(c.id, '.') == nullptr) return "id is no reverse domain name";
  if (blank(c.version) || blank(c.license) || blank(c.doc)) return "version, license or doc is missing";
  for (uint32_t i = 0; i < c.param_count; ++i) {
    const hsp_param& p = paramAt(c, i);
    if (blank(p.id) || blank(p.doc) || p.unit == nullptr)
      return "parameter " + std::to_string(i) + " lacks id, unit or doc";
    const bool number = p.kind == HSP_REAL || p.kind == HSP_INT;
    if (number && !(p.min <= p.def && p.def <= p.max)) return std::string(p.id) + ": its default is out of its range";
    if (p.kind == HSP_ENUM && !(p.def >= 0 && p.def < p.choice_count))
      return std::string(p.id) + ": its default is no choice";
  }
  return "";
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
    if (!ids.insert(c->id).second || !ids.insert(c->name).second) return std::string("id or name twice: ") + c->id;
    std::set<std::string> params;
    for (uint32_t k = 0; k < c->param_count; ++k)
      if (!params.insert(paramAt(*c, k).id).second) return std::string("parameter twice: ") + paramAt(*c, k).id;
  }
  return "";
}

std::string scanTimeLimit(const Recipe& recipe, uint64_t) {
  const Nanoseconds begun = monotonicNow();
  auto library = host::Library::open(recipe.file);
  if (!library) return library.error();
  const double seconds = static_cast<double>(monotonicNow() - begun) * 1e-9;
  return seconds < 1 ? "" : "loading took " + text(seconds) + " s; expected less than 1 s";
}

std::string unknownExtension(const Recipe& recipe, uint64_t) {
  const Made made(recipe);
  if (!made.error.empty()) return made.error;
  for (const char* name : {"", "hsp.nothing/1", "hsp.surfaces/999", "HSP.SURFACES/1"})
    if (made.subject->extension(name) != nullptr) return std::string("extension \"") + name + "\" is not NULL";
  return "";
}

std::string createDestroyLeak(const Recipe& recipe, uint64_t) {
  constexpr int kMost = 60;
  constexpr Nanoseconds kEnough = 3 * kNanosecondsPerSecond;
  const Nanoseconds begun = monotonicNow();
  size_t warm = 0;
  int cycles = 0;
  for (int i = 0; i < kMost && monotonicNow() - begun < kEnough; ++i) {
    const Made made(recipe);
    if (!made.error.empty()) return made.error;
    for (int k = 0; k < 20; ++k) made.subject->step({onPath(*made.subject, k / 40.0)}, kDt);
    if (i == 4) warm = mallinfo2().uordblks;
    cycles = i - 4;
  }
  if (cycles < 2) return "skip: activation takes too long to repeat it";
  const double leak = (static_cast<double>(mallinfo2().uordblks) - static_cast<double>(warm)) / cycles;
  return leak < 256 ? "" : text(leak) + " bytes are lost in each life";
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
  return c.set((*made)->handle(), c.param_count + 7, &value) >= 0 ? "set() took a parameter that is not there" : "";
}

std::string paramRoundtrip(const Recipe& recipe, uint64_t) {
  auto made = Subject::make(recipe);
  if (!made) return made.error();
  const hsp_class& c = (*made)->description();
  for (uint32_t i = 0; i < c.param_count; ++i) {
    const hsp_param& p = paramAt(c, i);
    if (p.kind > HSP_ENUM) continue;
    hsp_value value{}, got{};
    value.kind = p.kind;
    value.number = p.kind == HSP_REAL ? p.def + 0.25 * (std::min(p.max, p.def + 1) - p.def) : p.def;
    if (c.set((*made)->handle(), i, &value) < 0) return std::string(p.id) + " refused " + text(value.number);
    if (c.get((*made)->handle(), i, &got) < 0 || got.number != value.number)
      return std::string(p.id) + " gave back " + text(got.number) + " for " + text(value.number);
  }
  return "";
}

std::string activateTwice(const Recipe& recipe, uint64_t) {
  const Made made(recipe);
  if (!made.error.empty()) return made.error;
  hsp_report report{};
  if (made.subject->activateRaw(1, report) >= 0) return "a second activate() was not refused";
  const hsp_class& c = made.subject->description();
  hsp_value value{};
  if (c.param_count == 0) return "";
  value.kind = paramAt(c, 0).kind;
  value.number = paramAt(c, 0).def;
  value.text = "x";
  return c.set(made.subject->handle(), 0, &value) >= 0 ? "set() was not refused while active" : "";
}

/// Runs along the path and hands every answer to `look`; its first objection ends the run.
std::string along(Subject& subject, const std::function<std::string(const Answer&, const Vector3d&)>& look,
                  int steps = kSteps) {
  for (int i = 0; i <= steps; ++i) {
    const Vector3d p = onPath(subject, static_cast<double>(i) / steps);
    const Answer& answer = subject.step({p}, kDt);
    if (std::string objection = look(answer, p); !objection.empty()) return objection + " at step " + std::to_string(i);
  }
  return "";
}

std::string noAllocation(const Recipe& recipe, uint64_t) {
  const Made made(recipe);
  if (!made.error.empty()) return made.error;
  along(*made.subject, [](const Answer&, const Vector3d&) { return ""; });
  const uint64_t count = made.subject->allocations();
  return count == 0 ? "" : std::to_string(count) + " allocations in " + std::to_string(kSteps) + " steps";
}

std::string noLock(const Recipe& recipe, uint64_t) {
  const Made made(recipe);
  if (!made.error.empty()) return made.error;
  if (!countLocksOf(recipe.file)) return "skip: the file calls no lock at all, or cannot be looked into";
  uint64_t locks = 0;
  for (int i = 0; i < kSteps; ++i) {
    const Vector3d p = onPath(*made.subject, static_cast<double>(i) / kSteps);
    const uint64_t before = locksCounted();
    made.subject->step({p}, kDt);
    locks += i % 5 != 0 ? locksCounted() - before : 0;  // searches belong to another thread, which may lock
  }
  return locks == 0 ? "" : std::to_string(locks) + " locks in " + std::to_string(kSteps) + " steps";
}

std::string stepCost(const Recipe& recipe, uint64_t) {
  const Made made(recipe);
  if (!made.error.empty()) return made.error;
  const uint64_t claim = std::max(made.subject->report().worst_ns, made.subject->report().typical_ns);
  if (claim == 0) return "skip: the plugin claims no cost";
  std::vector<uint64_t> spent;
  along(*made.subject, [&](const Answer&, const Vector3d&) {
    spent.push_back(made.subject->stepNs());
    return "";
  });
  std::nth_element(spent.begin(), spent.begin() + static_cast<long>(spent.size() / 2), spent.end());
  const uint64_t p50 = spent[spent.size() / 2];
  return p50 <= claim
             ? ""
             : "a step takes " + std::to_string(p50) + " ns (median); its worst is claimed as " + std::to_string(claim);
}

std::string wrongStatus(const Answer& answer) {
  const bool known = answer.status == HSP_OK || answer.status == HSP_DEGRADED || answer.status == HSP_E_NUMERIC;
  if (!known) return "status " + std::to_string(answer.status);
  return finite(answer) ? "" : "an answer that is not finite";
}

std::string finiteOutputs(const Recipe& recipe, uint64_t seed) {
  const Made made(recipe);
  if (!made.error.empty()) return made.error;
  const auto look = [](const Answer& answer, const Vector3d&) { return wrongStatus(answer); };
  if (std::string wrong = along(*made.subject, look); !wrong.empty()) return wrong;
  std::mt19937_64 random(seed);
  std::normal_distribution<double> step(0, 1e-3);
  Vector3d p = onPath(*made.subject, 0.3);
  for (int i = 0; i < kSteps; ++i) {
    p += Vector3d(step(random), step(random), step(random));
    if (std::string wrong = wrongStatus(made.subject->step({p}, kDt)); !wrong.empty())
      return wrong + " on a random walk";
  }
  hsp_probe bad{};
  for (double& x : bad.position) x = std::nan("");
  bad.orientation[0] = 1;
  bad.flags = HSP_IN_INVALID;
  const Answer& answer = made.subject->stepRaw(bad, kDt);
  if (!finite(answer)) return "a bad sample leads to an answer that is not finite";
  if (Vector3d(answer.contacts[0].force).norm() > 0) return "a bad sample is pushed";
  if (std::string wrong = wrongStatus(made.subject->step({p}, kDt)); !wrong.empty())
    return wrong + " after a bad sample";
  return "";
}

std::string forceContinuous(const Recipe& recipe, uint64_t) {
  const Made made(recipe);
  if (!made.error.empty()) return made.error;
  if (!(made.subject->report().max_stiffness > 0)) return "skip: no stiffness is claimed";
  servo::Claim claim;
  int jumps = 0;
  Vector3d last = Vector3d::Zero();
  return along(*made.subject, [&](const Answer& answer, const Vector3d& p) {
    hsp_probe in{};
    Eigen::Map<Vector3d>(in.velocity) = (p - last) / kDt;
    last = p;
    jumps += claim.judge(made.subject->report(), in, answer.contacts[0], p) < 1 ? 1 : 0;
    return std::string(jumps >= 3 ? "the force jumped beyond the claimed stiffness three times" : "");
  });
}

std::string normalUnit(const Recipe& recipe, uint64_t) {
  const Made made(recipe);
  if (!made.error.empty()) return made.error;
  return along(*made.subject, [](const Answer& answer, const Vector3d&) {
    const hsp_contact& c = answer.contacts[0];
    const double norm = Vector3d(c.normal).norm();
    const bool traced = (c.flags & HSP_OUT_TRACED) != 0;
    return traced && std::abs(norm - 1) > 1e-6 ? "a normal of length " + text(norm) : std::string();
  });
}

std::string energyNonIncreasing(const Recipe& recipe, uint64_t) {
  const Made made(recipe);
  if (!made.error.empty()) return made.error;
  const double before = made.subject->energy();
  if (made.subject->moves() && std::isnan(before)) return "skip: it moves and does not say what it stores";
  double given = 0, moved = 0;
  Vector3d last = onPath(*made.subject, 0), force = Vector3d::Zero();
  constexpr int kSlow = 20000;
  along(
      *made.subject,
      [&](const Answer& answer, const Vector3d& p) {
        const Vector3d now(answer.contacts[0].force);
        given += 0.5 * (force + now).dot(p - last);
        moved += std::abs(0.5 * (force + now).dot(p - last));
        last = p;
        force = now;
        return "";
      },
      kSlow);
  if (made.subject->moves()) return "";  // gravity and the hand both work on it: bounded by the test of its own energy
  const double gained = std::isnan(before) ? 0 : made.subject->energy() - before;
  constexpr double kRounding = 0.02;  // of the work that went to and fro: the path is walked in steps
  const double allowed = kRounding * moved + 1e-6 - gained;
  return given <= allowed ? "" : "a closed path gave " + text(given) + " J to the hand of " + text(moved) + " J moved";
}

/// The answers of one instance along the path.
std::vector<Answer> answersOf(Subject& subject, int steps, double phase = 0) {
  std::vector<Answer> answers;
  for (int i = 0; i < steps; ++i)
    answers.push_back(subject.step({onPath(subject, static_cast<double>(i) / kSteps, phase)}, kDt));
  return answers;
}

std::string firstDifference(const std::vector<Answer>& a, const std::vector<Answer>& b) {
  for (size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    if (!sameBits(a[i], b[i])) return "answers differ from step " + std::to_string(i) + " on";
  return "";
}

std::string resetEqualsFresh(const Recipe& recipe, uint64_t) {
  const Made used(recipe), fresh(recipe);
  if (!used.error.empty()) return used.error;
  if (used.subject->moves()) return "skip: it moves; reset() forgets contacts, not where it is";
  answersOf(*used.subject, kSteps / 2, 0.7);
  used.subject->reset();
  const auto a = answersOf(*used.subject, kSteps / 4), b = answersOf(*fresh.subject, kSteps / 4);
  for (size_t i = 0; i < a.size(); ++i) {
    const double apart = (Vector3d(a[i].contacts[0].force) - Vector3d(b[i].contacts[0].force)).norm();
    if (!(apart <= 1e-6 * (1 + Vector3d(b[i].contacts[0].force).norm())))
      return "after reset() the force differs by " + text(apart) + " N at step " + std::to_string(i);
  }
  return "";
}

std::string batchEqualsSingle(const Recipe& recipe, uint64_t) {
  const Made batch(recipe, 2), one(recipe), two(recipe);
  if (!batch.error.empty()) return "two probes: " + batch.error;
  if (batch.subject->moves() || (batch.subject->description().flags & HSP_C_DEFORMS) != 0)
    return "skip: probes touch each other through what moves or deforms";
  for (int i = 0; i < kSteps; ++i) {
    const double part = static_cast<double>(i) / kSteps;
    const Vector3d p = onPath(*batch.subject, part), q = onPath(*batch.subject, part, 1.1);
    const Answer both = batch.subject->step({p, q}, kDt);
    const Answer &a = one.subject->step({p}, kDt), &b = two.subject->step({q}, kDt);
    if (std::memcmp(&both.contacts[0], &a.contacts[0], sizeof(hsp_contact)) != 0 ||
        std::memcmp(&both.contacts[1], &b.contacts[0], sizeof(hsp_contact)) != 0)
      return "two probes in one step are answered otherwise than alone, at step " + std::to_string(i);
  }
  return "";
}

std::string determinism(const Recipe& recipe, uint64_t) {
  const Made first(recipe), second(recipe);
  if (!first.error.empty()) return first.error;
  return firstDifference(answersOf(*first.subject, kSteps), answersOf(*second.subject, kSteps));
}

std::string jumpFlag(const Recipe& recipe, uint64_t seed) {
  const Made made(recipe);
  if (!made.error.empty()) return made.error;
  if (made.subject->moves() || (made.subject->description().flags & HSP_C_DEFORMS) != 0)
    return "skip: what moves or deforms remembers where it was touched";
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> part(0, 1);
  for (int i = 0; i < 100; ++i) {
    const Vector3d p = onPath(*made.subject, part(random), part(random));
    const double jumped = made.subject->step({p}, kDt, HSP_IN_JUMP).contacts[0].depth_m;
    const Made fresh(recipe);
    const double alone = fresh.subject->step({p}, kDt).contacts[0].depth_m;
    if (!(std::abs(jumped - alone) <= 1e-4 * (1e-2 + std::abs(alone))))
      return "after a jump the depth is " + text(jumped) + " m, of a fresh instance " + text(alone) + " m";
  }
  return "";
}

std::string stateRoundtrip(const Recipe& recipe, uint64_t) {
  auto first = Subject::make(recipe), second = Subject::make(recipe);
  if (!first) return first.error();
  const auto* state = static_cast<const hsp_ext_state*>((*first)->extension(HSP_EXT_STATE));
  if (state == nullptr) return "skip: no state extension";
  if (auto active = (*first)->activate(); !active) return active.error();
  answersOf(**first, kSteps / 2);
  (*first)->deactivate();
  std::vector<char> bytes(static_cast<size_t>(std::max<int64_t>(0, state->save((*first)->handle(), nullptr, 0))));
  state->save((*first)->handle(), bytes.data(), bytes.size());
  if (state->load((*second)->handle(), bytes.data(), bytes.size()) < 0) return "load() refused what save() wrote";
  std::vector<char> again(bytes.size());
  const int64_t size = state->save((*second)->handle(), again.data(), again.size());
  return size == static_cast<int64_t>(bytes.size()) && bytes == again ? "" : "what was loaded is saved otherwise";
}

std::string stateGarbage(const Recipe& recipe, uint64_t seed) {
  auto made = Subject::make(recipe);
  if (!made) return made.error();
  const auto* state = static_cast<const hsp_ext_state*>((*made)->extension(HSP_EXT_STATE));
  if (state == nullptr) return "skip: no state extension";
  std::mt19937_64 random(seed);
  for (const size_t size : {0u, 1u, 7u, 64u, 1000u}) {
    std::vector<char> bytes(size);
    for (char& byte : bytes) byte = static_cast<char>(random());
    if (state->load((*made)->handle(), bytes.data(), bytes.size()) >= 0)
      return "load() took " + std::to_string(size) + " bytes of garbage";
  }
  return "";
}

std::string denormals(const Recipe& recipe, uint64_t) {
  const Made made(recipe);
  if (!made.error.empty()) return made.error;
  for (const double tiny : {0.0, -0.0, 5e-324, 1e-310, -1e-310, 1e-160}) {
    hsp_probe probe{};
    probe.orientation[0] = 1;
    for (int i = 0; i < 3; ++i) probe.position[i] = probe.velocity[i] = tiny * (i + 1);
    for (int i = 0; i < 10; ++i)
      if (std::string wrong = wrongStatus(made.subject->stepRaw(probe, kDt)); !wrong.empty())
        return wrong + " for a probe at " + text(tiny);
  }
  return "";
}

std::string twoInstances(const Recipe& recipe, uint64_t) {
  const Made alone(recipe), first(recipe), second(recipe);
  if (!alone.error.empty()) return alone.error;
  const auto expected = answersOf(*alone.subject, kSteps / 2);
  std::vector<Answer> mixed;
  for (int i = 0; i < kSteps / 2; ++i) {
    const double part = static_cast<double>(i) / kSteps;
    mixed.push_back(first.subject->step({onPath(*first.subject, part)}, kDt));
    second.subject->step({onPath(*second.subject, part, 2.1)}, kDt);
  }
  return firstDifference(expected, mixed);
}

std::string layoutGolden(const Recipe& recipe, uint64_t) {
  const Made made(recipe), wide(recipe);
  if (!made.error.empty()) return made.error;
  const hsp_class& c = made.subject->description();
  if (c.struct_size < offsetof(hsp_class, extension)) return "hsp_class is smaller than that of version 1.0";
  if (c.param_count > 0 && c.params[0].struct_size < sizeof(hsp_param))
    return "hsp_param is smaller than that of version 1.0";
  if (made.subject->report().struct_size != sizeof(hsp_report)) return "activate() changed report.struct_size";
  wide.subject->widen(32);  // as a later host does, whose records are larger
  for (int i = 0; i < kSteps / 4; ++i) {
    const Vector3d p = onPath(*made.subject, static_cast<double>(i) / kSteps);
    const Answer expected = made.subject->step({p}, kDt);
    if (!sameBits(expected, wide.subject->step({p}, kDt))) return "larger records are answered otherwise: use HSP_AT";
    if (!wide.subject->roomUntouched()) return "it wrote beyond hsp_contact";
  }
  return "";
}

}  // namespace

const std::vector<ConformanceTest>& conformanceTests() {
  static const std::vector<ConformanceTest> kTests = {
      {"scan-time-limit", "the file loads within a second", &scanTimeLimit},
      {"descriptor-complete", "every function, name, unit and default is there", &descriptorComplete},
      {"id-unique", "no id, name or parameter occurs twice", &idUnique},
      {"layout-golden", "structs have at least their first size, and strides are used", &layoutGolden},
      {"unknown-extension-returns-null", "an extension that nobody knows is NULL", &unknownExtension},
      {"create-destroy-leak", "a life leaves no memory behind", &createDestroyLeak},
      {"set-out-of-range-rejected", "values out of range change nothing", &setOutOfRange},
      {"param-roundtrip", "what is set is got", &paramRoundtrip},
      {"activate-twice-rejected", "active instances refuse activate() and set()", &activateTwice},
      {"no-allocation-in-step", "steps do not allocate", &noAllocation},
      {"no-lock-in-step", "steps do not lock", &noLock},
      {"step-cost-vs-claim", "steps take no longer than claimed", &stepCost},
      {"finite-outputs", "every answer is finite, whatever the probe does", &finiteOutputs},
      {"force-continuous", "forces follow the claimed stiffness", &forceContinuous},
      {"normal-unit-length", "normals are unit vectors", &normalUnit},
      {"energy-non-increasing", "a closed path gives no energy", &energyNonIncreasing},
      {"reset-equals-fresh", "reset() forgets", &resetEqualsFresh},
      {"batch-equals-single", "probes of one step do not mix", &batchEqualsSingle},
      {"determinism-bitwise", "same input, same bits", &determinism},
      {"jump-flag", "after a jump the nearest foot is found", &jumpFlag},
      {"state-roundtrip", "state that is saved can be loaded", &stateRoundtrip},
      {"state-garbage-rejected", "state that is none is refused", &stateGarbage},
      {"denormals", "tiny numbers are numbers", &denormals},
      {"two-instances-independent", "instances do not know of each other", &twoInstances},
  };
  return kTests;
}

std::string fuzzOnce(const Recipe& recipe, uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  auto made = Subject::make(recipe);
  if (!made) return made.error();
  const hsp_class& c = (*made)->description();
  for (uint32_t i = 0; i < c.param_count; ++i) {
    const hsp_param& p = paramAt(c, i);
    if (p.kind > HSP_ENUM || recipe.set.count(p.id) > 0 || unit(random) < 0.5) continue;
    hsp_value value{};
    value.kind = p.kind;
    const double most = p.kind == HSP_ENUM ? p.choice_count - 1.0 : p.max, least = p.kind == HSP_ENUM ? 0 : p.min;
    value.number = least + unit(random) * (most - least);
    if (p.kind != HSP_REAL) value.number = std::floor(value.number);
    if (!std::isfinite(value.number)) continue;
    if (c.set((*made)->handle(), i, &value) < 0)
      return std::string(p.id) + " refused " + text(value.number) + ", which is in its range";
  }
  if (!(*made)->activate()) return "";  // parameters may contradict each other: refusing is right
  const auto [low, high] = (*made)->bounds();
  Vector3d q = onPath(**made, unit(random), unit(random));
  for (int i = 0; i < 500; ++i) {
    const double dice = unit(random);
    uint32_t flags = 0;
    if (dice < 0.02) {
      (*made)->reset();
    } else if (dice < 0.05) {
      flags = HSP_IN_JUMP;
      q = low + Vector3d(unit(random), unit(random), unit(random)).cwiseProduct(high - low);
    } else if (dice < 0.07) {
      flags = HSP_IN_INVALID;
    }
    q += 2e-3 * Vector3d(unit(random) - 0.5, unit(random) - 0.5, unit(random) - 0.5);
    const double dt = dice > 0.98 ? 0.05 : kDt;
    if (std::string wrong = wrongStatus((*made)->step({q}, dt, flags)); !wrong.empty())
      return wrong + " at step " + std::to_string(i);
  }
  return "";
}

}  // namespace hapticd::cli

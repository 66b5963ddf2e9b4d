// SPDX-License-Identifier: MIT
#include "import/indentation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "document/csv.hpp"
#include "import/active_model.hpp"

namespace hapticd::importing {
namespace {

using Eigen::Vector3d;

constexpr double kPress = 1e-4;    ///< [m] depth to which both probes press
constexpr double kTick = 1e-3;     ///< [s] duration of a tick
constexpr int kMostTicks = 4000;   ///< largest number of ticks until both forces settle
constexpr int kQuiet = 20;         ///< number of ticks without a change after which forces count as settled
constexpr double kSettled = 1e-7;  ///< relative change of a force that counts as no change
constexpr int kLooks = 12;         ///< number of shear reaches that are tried before the best one is refined
constexpr int kRefinements = 14;   ///< steps of the golden section search
constexpr double kGolden = 0.61803398874989485;

double along(const hsp_contact& contact) {
  return Vector3d(contact.force).dot(Vector3d(contact.normal));
}

/// Presses with both probes until their forces settle.
Result<std::array<hsp_contact, 2>> heldTogether(host::ShapeInstance& body, const std::array<Vector3d, 2>& at) {
  std::array<hsp_probe, 2> probes{};
  std::array<hsp_contact, 2> contacts{};
  std::array<double, 2> before{0, 0};
  for (int tick = 0, quiet = 0; tick < kMostTicks && quiet < kQuiet; ++tick) {
    for (std::size_t i = 0; i < 2; ++i) {
      Eigen::Map<Vector3d>(probes[i].position) = at[i];
      probes[i].orientation[0] = 1;
      probes[i].time_ns = static_cast<uint64_t>(1e9 * kTick * (tick + 1));
      probes[i].flags = tick == 0 ? HSP_IN_JUMP : 0;
    }
    contacts = {};
    hsp_step step{};
    step.struct_size = sizeof step;
    step.count = 2;
    step.in = probes.data();
    step.out = contacts.data();
    step.in_stride = sizeof(hsp_probe);
    step.out_stride = sizeof(hsp_contact);
    step.dt_s = kTick;
    if (body.step(step) < 0) return Error{"the plugin gives no distance to the body"};
    bool same = true;
    for (std::size_t i = 0; i < 2; ++i) {
      const double force = along(contacts[i]);
      same = same && std::fabs(force - before[i]) <= kSettled * std::fabs(force);
      before[i] = force;
    }
    quiet = same ? quiet + 1 : 0;
  }
  return contacts;
}

/// Measures the share of one dent. A single probe feels the stiffness of its place; with two probes, each place also
/// sinks by the press of the other.
Result<double> measureIndentation(host::ShapeInstance& body, const Indentation& dent) {
  std::array<Vector3d, 2> at;
  std::array<double, 2> stiffness{};
  for (std::size_t i = 0; i < 2; ++i) {
    body.reset();
    const auto foot = touched(body, i == 0 ? dent.pressed : dent.beside);
    if (!foot) return Error{foot.error()};
    at[i] = Vector3d(foot->point) - kPress * Vector3d(foot->normal);
    body.reset();
    const auto pressed = touched(body, at[i]);
    if (!pressed) return Error{pressed.error()};
    stiffness[i] = along(*pressed) / kPress;
  }
  body.reset();
  const auto both = heldTogether(body, at);
  if (!both) return Error{both.error()};
  const double force = along((*both)[0]), other = along((*both)[1]);
  if (!(force > 0) || !(stiffness[1] > 0))
    return Error{"the body gives no force at one of the two places; expected places on its surface, in m"};
  return (kPress - other / stiffness[1]) * stiffness[0] / force;
}

}  // namespace

Result<std::vector<Indentation>> readIndentations(const std::string& file) {
  document::Problems problems;
  document::CsvRules rules;
  rules.headers = {"x,y,z,x2,y2,z2,dent"};
  const auto table = document::readCsv(file, kMostTableBytes, rules, problems);
  if (!table || table->rows() == 0)
    return Error{problems.empty() ? file + ": the file has no rows; expected x,y,z,x2,y2,z2,dent"
                                  : problems.front().text()};
  std::vector<Indentation> dents;
  for (std::size_t i = 0; i < table->rows(); ++i) {
    const double* row = table->row(i);
    if (!(row[6] < 1) || !(row[6] > -1))
      return Error{fmt::format("{}:{}: the dent is {}; expected a share of the depth between -1 and 1", file,
                               table->lines[i], row[6])};
    dents.push_back({Vector3d(row), Vector3d(row + 3), row[6]});
  }
  return dents;
}

Result<std::vector<double>> measureIndentations(const std::string& file, const std::vector<Indentation>& dents,
                                                host::Catalog& catalog) {
  const auto body = activated("mat_deformable", file, catalog, ", dynamics: felt", 2);
  if (!body) return Error{body.error()};
  for (uint32_t i = 0; i < 2; ++i) {
    hsp_near near{};
    near.probe = i;
    if ((*body)->surfaces()->activate((*body)->handle(), &near) < 0) return Error{"the body cannot be traced"};
  }
  std::vector<double> shares;
  for (const Indentation& dent : dents) {
    const auto share = measureIndentation(**body, dent);
    if (!share) return Error{share.error()};
    shares.push_back(*share);
  }
  return shares;
}

Result<ReachFit> fitReach(const std::string& file, double most, const std::vector<Indentation>& dents,
                          const std::function<Result<void>(double)>& write, host::Catalog& catalog) {
  ReachFit best;
  double least = HUGE_VAL;
  std::string failed;
  const auto squares = [&](double reach) {
    if (const auto done = write(reach); !done) failed = done.error();
    if (!failed.empty()) return HUGE_VAL;
    auto shares = measureIndentations(file, dents, catalog);
    if (!shares) failed = shares.error();
    if (!shares) return HUGE_VAL;
    double sum = 0;
    for (std::size_t i = 0; i < dents.size(); ++i) sum += std::pow((*shares)[i] - dents[i].share, 2);
    if (sum < least) best = {reach, std::move(*shares)};
    least = std::min(least, sum);
    return sum;
  };
  for (int i = 0; i <= kLooks && failed.empty(); ++i) squares(most * i / kLooks);
  double low = std::max(0.0, best.reach - most / kLooks), high = std::min(most, best.reach + most / kLooks);
  for (int i = 0; i < kRefinements && failed.empty(); ++i) {
    const double a = high - kGolden * (high - low), b = low + kGolden * (high - low);
    if (squares(a) < squares(b)) {
      high = b;
    } else {
      low = a;
    }
  }
  if (!failed.empty()) return Error{failed};
  return best;
}

}  // namespace hapticd::importing

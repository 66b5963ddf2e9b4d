// SPDX-License-Identifier: MIT
#include "kernels/medial/deformation.hpp"

#include <algorithm>

#include "kernels/spline/basis.hpp"

namespace hapticd::medial {
namespace {

using Eigen::Vector4d;

Influence whole(std::span<const double> basis, int span) noexcept {
  Influence all;
  all.count = static_cast<int>(basis.size());
  all.first = span - all.count + 1;
  std::copy(basis.begin(), basis.end(), all.basis.begin());
  return all;
}

std::size_t total(const ControlGrid& grid) {
  return static_cast<std::size_t>(grid.count[0]) * static_cast<std::size_t>(grid.count[1]);
}

/// The control points of an influence each way, with the products of their weights.
template <class Weights>
void list(const std::array<Influence, 2>& influence, int columns, Weights weights, auto& out) noexcept {
  out.count = 0;
  for (int i = 0; i < influence[0].count; ++i)
    for (int j = 0; j < influence[1].count; ++j)
      out.parts[out.count++] = {
          static_cast<uint32_t>((influence[0].first + i) * columns + influence[1].first + j),
          (influence[0].*weights)[static_cast<std::size_t>(i)] * (influence[1].*weights)[static_cast<std::size_t>(j)]};
}

/// Basis functions of one direction and their derivatives at a parameter.
struct Basis {
  std::array<double, spline::kMaxDegree + 1> value{}, slope{};
  int first = 0, count = 0;

  Basis(const ControlGrid& grid, std::size_t axis, double t) noexcept {
    const std::vector<double>& knots = grid.knots[axis];
    const int degree = grid.degree[axis], span = spline::findSpan(knots, degree, t);
    first = span - degree;
    count = degree + 1;
    spline::basisFunctions(knots, degree, span, t, value);
    if (degree == 0) return;
    std::array<double, spline::kMaxDegree + 1> lower{};  // of one degree less: N_(first + 1) and on
    spline::basisFunctions(knots, degree - 1, span, t, lower);
    for (int i = 0; i < count; ++i) {  // Piegl & Tiller, Eq. 2.7
      const auto at = static_cast<std::size_t>(first + i), next = static_cast<std::size_t>(first + i + 1);
      const double left = knots[at + static_cast<std::size_t>(degree)] - knots[at];
      const double right = knots[next + static_cast<std::size_t>(degree)] - knots[next];
      const auto k = static_cast<std::size_t>(i);
      if (i > 0 && left > 0) slope[k] += degree / left * lower[k - 1];
      if (i < degree && right > 0) slope[k] -= degree / right * lower[k];
    }
  }
};

constexpr std::size_t kWidest = 11;  ///< control points of one direction in a place: 11 x 11 fit a FeltPlace
static_assert(kWidest * kWidest <= FeltPlace::kMost);

/// Shares of control points in a place and their derivatives.
struct Shares {
  std::array<double, kWidest> value{}, slope{};
  int first = 0, count = 0;

  void add(const Basis& basis, double part, bool follows) noexcept {
    const int from = basis.first - first;
    for (int i = 0; i < basis.count && static_cast<std::size_t>(from + i) < kWidest; ++i) {
      const auto to = static_cast<std::size_t>(from + i), k = static_cast<std::size_t>(i);
      value[to] += part * basis.value[k];
      if (follows) slope[to] += part * basis.slope[k];
    }
    count = std::min(std::max(count, from + basis.count), static_cast<int>(kWidest));
  }
};

/// Those of a place at t that takes the places `reach` before and behind it along. At the rim they are the rim.
Shares sharesOf(const ControlGrid& grid, std::size_t axis, double t, double reach) noexcept {
  Shares shares;
  const Basis here(grid, axis, t);
  if (!(reach > 0)) {
    shares.first = here.first;
    shares.add(here, 1, true);
    return shares;
  }
  const double low = grid.knots[axis].front(), high = grid.knots[axis].back();
  const Basis before(grid, axis, std::max(low, t - reach)), behind(grid, axis, std::min(high, t + reach));
  shares.first = before.first;
  shares.add(before, 0.25, t - reach > low);
  shares.add(here, 0.5, true);
  shares.add(behind, 0.25, t + reach < high);
  return shares;
}

/// The reach [m] as a difference of parameters, the same all over the body so that derivatives are those of the shares;
/// at most so far that no place has more than kWidest control points.
double parameterReach(const Skeleton& skeleton, std::size_t axis, double reach) {
  if (!(reach > 0) || (axis == 0 && skeleton.curve())) return 0;
  const auto& [us, vs] = skeleton.parameters();
  double metres = 0;  // a unit of the parameter, on average
  spline::SurfacePoint s;
  for (const double u : us) {
    for (const double v : vs) {
      skeleton.surface().evaluate1(u, v, s);
      metres += (axis == 0 ? s.Su : s.Sv).norm() / static_cast<double>(us.size() * vs.size());
    }
  }
  const ControlGrid& grid = skeleton.control();
  const std::vector<double>& knots = grid.knots[axis];
  const auto widest = [&](double r) {
    int most = 0;
    for (const double knot : knots) {
      const double first = std::clamp(knot - 2 * r, knots.front(), knots.back());
      most = std::max(most, Basis(grid, axis, knot).first + grid.degree[axis] + 1 - Basis(grid, axis, first).first);
    }
    return most;
  };
  double r = metres > 0 ? reach / metres : 0;
  while (r > 0 && widest(r) > static_cast<int>(kWidest)) r *= 0.95;
  return r;
}

/// Of one direction: the least change from equal ones that makes the sum 1 at places all along it, by multiplying each
/// by the mean of what is missing where it acts.
std::vector<double> complianceAlong(const ControlGrid& grid, std::size_t axis) {
  constexpr int kLooks = 16, kRounds = 60;  // a knot interval; the changes then are below 1e-3
  const std::vector<double>& knots = grid.knots[axis];
  std::vector<Basis> looks;
  for (std::size_t k = 0; k + 1 < knots.size(); ++k)
    for (int i = 0; i < kLooks && knots[k + 1] > knots[k]; ++i)
      looks.emplace_back(grid, axis, knots[k] + (knots[k + 1] - knots[k]) * (i + 0.5) / kLooks);
  std::vector<double> all(static_cast<std::size_t>(grid.count[axis]), 1);
  for (int round = 0; round < kRounds; ++round) {
    std::vector<double> missing(all.size(), 0), weight(all.size(), 0);
    for (const Basis& b : looks) {
      double sum = 0;
      for (int i = 0; i < b.count; ++i) {
        const auto k = static_cast<std::size_t>(i);
        sum += b.value[k] * b.value[k] * all[static_cast<std::size_t>(b.first) + k];
      }
      for (int i = 0; i < b.count; ++i) {
        const auto k = static_cast<std::size_t>(i), at = static_cast<std::size_t>(b.first) + k;
        missing[at] += b.value[k] * b.value[k] / sum;
        weight[at] += b.value[k] * b.value[k];
      }
    }
    for (std::size_t i = 0; i < all.size(); ++i)
      if (weight[i] > 0) all[i] *= missing[i] / weight[i];
  }
  return all;
}

}  // namespace

Deformation::Deformation(const Skeleton& skeleton, const std::vector<Oscillator>& material,
                         const DeformationOptions& options)
    : Nodes(total(skeleton.control()), material, options),
      skeleton_(&skeleton),
      reach_{parameterReach(skeleton, 0, options.shear_reach), parameterReach(skeleton, 1, options.shear_reach)} {}

Deformation::Reach Deformation::reachOf(double u, double v) const noexcept {
  const ControlGrid& grid = skeleton_->control();
  const std::array<double, 2> at{u, v};
  std::array<Influence, 2> moved, all;
  for (std::size_t a = 0; a < 2; ++a) {
    std::array<double, spline::kMaxDegree + 1> values{};
    const int span = spline::findSpan(grid.knots[a], grid.degree[a], at[a]);
    spline::basisFunctions(grid.knots[a], grid.degree[a], span, at[a], values);
    const std::span<const double> basis(values.data(), static_cast<std::size_t>(grid.degree[a]) + 1);
    moved[a] = influence(basis, span, options().influence[a], Choice::kLargest);
    all[a] = whole(basis, span);
  }
  Reach reach;
  list(moved, grid.count[1], &Influence::alpha, reach.moved);
  list(all, grid.count[1], &Influence::basis, reach.all);
  return reach;
}

void Deformation::press(std::span<const Press> contacts) noexcept {
  if (!options().dynamics) clear();
  const std::size_t count = std::min(contacts.size(), static_cast<std::size_t>(kMaxContacts));
  std::array<Reach, kMaxContacts> reach;
  for (std::size_t i = 0; i < count; ++i) reach[i] = reachOf(contacts[i].u, contacts[i].v);
  const int sweeps = count > 1 ? kSweeps : 1;
  for (int sweep = 0; sweep < sweeps; ++sweep)
    for (std::size_t i = 0; i < count; ++i)
      yield({contacts[i].normal, contacts[i].depth, contacts[i].speed}, reach[i].all.span(), reach[i].moved.span());
}

void Deformation::nodesAt(double u, double v, FeltPlace& place) const noexcept {
  const ControlGrid& grid = skeleton_->control();
  const Shares along_u = sharesOf(grid, 0, u, reach_[0]), along_v = sharesOf(grid, 1, v, reach_[1]);
  place.count = 0;
  for (int i = 0; i < along_u.count; ++i) {
    for (int j = 0; j < along_v.count; ++j) {
      const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(j);
      place.nodes[place.count++] = {static_cast<uint32_t>((along_u.first + i) * grid.count[1] + along_v.first + j),
                                    along_u.value[a] * along_v.value[b], along_u.slope[a] * along_v.value[b],
                                    along_u.value[a] * along_v.slope[b]};
    }
  }
}

std::vector<double> Deformation::compliance() const {
  const std::vector<double> u = complianceAlong(skeleton_->control(), 0), v = complianceAlong(skeleton_->control(), 1);
  std::vector<double> all;
  for (const double a : u)
    for (const double b : v) all.push_back(a * b);
  return all;
}

Vector4d Deformation::at(double u, double v) const noexcept {
  Vector4d sum = Vector4d::Zero();
  if (awake() == 0) return sum;
  const Reach reach = reachOf(u, v);
  for (const NodeWeight& part : reach.all.span()) sum += part.weight * displacement(part.node);
  return sum;
}

}  // namespace hapticd::medial

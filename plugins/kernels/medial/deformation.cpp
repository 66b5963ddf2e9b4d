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

/// Lists the control points of an influence along u and v, with the products of their weights.
template <class Weights>
void list(const std::array<Influence, 2>& influence, int columns, Weights weights, auto& out) noexcept {
  out.count = 0;
  for (int i = 0; i < influence[0].count; ++i)
    for (int j = 0; j < influence[1].count; ++j)
      out.parts[out.count++] = {
          static_cast<uint32_t>((influence[0].first + i) * columns + influence[1].first + j),
          (influence[0].*weights)[static_cast<std::size_t>(i)] * (influence[1].*weights)[static_cast<std::size_t>(j)]};
}

/// The basis functions of one direction at a parameter, with their derivatives.
struct Basis {
  std::array<double, spline::kMaxDegree + 1> value{}, slope{};
  int first = 0, count = 0;

  /// Computes both from the functions of the next lower degree (Piegl & Tiller, Eqs. 2.5 and 2.7).
  Basis(const ControlGrid& grid, std::size_t axis, double t) noexcept {
    const std::vector<double>& knots = grid.knots[axis];
    const int degree = grid.degree[axis], span = spline::findSpan(knots, degree, t);
    first = span - degree;
    count = degree + 1;
    value[0] = 1;
    if (degree == 0) return;
    spline::basisFunctions(knots, degree - 1, span, t, value);
    double from_left = 0, slope_from_left = 0;
    for (int i = 0; i < degree; ++i) {
      const auto k = static_cast<std::size_t>(i);
      const double left = knots[static_cast<std::size_t>(first + i + 1)];
      const double right = knots[static_cast<std::size_t>(span + i + 1)], share = value[k] / (right - left);
      value[k] = from_left + (right - t) * share;
      slope[k] = slope_from_left - degree * share;
      from_left = (t - left) * share;
      slope_from_left = degree * share;
    }
    value[static_cast<std::size_t>(degree)] = from_left;
    slope[static_cast<std::size_t>(degree)] = slope_from_left;
  }
};

/// most control points of one place along one direction; 11 x 11 fit into a FeltPlace
constexpr std::size_t kWidest = 11;
static_assert(kWidest * kWidest <= FeltPlace::kMost);

/// The shares of control points in a place, with their derivatives.
struct Shares {
  std::array<double, kWidest> value{}, slope{};
  int first = 0, count = 0;

  /// Adds `part` times the basis functions of one place.
  /// @param rate derivative of the place of `basis` over the foot's parameter
  void add(const Basis& basis, double part, double rate) noexcept {
    const int from = basis.first - first;
    for (int i = 0; i < basis.count && static_cast<std::size_t>(from + i) < kWidest; ++i) {
      const auto to = static_cast<std::size_t>(from + i), k = static_cast<std::size_t>(i);
      value[to] += part * basis.value[k];
      slope[to] += part * rate * basis.slope[k];
    }
    count = std::min(std::max(count, from + basis.count), static_cast<int>(kWidest));
  }
};

/// A place that is used instead of the parameter t near a rim, and its derivative over t.
struct Place {
  double at = 0, rate = 1;
};

/// Returns the place that is used instead of t. Within `width` of the rim it follows t less and less, and comes no
/// nearer to the rim than half of `width`. A foot that stops at the rim does not move any more; without this rule the
/// slope of the dent would jump there.
Place nearRim(const std::vector<double>& knots, double t, double width) noexcept {
  const double low = knots.front(), high = knots.back();
  if (!(width > 0)) return {std::clamp(t, low, high), t > low && t < high ? 1.0 : 0.0};
  const double from_low = width - std::max(0.0, t - low), from_high = width - std::max(0.0, high - t);
  if (from_low > 0) return {std::max(low, t) + 0.5 * from_low * from_low / width, 1 - from_low / width};
  if (from_high > 0) return {std::min(high, t) - 0.5 * from_high * from_high / width, 1 - from_high / width};
  return {t, 1};
}

/// Returns the shares of control points in the place at t. The places at the distance `reach` before and after it
/// contribute too.
Shares sharesOf(const ControlGrid& grid, std::size_t axis, double t, double reach, double rim) noexcept {
  Shares shares;
  const std::vector<double>& knots = grid.knots[axis];
  const Place here = nearRim(knots, t, rim);
  const Basis middle(grid, axis, here.at);
  if (!(reach > 0)) {
    shares.first = middle.first;
    shares.add(middle, 1, here.rate);
    return shares;
  }
  const Place before = nearRim(knots, t - reach, rim), behind = nearRim(knots, t + reach, rim);
  const Basis low(grid, axis, before.at), high(grid, axis, behind.at);
  shares.first = low.first;
  shares.add(low, 0.25, before.rate);
  shares.add(middle, 0.5, here.rate);
  shares.add(high, 0.25, behind.rate);
  return shares;
}

/// Returns the width of the rim as a difference of parameters: the mean distance of control points, or 0 if there is no
/// rim.
double rimWidth(const Skeleton& skeleton, std::size_t axis) {
  const ControlGrid& grid = skeleton.control();
  if (grid.count[axis] < 2 || (axis == 0 && skeleton.curve())) return 0;
  const double range = grid.knots[axis].back() - grid.knots[axis].front();
  return range / std::max(2, grid.count[axis] - 1);
}

/// Converts the reach [m] into a difference of parameters. It is the same all over the body, so that only the shares
/// have derivatives. It is limited so that no place has more than kWidest control points.
double parameterReach(const Skeleton& skeleton, std::size_t axis, double reach) {
  if (!(reach > 0) || (axis == 0 && skeleton.curve())) return 0;
  const auto& [us, vs] = skeleton.parameters();
  double metres = 0;  // mean length of one unit of the parameter
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

/// Computes the compliances along one direction: the least change from equal values with which the sum is 1 at places
/// all along it. Each round multiplies a value by the mean factor that is missing where its control point acts.
std::vector<double> complianceAlong(const ControlGrid& grid, std::size_t axis) {
  constexpr int kLooks = 16, kRounds = 60;  // places per knot interval; after so many rounds the changes are below 1e-3
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
      reach_{parameterReach(skeleton, 0, options.shear_reach), parameterReach(skeleton, 1, options.shear_reach)},
      rim_{rimWidth(skeleton, 0), rimWidth(skeleton, 1)} {}

Deformation::Reach Deformation::reachOf(double u, double v) const noexcept {
  const ControlGrid& grid = skeleton_->control();
  const std::array<double, 2> at{u, v};
  std::array<Influence, 2> moved, all;
  for (std::size_t a = 0; a < 2; ++a) {
    std::array<double, spline::kMaxDegree + 1> values{};
    const int span = spline::findSpan(grid.knots[a], grid.degree[a], at[a]);
    spline::basisFunctions(grid.knots[a], grid.degree[a], span, at[a], values);
    const std::span<const double> basis(values.data(), static_cast<std::size_t>(grid.degree[a]) + 1);
    moved[a] = influence(basis, span, options().influence[a], PointSelection::kLargest);
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
  const Shares along_u = sharesOf(grid, 0, u, reach_[0], rim_[0]), along_v = sharesOf(grid, 1, v, reach_[1], rim_[1]);
  PlaceNode* node = place.nodes.data();
  for (int i = 0; i < along_u.count; ++i) {
    const auto a = static_cast<std::size_t>(i);
    const auto row = static_cast<uint32_t>((along_u.first + i) * grid.count[1] + along_v.first);
    const double weight = along_u.value[a], slope = along_u.slope[a];
    for (std::size_t b = 0; b < static_cast<std::size_t>(along_v.count); ++b)
      *node++ = {row + static_cast<uint32_t>(b), weight * along_v.value[b], slope * along_v.value[b],
                 weight * along_v.slope[b]};
  }
  place.count = static_cast<std::size_t>(node - place.nodes.data());
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

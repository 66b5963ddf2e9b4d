// SPDX-License-Identifier: MIT
#include "kernels/spline/table.hpp"

#include <array>
#include <cmath>

#include "kernels/double_double/double_double.hpp"
#include "kernels/spline/surface_data.hpp"

namespace hapticd::spline {
namespace {

/// Coefficients are divided by powers of a span's width. No coefficient overflows if width^degree is within these
/// bounds.
constexpr double kLeastPower = 1e-60, kMostPower = 1e60;

using Real = DoubleDouble;  // the table is made only once, and its coefficients should be right to the last bit
using Taylor = std::array<std::array<Real, kMaxDegree + 1>, kMaxDegree + 1>;

/// Returns in row k the k-th Taylor coefficients of the span's basis functions at the cell's origin. They come from the
/// basis functions of degree p - k by k differences (Piegl & Tiller 2.9), which also works at both ends of a span.
Taylor taylorCoefficients(const Axis& axis, const Cell& cell) {
  const int p = axis.degree();
  const double* knots = axis.knots().data() + cell.knot;
  const auto width = [knots](int r, int j) { return Real(knots[r + 1]) - knots[r + 1 - j]; };
  Taylor result{};
  for (int k = 0; k <= p; ++k) {
    auto& N = result[static_cast<std::size_t>(k)];
    N[0] = 1;
    for (int j = 1; j <= p; ++j) {
      Real saved = 0;
      for (int r = 0; r < j; ++r) {
        auto& value = N[static_cast<std::size_t>(r)];
        const Real part = value / width(r, j);
        const bool differ = j > p - k;
        const Real falls = differ ? -part * j / (j - (p - k)) : (knots[r + 1] - Real(cell.origin)) * part;
        const Real rises = differ ? -falls : (Real(cell.origin) - knots[r + 1 - j]) * part;
        value = saved + falls;
        saved = rises;
      }
      N[static_cast<std::size_t>(j)] = saved;
    }
  }
  return result;
}

struct Term {
  Real x = 0, y = 0, z = 0, w = 0;
  void add(const Real& factor, const Term& term) {
    x += factor * term.x, y += factor * term.y, z += factor * term.z, w += factor * term.w;
  }
};

/// The control points of one cell about its local origin, multiplied by their weights.
struct Window {
  std::array<std::array<Term, kMaxDegree + 1>, kMaxDegree + 1> terms;
  Quad origin;
  double extent = 0;        ///< largest absolute coordinate, relative to the origin
  double least_weight = 1;  ///< a lower bound of the cell's weight function
};

/// Returns a control point near the cell's expansion point. If the expansion point is on a collapsed side, this is the
/// point to which the side collapses.
Quad originOf(const Net& net, const Axis& u, const Axis& v, const Cell& cu, const Cell& cv) {
  const auto index = [](const Axis& axis, const Cell& cell) {
    if (cell.origin == axis.breaks().front()) return cell.knot - axis.degree();
    return cell.origin == axis.breaks().back() ? cell.knot : cell.knot - axis.degree() / 2;
  };
  Quad origin = net.points[static_cast<std::size_t>(index(u, cu) * v.count() + index(v, cv))];
  origin.w = 0;
  return origin;
}

Window windowOf(const Net& net, const Axis& u, const Axis& v, const Cell& cu, const Cell& cv) {
  Window window;
  window.origin = originOf(net, u, v, cu, cv);
  if (net.rational()) window.least_weight = INFINITY;
  for (int i = 0; i <= u.degree(); ++i) {
    for (int j = 0; j <= v.degree(); ++j) {
      const auto at = (cu.knot - u.degree() + i) * v.count() + cv.knot - v.degree() + j;
      const Quad& point = net.points[static_cast<std::size_t>(at)];
      const Real weight = net.rational() ? point.w : 1;
      const Real x = Real(point.x) - window.origin.x, y = Real(point.y) - window.origin.y,
                 z = Real(point.z) - window.origin.z;
      window.terms[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] = {x * weight, y * weight, z * weight,
                                                                                net.rational() ? weight : 0};
      const double extent = static_cast<double>(std::max({abs(x), abs(y), abs(z)}));
      window.extent = std::max(window.extent, extent);
      if (net.rational()) window.least_weight = std::min(window.least_weight, point.w);
    }
  }
  return window;
}

/// Sums of the magnitudes of a cell's terms at its far corner.
struct Growth {
  double position = 0, weight = 0;
  void add(const Quad& term, double power) {
    position += std::max({std::abs(term.x), std::abs(term.y), std::abs(term.z)}) * power;
    weight += std::abs(term.w) * power;
  }
  bool acceptable(const Window& window) const {
    const double bound = kMaxTableGrowth * window.least_weight;
    return position <= bound * window.extent && weight <= bound;
  }
};

double farthest(const Cell& cell) {
  return std::max(cell.end - cell.origin, cell.origin - cell.lo);
}

bool powersFit(const Axis& axis) {
  for (const Cell& cell : axis.cells()) {
    const double power = std::pow(farthest(cell), axis.degree());
    if (!(power > kLeastPower && power < kMostPower)) return false;
  }
  return true;
}

/// Appends a local origin or a coefficient to the table.
void append(const Quad& quad, bool rational, Table& table) {
  table.cells.insert(table.cells.end(), {quad.x, quad.y, quad.z});
  if (rational) table.cells.push_back(quad.w);
}

/// Sums over the control points along v: row l holds the l-th Taylor coefficient of each column of the window.
using Columns = std::array<std::array<Term, kMaxDegree + 1>, kMaxDegree + 1>;

Columns columnsOf(const Window& window, const Taylor& tv, std::array<int, 2> degree) {
  Columns columns;
  for (std::size_t l = 0; l <= static_cast<std::size_t>(degree[1]); ++l)
    for (std::size_t i = 0; i <= static_cast<std::size_t>(degree[0]); ++i)
      for (std::size_t j = 0; j <= static_cast<std::size_t>(degree[1]); ++j)
        columns[l][i].add(tv[l][j], window.terms[i][j]);
  return columns;
}

/// Appends one cell to the table. Returns false if the cell would lose digits.
bool appendCell(const Window& window, const Taylor& tu, const Taylor& tv, std::array<double, 2> reach,
                std::array<int, 2> degree, bool rational, Table& table) {
  const Columns columns = columnsOf(window, tv, degree);
  Growth growth;
  append(window.origin, rational, table);
  double power_u = 1;
  for (int k = 0; k < table.size_u; ++k, power_u *= reach[0]) {
    double power = power_u;
    for (int l = 0; l < table.size_v; ++l, power *= reach[1]) {
      Term sum;
      for (std::size_t i = 0; k <= degree[0] && l <= degree[1] && i <= static_cast<std::size_t>(degree[0]); ++i)
        sum.add(tu[static_cast<std::size_t>(k)][i], columns[static_cast<std::size_t>(l)][i]);
      const Quad rounded{static_cast<double>(sum.x), static_cast<double>(sum.y), static_cast<double>(sum.z),
                         static_cast<double>(sum.w)};
      growth.add(rounded, power);
      append(rounded, rational, table);
    }
  }
  return growth.acceptable(window);
}

/// Chooses the smallest unrolled kernel that fits the degrees, or else the kernel with loops.
void chooseShape(std::array<int, 2> degree, Table& table) {
  table.shape = kTableShapes;
  table.size_u = degree[0] + 1;
  table.size_v = degree[1] + 1;
  for (int i = 0; i < kTableShapes; ++i) {
    if (kTableSizes[i][0] < degree[0] + 1 || kTableSizes[i][1] < degree[1] + 1) continue;
    table.shape = i;
    table.size_u = kTableSizes[i][0];
    table.size_v = kTableSizes[i][1];
    return;
  }
}

/// True if all control points of one row along an axis are the same point.
bool collapsed(const Net& net, const Axis& along, int index, int step_along, int step_across) {
  const auto point = [&](int j) { return net.points[static_cast<std::size_t>(index * step_across + j * step_along)]; };
  for (int j = 1; j < along.count(); ++j) {
    if (point(j).x != point(0).x || point(j).y != point(0).y || point(j).z != point(0).z) return false;
  }
  return true;
}

bool clamped(const Axis& axis, bool high) {
  const auto& knots = axis.knots();
  const auto p = static_cast<std::size_t>(axis.degree()), n = static_cast<std::size_t>(axis.count());
  return high ? knots[n] == knots[n + p - 1] : knots[1] == knots[p];
}

}  // namespace

void anchorAtCollapsedSides(const Net& net, Axis& u, Axis& v) {
  const int count_v = v.count();
  const bool u_low = clamped(u, false) && collapsed(net, v, 0, 1, count_v);
  const bool u_high = clamped(u, true) && collapsed(net, v, u.count() - 1, 1, count_v);
  const bool v_low = clamped(v, false) && collapsed(net, u, 0, count_v, 1);
  const bool v_high = clamped(v, true) && collapsed(net, u, count_v - 1, count_v, 1);
  u.anchor(u_low, u_high);
  v.anchor(v_low, v_high);
}

std::optional<Table> makeTable(const Net& net, const Axis& u, const Axis& v) {
  if (!powersFit(u) || !powersFit(v)) return std::nullopt;
  const std::array<int, 2> degree{u.degree(), v.degree()};
  Table table;
  chooseShape(degree, table);
  table.stride = (1 + static_cast<std::ptrdiff_t>(table.size_u) * table.size_v) * tableStride(net.rational());
  table.row_stride = table.stride * static_cast<std::ptrdiff_t>(v.cells().size());
  table.cells.reserve(u.cells().size() * static_cast<std::size_t>(table.row_stride) + 1);
  std::vector<Taylor> taylor_v;
  for (const Cell& cell : v.cells()) taylor_v.push_back(taylorCoefficients(v, cell));
  for (const Cell& cu : u.cells()) {
    const Taylor tu = taylorCoefficients(u, cu);
    for (std::size_t j = 0; j < taylor_v.size(); ++j) {
      const Cell& cv = v.cells()[j];
      const Window window = windowOf(net, u, v, cu, cv);
      if (!appendCell(window, tu, taylor_v[j], {farthest(cu), farthest(cv)}, degree, net.rational(), table))
        return std::nullopt;
    }
  }
  table.cells.push_back(0);
  return table;
}

}  // namespace hapticd::spline

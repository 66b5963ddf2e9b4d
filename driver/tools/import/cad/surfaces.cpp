// SPDX-License-Identifier: MIT
#include "cad_import/surfaces.hpp"

#include <GeomConvert.hxx>
#include <GeomConvert_ApproxSurface.hxx>
#include <Geom_BSplineSurface.hxx>
#include <Geom_BezierSurface.hxx>
#include <Geom_ConicalSurface.hxx>
#include <Geom_CylindricalSurface.hxx>
#include <Geom_OffsetSurface.hxx>
#include <Geom_Plane.hxx>
#include <Geom_RectangularTrimmedSurface.hxx>
#include <Geom_SphericalSurface.hxx>
#include <Geom_SurfaceOfLinearExtrusion.hxx>
#include <Geom_SurfaceOfRevolution.hxx>
#include <Geom_ToroidalSurface.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <algorithm>
#include <cmath>

#include "kernels/part/spline_check.hpp"
#include "kernels/spline/surface_data.hpp"

namespace hapticd::cad {
namespace {

using brep::Part;
using brep::Surface;
using brep::SurfaceKind;
using brep::Vector;
using brep::Vector2;

Vector plain(const gp_XYZ& v) {
  return {v.X(), v.Y(), v.Z()};
}

/// Makes a cylinder, cone, sphere or torus with the given axes. @param along [m] length of the axis z, which is the
/// length of one unit of v
Surface framed(SurfaceKind kind, const gp_Ax3& axes, double along, double r0, double r1) {
  Surface s;
  s.kind = kind;
  s.o = metres(axes.Location().XYZ());
  s.x = plain(axes.XDirection().XYZ());
  s.y = plain(axes.YDirection().XYZ());
  s.z = plain(axes.Direction().XYZ() * along);
  s.r = {r0 * kMetres, r1 * kMetres};
  s.period[0] = kFullTurn;
  return s;
}

/// Turns a periodic spline into one that ends at lo and hi in that parameter, with the same parameters.
void unroll(const Handle(Geom_BSplineSurface) & s, bool along_u, const Vector2& lo, const Vector2& hi) {
  const std::size_t axis = along_u ? 0 : 1;
  Standard_Real first[2], last[2];
  s->Bounds(first[0], last[0], first[1], last[1]);
  const double period = last[axis] - first[axis], end = std::min(hi[axis], lo[axis] + period);
  if (along_u)
    s->Segment(lo[0], end, first[1], last[1]);
  else
    s->Segment(first[0], last[0], lo[1], end);
  if (along_u ? s->IsUPeriodic() : s->IsVPeriodic()) along_u ? s->SetUNotPeriodic() : s->SetVNotPeriodic();
  TColStd_Array1OfReal knots(1, along_u ? s->NbUKnots() : s->NbVKnots());
  along_u ? s->UKnots(knots) : s->VKnots(knots);
  const double turns = std::round((lo[axis] - knots.First()) / period) * period;
  for (double& knot : knots) knot += turns;
  along_u ? s->SetUKnots(knots) : s->SetVKnots(knots);
}

Surface splineRecord(const Handle(Geom_BSplineSurface) & s, Part& part) {
  Surface record;
  record.kind = SurfaceKind::kSpline;
  record.degree = {static_cast<std::uint32_t>(s->UDegree()), static_cast<std::uint32_t>(s->VDegree())};
  record.count = {static_cast<std::uint32_t>(s->NbUPoles()), static_cast<std::uint32_t>(s->NbVPoles())};
  record.data = part.reals.size();
  for (const bool along_u : {true, false}) {
    const std::size_t axis = along_u ? 0 : 1, first = part.reals.size();
    TColStd_Array1OfReal knots(1, static_cast<int>(record.count[axis] + record.degree[axis] + 1));
    along_u ? s->UKnotSequence(knots) : s->VKnotSequence(knots);
    part.reals.insert(part.reals.end(), knots.begin(), knots.end());
    const std::string wrong =
        brep::wrongKnots(std::span(part.reals).subspan(first), record.degree[axis], record.count[axis]);
    if (!wrong.empty()) throw Unkept("knots of its surface: " + wrong);
  }
  for (int i = 1; i <= s->NbUPoles(); ++i)
    for (int j = 1; j <= s->NbVPoles(); ++j)
      for (const double value : metres(s->Pole(i, j).XYZ())) {
        if (!(std::abs(value) <= brep::kFarthestPart))
          throw Unkept("its surface reaches farther than 1,000,000 m from the origin");
        part.reals.push_back(value);
      }
  if (s->IsUClosed()) record.flags |= brep::kClosedU;
  if (s->IsVClosed()) record.flags |= brep::kClosedV;
  if (!s->IsURational() && !s->IsVRational()) return record;
  record.flags |= brep::kRational;
  const std::size_t first = part.reals.size();
  for (int i = 1; i <= s->NbUPoles(); ++i)
    for (int j = 1; j <= s->NbVPoles(); ++j) part.reals.push_back(s->Weight(i, j));
  const std::string wrong = brep::wrongWeights(std::span(part.reals).subspan(first));
  if (!wrong.empty()) throw Unkept("weights of its surface: " + wrong);
  return record;
}

/// Returns the largest distance [mm] between points of two surfaces that have the same parameters, over a grid.
double deviation(const Geom_Surface& a, const Geom_Surface& b, const Vector2& lo, const Vector2& hi) {
  constexpr int kSteps = 30;
  double most = 0;
  for (int i = 0; i <= kSteps; ++i)
    for (int j = 0; j <= kSteps; ++j) {
      const double u = lo[0] + (hi[0] - lo[0]) * i / kSteps, v = lo[1] + (hi[1] - lo[1]) * j / kSteps;
      most = std::max(most, a.Value(u, v).Distance(b.Value(u, v)));
    }
  return most;
}

/// Approximates a surface, unless it is a spline that a part holds. A fit that shall be smoother than the surface
/// misses it by far beside the creases, while Open CASCADE reports a small error; so creases are allowed where the
/// surface has some, and the error is measured as well.
Handle(Geom_BSplineSurface)
    asSpline(const Handle(Geom_Surface) & surface, const Vector2& lo, const Vector2& hi, double& error) {
  constexpr double kSplineError = 1e-5;  // [mm]
  constexpr int kSplineDegree = 8, kMostPatches = 100;
  auto spline = Handle(Geom_BSplineSurface)::DownCast(surface);
  if (!Handle(Geom_BezierSurface)::DownCast(surface).IsNull()) spline = GeomConvert::SurfaceToBSplineSurface(surface);
  if (!spline.IsNull() && std::max(spline->UDegree(), spline->VDegree()) <= spline::kMaxDegree) {
    spline = Handle(Geom_BSplineSurface)::DownCast(spline->Copy());
    if (spline->IsUPeriodic()) unroll(spline, true, lo, hi);
    if (spline->IsVPeriodic()) unroll(spline, false, lo, hi);
    return spline;
  }
  const Handle(Geom_RectangularTrimmedSurface) piece =
      new Geom_RectangularTrimmedSurface(surface, lo[0], hi[0], lo[1], hi[1]);
  const GeomAbs_Shape smooth = surface->IsCNu(1) && surface->IsCNv(1) ? GeomAbs_C1 : GeomAbs_C0;
  const GeomConvert_ApproxSurface fit(piece, kSplineError, smooth, smooth, kSplineDegree, kSplineDegree, kMostPatches,
                                      1);
  if (!fit.HasResult())
    throw Unkept("its surface, of kind " + std::string(surface->DynamicType()->Name()) +
                 ", cannot be approximated by a spline");
  error = std::max({fit.MaxError(), deviation(*piece, *fit.Surface(), lo, hi), 1e-12}) * kMetres;
  return fit.Surface();
}

Surface planeRecord(const gp_Ax3& axes) {
  Surface s;
  s.o = metres(axes.Location().XYZ());
  s.x = metres(axes.XDirection().XYZ());
  s.y = metres(axes.YDirection().XYZ());
  s.z = plain(axes.Direction().XYZ());
  return s;
}

/// Converts extrusions, revolutions and offsets. Appends first the curve or surface that they are made of. Returns
/// false for other kinds.
bool swept(const Handle(Geom_Surface) & surface, const Vector2& lo, const Vector2& hi, Part& part, Surface& s,
           double& error) {
  if (const auto extrusion = Handle(Geom_SurfaceOfLinearExtrusion)::DownCast(surface); !extrusion.IsNull()) {
    const Kept basis = addCurve(extrusion->BasisCurve(), lo[0], hi[0], part);
    s.kind = SurfaceKind::kExtrusion;
    s.basis = basis.index;
    s.z = metres(extrusion->Direction().XYZ());
    if (extrusion->IsUPeriodic()) s.period[0] = extrusion->UPeriod();
    error = basis.error;
  } else if (const auto turned = Handle(Geom_SurfaceOfRevolution)::DownCast(surface); !turned.IsNull()) {
    const Kept basis = addCurve(turned->BasisCurve(), lo[1], hi[1], part);
    s.kind = SurfaceKind::kRevolution;
    s.basis = basis.index;
    s.o = metres(turned->Axis().Location().XYZ());
    s.z = plain(turned->Axis().Direction().XYZ());
    s.period[0] = kFullTurn;
    if (turned->IsVPeriodic()) s.period[1] = turned->VPeriod();
    error = basis.error;
  } else if (const auto offset = Handle(Geom_OffsetSurface)::DownCast(surface); !offset.IsNull()) {
    const Kept basis = addSurface(offset->BasisSurface(), lo, hi, part);
    s.kind = SurfaceKind::kOffset;
    s.basis = basis.index;
    s.r[0] = offset->Offset() * kMetres;
    s.period = part.surfaces[basis.index].period;
    s.flags = part.surfaces[basis.index].flags & (brep::kClosedU | brep::kClosedV);
    error = basis.error;
  } else {
    return false;
  }
  return true;
}

/// Converts planes, cylinders, cones, spheres and tori. Returns false for other kinds.
bool analytic(const Handle(Geom_Surface) & surface, Surface& s) {
  if (const auto plane = Handle(Geom_Plane)::DownCast(surface); !plane.IsNull()) {
    s = planeRecord(plane->Position());
  } else if (const auto cylinder = Handle(Geom_CylindricalSurface)::DownCast(surface); !cylinder.IsNull()) {
    s = framed(SurfaceKind::kCylinder, cylinder->Position(), kMetres, cylinder->Radius(), 0);
  } else if (const auto cone = Handle(Geom_ConicalSurface)::DownCast(surface); !cone.IsNull()) {
    const double a = cone->SemiAngle();
    s = framed(SurfaceKind::kCone, cone->Position(), kMetres * std::cos(a), cone->RefRadius(), std::sin(a));
  } else if (const auto ball = Handle(Geom_SphericalSurface)::DownCast(surface); !ball.IsNull()) {
    s = framed(SurfaceKind::kSphere, ball->Position(), 1, ball->Radius(), 0);
  } else if (const auto torus = Handle(Geom_ToroidalSurface)::DownCast(surface); !torus.IsNull()) {
    s = framed(SurfaceKind::kTorus, torus->Position(), 1, torus->MajorRadius(), torus->MinorRadius());
    s.period[1] = kFullTurn;
  } else {
    return false;
  }
  return true;
}

}  // namespace

Kept addSurface(const Handle(Geom_Surface) & any, const Vector2& lo, const Vector2& hi, Part& part) {
  Handle(Geom_Surface) surface = any;
  for (auto trimmed = Handle(Geom_RectangularTrimmedSurface)::DownCast(surface); !trimmed.IsNull();
       trimmed = Handle(Geom_RectangularTrimmedSurface)::DownCast(surface))
    surface = trimmed->BasisSurface();
  Surface record;
  Kept kept;
  if (!analytic(surface, record) && !swept(surface, lo, hi, part, record, kept.error))
    record = splineRecord(asSpline(surface, lo, hi, kept.error), part);
  for (const Vector* axis : {&record.o, &record.x, &record.y, &record.z})
    for (const double value : *axis)
      if (!(std::abs(value) <= brep::kFarthestPart))
        throw Unkept("its surface reaches farther than 1,000,000 m from the origin");
  kept.index = static_cast<std::uint32_t>(part.surfaces.size());
  part.surfaces.push_back(record);
  return kept;
}

}  // namespace hapticd::cad

// SPDX-License-Identifier: MIT
#include "cad_import/curves.hpp"

#include <Geom2dConvert.hxx>
#include <Geom2dConvert_ApproxCurve.hxx>
#include <Geom2d_BSplineCurve.hxx>
#include <Geom2d_BezierCurve.hxx>
#include <Geom2d_Circle.hxx>
#include <Geom2d_Ellipse.hxx>
#include <Geom2d_Line.hxx>
#include <Geom2d_TrimmedCurve.hxx>
#include <GeomConvert.hxx>
#include <GeomConvert_ApproxCurve.hxx>
#include <Geom_BSplineCurve.hxx>
#include <Geom_BezierCurve.hxx>
#include <Geom_Circle.hxx>
#include <Geom_Ellipse.hxx>
#include <Geom_Line.hxx>
#include <Geom_TrimmedCurve.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <algorithm>
#include <cmath>

#include "kernels/part/spline_check.hpp"
#include "kernels/spline/surface_data.hpp"

namespace hapticd::cad {
namespace {

using brep::CurveKind;
using brep::Part;

constexpr int kMostSegments = 200, kDegree = 8;

void refuse(const std::string& wrong, const char* what) {
  if (!wrong.empty()) throw Unkept(std::string(what) + ": " + wrong);
}

/// Fills a Curve3 or Curve2 from a spline; splines of Open CASCADE in two and three dimensions have the same methods.
template <class Record, class Spline, class Point>
Record splineRecord(const Spline& spline, double scale, Part& part, const Point& coordinates) {
  Record record;
  record.kind = CurveKind::kSpline;
  record.degree = static_cast<std::uint32_t>(spline->Degree());
  record.count = static_cast<std::uint32_t>(spline->NbPoles());
  record.data = part.reals.size();
  TColStd_Array1OfReal knots(1, spline->NbPoles() + spline->Degree() + 1);
  spline->KnotSequence(knots);
  part.reals.insert(part.reals.end(), knots.begin(), knots.end());
  refuse(brep::wrongKnots(std::span(part.reals).subspan(record.data), record.degree, record.count), "knots of a curve");
  for (int i = 1; i <= spline->NbPoles(); ++i) coordinates(spline->Pole(i), scale);
  if (!spline->IsRational()) return record;
  record.flags = brep::kRational;
  const std::size_t first = part.reals.size();
  for (int i = 1; i <= spline->NbPoles(); ++i) part.reals.push_back(spline->Weight(i));
  refuse(brep::wrongWeights(std::span(part.reals).subspan(first)), "weights of a curve");
  return record;
}

/// Turns a periodic spline into one that ends at t0 and t1, with the same parameters.
template <class Spline>
Spline unrolled(const Spline& spline, double t0, double t1) {
  if (!spline->IsPeriodic()) return spline;
  const auto copy = Spline::DownCast(spline->Copy());
  const double period = copy->LastParameter() - copy->FirstParameter();
  copy->Segment(t0, std::min(t1, t0 + period));
  if (copy->IsPeriodic()) copy->SetNotPeriodic();
  TColStd_Array1OfReal knots(1, copy->NbKnots());
  copy->Knots(knots);
  const double turns = std::round((t0 - knots.First()) / period) * period;
  for (double& knot : knots) knot += turns;
  copy->SetKnots(knots);
  return copy;
}

Handle(Geom_Curve) basisOf(Handle(Geom_Curve) curve) {
  for (auto trimmed = Handle(Geom_TrimmedCurve)::DownCast(curve); !trimmed.IsNull();
       trimmed = Handle(Geom_TrimmedCurve)::DownCast(curve))
    curve = trimmed->BasisCurve();
  return curve;
}

Handle(Geom2d_Curve) basisOf(Handle(Geom2d_Curve) curve) {
  for (auto trimmed = Handle(Geom2d_TrimmedCurve)::DownCast(curve); !trimmed.IsNull();
       trimmed = Handle(Geom2d_TrimmedCurve)::DownCast(curve))
    curve = trimmed->BasisCurve();
  return curve;
}

/// Returns true for a spline whose degree the kernel supports. Other splines are approximated, like curves of other
/// kinds.
template <class Spline>
bool isKept(const Spline& spline) {
  return !spline.IsNull() && spline->Degree() <= spline::kMaxDegree;
}

Handle(Geom_BSplineCurve) asSpline(const Handle(Geom_Curve) & curve, double t0, double t1, double& error) {
  constexpr double kNear = 1e-7;  // [mm]
  auto spline = Handle(Geom_BSplineCurve)::DownCast(curve);
  if (!Handle(Geom_BezierCurve)::DownCast(curve).IsNull()) spline = GeomConvert::CurveToBSplineCurve(curve);
  if (isKept(spline)) return unrolled(spline, t0, t1);
  const Handle(Geom_TrimmedCurve) piece = new Geom_TrimmedCurve(curve, t0, t1);
  const GeomConvert_ApproxCurve fit(piece, kNear, GeomAbs_C1, kMostSegments, kDegree);
  if (!fit.HasResult())
    throw Unkept("a curve of kind " + std::string(curve->DynamicType()->Name()) +
                 " cannot be approximated by a spline");
  error = std::max(fit.MaxError(), 1e-12);
  return fit.Curve();
}

Handle(Geom2d_BSplineCurve) asSpline(const Handle(Geom2d_Curve) & curve, double t0, double t1, double& error) {
  constexpr double kNear = 1e-9;  // [units of the parameters]
  auto spline = Handle(Geom2d_BSplineCurve)::DownCast(curve);
  if (!Handle(Geom2d_BezierCurve)::DownCast(curve).IsNull()) spline = Geom2dConvert::CurveToBSplineCurve(curve);
  if (isKept(spline)) return unrolled(spline, t0, t1);
  const Handle(Geom2d_TrimmedCurve) piece = new Geom2d_TrimmedCurve(curve, t0, t1);
  const Geom2dConvert_ApproxCurve fit(piece, kNear, GeomAbs_C1, kMostSegments, kDegree);
  if (!fit.HasResult())
    throw Unkept("a pcurve of kind " + std::string(curve->DynamicType()->Name()) +
                 " cannot be approximated by a spline");
  error = std::max(fit.MaxError(), 1e-12);
  return fit.Curve();
}

brep::Vector2 plain(const gp_XY& v) {
  return {v.X(), v.Y()};
}

/// Throws Unkept if a number of the record is too large for a part, or not finite.
template <class Record>
void refuseFar(const Record& record, double most, const char* what) {
  for (const auto* axis : {&record.o, &record.x, &record.y})
    for (const double value : *axis)
      if (!(std::abs(value) <= most)) throw Unkept(std::string(what) + " lies beyond all bounds");
}

}  // namespace

brep::Vector metres(const gp_XYZ& v) {
  return {v.X() * kMetres, v.Y() * kMetres, v.Z() * kMetres};
}

Kept addCurve(const Handle(Geom_Curve) & any, double t0, double t1, Part& part) {
  const Handle(Geom_Curve) curve = basisOf(any);
  brep::Curve3 record;
  Kept kept;
  if (const auto line = Handle(Geom_Line)::DownCast(curve); !line.IsNull()) {
    record.o = metres(line->Position().Location().XYZ());
    record.x = metres(line->Position().Direction().XYZ());
  } else if (const auto circle = Handle(Geom_Circle)::DownCast(curve); !circle.IsNull()) {
    record.kind = CurveKind::kCircle;
    record.o = metres(circle->Position().Location().XYZ());
    record.x = metres(circle->Position().XDirection().XYZ() * circle->Radius());
    record.y = metres(circle->Position().YDirection().XYZ() * circle->Radius());
  } else if (const auto ellipse = Handle(Geom_Ellipse)::DownCast(curve); !ellipse.IsNull()) {
    record.kind = CurveKind::kEllipse;
    record.o = metres(ellipse->Position().Location().XYZ());
    record.x = metres(ellipse->Position().XDirection().XYZ() * ellipse->MajorRadius());
    record.y = metres(ellipse->Position().YDirection().XYZ() * ellipse->MinorRadius());
  } else {
    record = splineRecord<brep::Curve3>(asSpline(curve, t0, t1, kept.error), kMetres, part,
                                        [&](const gp_Pnt& p, double scale) {
                                          for (int i = 1; i <= 3; ++i) part.reals.push_back(scale * p.Coord(i));
                                        });
    kept.error *= kMetres;
  }
  refuseFar(record, brep::kFarthestPart, "a curve");
  kept.index = static_cast<std::uint32_t>(part.curves3.size());
  part.curves3.push_back(record);
  return kept;
}

Kept addPlaneCurve(const Handle(Geom2d_Curve) & any, double t0, double t1, Part& part) {
  const Handle(Geom2d_Curve) curve = basisOf(any);
  brep::Curve2 record;
  Kept kept;
  if (const auto line = Handle(Geom2d_Line)::DownCast(curve); !line.IsNull()) {
    record.o = plain(line->Location().XY());
    record.x = plain(line->Direction().XY());
  } else if (const auto circle = Handle(Geom2d_Circle)::DownCast(curve); !circle.IsNull()) {
    const gp_Ax22d axes = circle->Circ2d().Axis();
    record.kind = CurveKind::kCircle;
    record.o = plain(axes.Location().XY());
    record.x = plain(axes.XDirection().XY() * circle->Radius());
    record.y = plain(axes.YDirection().XY() * circle->Radius());
  } else if (const auto ellipse = Handle(Geom2d_Ellipse)::DownCast(curve); !ellipse.IsNull()) {
    const gp_Ax22d axes = ellipse->Elips2d().Axis();
    record.kind = CurveKind::kEllipse;
    record.o = plain(axes.Location().XY());
    record.x = plain(axes.XDirection().XY() * ellipse->MajorRadius());
    record.y = plain(axes.YDirection().XY() * ellipse->MinorRadius());
  } else {
    record = splineRecord<brep::Curve2>(asSpline(curve, t0, t1, kept.error), 1, part, [&](const gp_Pnt2d& p, double) {
      part.reals.push_back(p.X());
      part.reals.push_back(p.Y());
    });
  }
  refuseFar(record, brep::kWidestParameter, "a pcurve");
  kept.index = static_cast<std::uint32_t>(part.curves2.size());
  part.curves2.push_back(record);
  return kept;
}

}  // namespace hapticd::cad

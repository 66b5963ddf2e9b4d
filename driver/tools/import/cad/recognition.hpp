// SPDX-License-Identifier: MIT
/// Recognises planes, cylinders, cones and spheres that a CAD program wrote as splines, because their foot points have
/// closed forms.
#pragma once
#include <Geom_Surface.hxx>
#include <optional>
#include <vector>

#include "cad_import/curves.hpp"

namespace hapticd::cad {

/// [main] Returns the plane, cylinder, cone or sphere that a spline surface is over [lo, hi], if the two differ by at
/// most 1e-6 mm everywhere. Its normal points to the same side as the normal of the spline, so that loops keep their
/// direction.
std::optional<brep::Surface> recognised(const Handle(Geom_Surface) & surface, const brep::Vector2& lo,
                                        const brep::Vector2& hi);

/// Finds the curves of a face's edges in the parameters of the recognised surface.
class Unfolding {
 public:
  /// @param surface the spline @param lo, hi the range of the face in the parameters of the spline @param shape the
  /// recognised surface
  Unfolding(const Handle(Geom_Surface) & surface, const brep::Vector2& lo, const brep::Vector2& hi,
            const brep::Surface& shape);

  /// [main] Appends the pcurve of an edge and widens the box of the face by it.
  /// @param curve curve of the edge in space @param record the same curve as a record of the part @param uv point of
  /// the old pcurve at `t`; it shows on which side of a seam the coedge runs @param within [m] largest allowed distance
  /// of the edge from the surface @throws Unkept if the edge leaves the surface
  std::uint32_t addPlaneCurve(const Handle(Geom_Curve) & curve, const brep::Curve3& record, double t0, double t1,
                              const gp_Pnt2d& uv, double t, double within, brep::Part& part);

  const brep::Vector2& lo() const { return lo_; }
  const brep::Vector2& hi() const { return hi_; }

 private:
  struct Sample {
    double t;
    brep::Vector2 uv, slope;
    bool pole;  ///< the surface has no angle u there; `uv` has that of the sample beside it
  };
  double angleAt(const gp_Pnt2d& uv) const;
  Sample sampleAt(const Handle(Geom_Curve) & curve, double t, double near_u, double within) const;
  std::vector<Sample> samplesAlong(const Handle(Geom_Curve) & curve, double t0, double t1, const gp_Pnt2d& uv, double t,
                                   double within) const;
  static bool runsToAPole(const std::vector<Sample>& samples);
  bool follows(const brep::Curve2& line, const std::vector<Sample>& samples) const;
  void widen(const brep::Vector2& uv);

  Handle(Geom_Surface) surface_;
  brep::Vector2 middle_;
  brep::Surface shape_;
  brep::Vector2 lo_{1e300, 1e300}, hi_{-1e300, -1e300};
};

}  // namespace hapticd::cad

// SPDX-License-Identifier: MIT
/// Writes CAD files whose distances have closed forms, for cad_truth.py.
///   make_parts FOLDER             all of them
///   make_parts FOLDER ROWS        plate.step alone, with ROWS x ROWS holes
#include <BRepAlgoAPI_Common.hxx>
#include <BRepAlgoAPI_Cut.hxx>
#include <BRepAlgoAPI_Fuse.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepBuilderAPI_NurbsConvert.hxx>
#include <BRepBuilderAPI_Transform.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCone.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakePrism.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <GeomConvert.hxx>
#include <Geom_BSplineCurve.hxx>
#include <Geom_BSplineSurface.hxx>
#include <Geom_BezierCurve.hxx>
#include <Geom_Circle.hxx>
#include <Geom_OffsetSurface.hxx>
#include <Geom_TrimmedCurve.hxx>
#include <IGESControl_Writer.hxx>
#include <Interface_Static.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Quantity_Color.hxx>
#include <STEPCAFControl_Writer.hxx>
#include <STEPControl_Writer.hxx>
#include <TColStd_Array1OfInteger.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <TColgp_Array1OfPnt.hxx>
#include <TColgp_Array2OfPnt.hxx>
#include <TDataStd_Name.hxx>
#include <TDocStd_Document.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Iterator.hxx>
#include <TopoDS_Shell.hxx>
#include <TopoDS_Solid.hxx>
#include <XCAFApp_Application.hxx>
#include <XCAFDoc_ColorTool.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <gp_Sphere.hxx>
#include <numbers>
#include <string>

#include "support/sweep.hpp"

namespace {

std::string folder;
int failures = 0;

void told(bool written, const std::string& name) {
  if (written) return;
  ++failures;
  std::fprintf(stderr, "%s: not written\n", name.c_str());
}

void step(const TopoDS_Shape& shape, const std::string& name, const char* unit = "MM") {
  STEPControl_Writer writer;  // sets up the table of parameters
  Interface_Static::SetCVal("write.step.unit", unit);
  writer.Model(true);
  told(writer.Transfer(shape, STEPControl_AsIs) == IFSelect_RetDone &&
           writer.Write((folder + "/" + name + ".step").c_str()) == IFSelect_RetDone,
       name);
}

void iges(const TopoDS_Shape& shape, const std::string& name) {
  IGESControl_Writer writer("MM", 0);
  told(writer.AddShape(shape) && writer.Write((folder + "/" + name + ".iges").c_str()), name);
}

void brep(const TopoDS_Shape& shape, const std::string& name) {
  told(BRepTools::Write(shape, (folder + "/" + name + ".brep").c_str()), name);
}

TopoDS_Shape box(double x, double y, double z, double dx, double dy, double dz) {
  return BRepPrimAPI_MakeBox(gp_Pnt(x, y, z), dx, dy, dz).Shape();
}

/// A box of 40 mm with a cavity that is a box: from x = 10 to 30, or from 30 to 60, which is half outside of it.
TopoDS_Shape boxWithCavity(double from, double to) {
  const BRep_Builder builder;
  TopoDS_Solid solid;
  builder.MakeSolid(solid);
  builder.Add(solid, TopExp_Explorer(box(0, 0, 0, 40, 40, 40), TopAbs_SHELL).Current());
  builder.Add(solid, TopExp_Explorer(box(from, 10, 10, to - from, 20, 20), TopAbs_SHELL).Current().Reversed());
  return solid;
}

TopoDS_Wire loop(const Handle(Geom_Curve) & curve) {
  return BRepBuilderAPI_MakeWire(BRepBuilderAPI_MakeEdge(curve));
}

Handle(Geom_Circle) circle(double x, double y, double radius) {
  return new Geom_Circle(gp_Ax2(gp_Pnt(x, y, 0), gp_Dir(0, 0, 1)), radius);
}

/// A plate of 100 mm or what the holes need, 5 mm thick below z = 5; holes of 0.6 mm, 1.6 mm apart: what is quadratic
/// in the loops of a face takes minutes here.
TopoDS_Shape plateWithHoles(int columns, int rows) {
  const double size = std::max(100.0, 1.6 * columns + 8);
  BRepBuilderAPI_MakeFace face(gp_Pln(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1)), 0, size, 0, size);
  for (int i = 0; i < columns; ++i)
    for (int j = 0; j < rows; ++j) face.Add(TopoDS::Wire(loop(circle(4 + 1.6 * i, 4 + 1.6 * j, 0.6)).Reversed()));
  return BRepPrimAPI_MakePrism(face.Face(), gp_Vec(0, 0, 5)).Shape();
}

/// A square plate of 40 mm, 5 mm thick, with a round hole of 10 mm whose edge is one closed spline.
TopoDS_Shape plateWithSplineHole() {
  BRepBuilderAPI_MakeFace face(gp_Pln(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1)), -20, 20, -20, 20);
  const Handle(Geom_BSplineCurve) round = GeomConvert::CurveToBSplineCurve(circle(0, 0, 5));
  face.Add(TopoDS::Wire(loop(round).Reversed()));
  return BRepPrimAPI_MakePrism(face.Face(), gp_Vec(0, 0, 5)).Shape();
}

/// y = x^2 / 10 for |x| <= 10, along z from 0 to 20.
TopoDS_Shape trough() {
  TColgp_Array1OfPnt poles(1, 3);
  poles(1) = gp_Pnt(-10, 10, 0), poles(2) = gp_Pnt(0, -10, 0), poles(3) = gp_Pnt(10, 10, 0);
  const Handle(Geom_BezierCurve) parabola = new Geom_BezierCurve(poles);
  return BRepPrimAPI_MakePrism(BRepBuilderAPI_MakeEdge(parabola).Edge(), gp_Vec(0, 0, 20)).Shape();
}

/// A roof z = |x| over |x| <= 10, 0 <= y <= 20, one spline face with a crease at the parameter `crease` of 0 to 2; and
/// the sheet 3 mm off a curved one.
TopoDS_Shape roof(double crease, int degree) {
  TColgp_Array2OfPnt poles(1, 3, 1, 2);
  for (int j = 1; j <= 2; ++j) {
    const double y = 20.0 * (j - 1);
    poles(1, j) = gp_Pnt(-10, y, 10), poles(2, j) = gp_Pnt(0, y, 0), poles(3, j) = gp_Pnt(10, y, 10);
  }
  TColStd_Array1OfReal u(1, 3), v(1, 2);
  u(1) = 0, u(2) = crease, u(3) = 2, v(1) = 0, v(2) = 1;
  TColStd_Array1OfInteger mu(1, 3), mv(1, 2);
  mu(1) = 2, mu(2) = 1, mu(3) = 2, mv(1) = 2, mv(2) = 2;
  const Handle(Geom_BSplineSurface) surface = new Geom_BSplineSurface(poles, u, v, mu, mv, 1, 1);
  surface->IncreaseDegree(degree, 1);
  return BRepBuilderAPI_MakeFace(surface, 1e-7).Face();
}

/// 2 mm outside a quarter of a cylinder of 10 mm about z, 20 mm high, whose basis is a spline.
TopoDS_Shape shellOff() {
  const Handle(Geom_TrimmedCurve) arc = new Geom_TrimmedCurve(circle(0, 0, 10), 0, std::numbers::pi / 2);
  const Handle(Geom_BSplineCurve) spline = GeomConvert::CurveToBSplineCurve(arc);
  TColgp_Array2OfPnt poles(1, spline->NbPoles(), 1, 2);
  TColStd_Array2OfReal weights(1, spline->NbPoles(), 1, 2);
  for (int i = 1; i <= spline->NbPoles(); ++i)
    for (int j = 1; j <= 2; ++j) {
      poles(i, j) = spline->Pole(i).Translated(gp_Vec(0, 0, 20.0 * (j - 1)));
      weights(i, j) = spline->Weight(i);
    }
  TColStd_Array1OfReal knots(1, spline->NbKnots()), v(1, 2);
  TColStd_Array1OfInteger mults(1, spline->NbKnots()), mv(1, 2);
  spline->Knots(knots);
  spline->Multiplicities(mults);
  v(1) = 0, v(2) = 1, mv(1) = 2, mv(2) = 2;
  const Handle(Geom_BSplineSurface) basis =
      new Geom_BSplineSurface(poles, weights, knots, v, mults, mv, spline->Degree(), 1);
  const Handle(Geom_OffsetSurface) off = new Geom_OffsetSurface(basis, 2);
  return BRepBuilderAPI_MakeFace(off, 1e-7).Face();
}

TopoDS_Shape faces(const TopoDS_Shape& shape) {
  TopoDS_Compound loose;
  const BRep_Builder builder;
  builder.MakeCompound(loose);
  for (TopExp_Explorer at(shape, TopAbs_FACE); at.More(); at.Next()) builder.Add(loose, at.Current());
  return loose;
}

/// A quarter of a ball of 20 mm, y and z positive, as splines whose own poles are not on it. Its edges are two half
/// circles that meet at both ends: meridians of the sphere that the spline is.
TopoDS_Shape splineQuarter() {
  const gp_Ax2 tilted(gp_Pnt(0, 0, 0), gp_Dir(0, 1, -1), gp_Dir(0, -1, -1));
  const TopoDS_Shape ball = BRepPrimAPI_MakeSphere(tilted, 20).Shape();
  return BRepBuilderAPI_NurbsConvert(BRepAlgoAPI_Common(ball, box(-30, 0, 0, 60, 30, 30)).Shape(), true).Shape();
}

/// A plate of 40 mm, 10 mm thick, with a hole, and a pin of the same radius that stands on the rim of the hole: four
/// faces meet there, two of each solid.
TopoDS_Shape pinOnRim() {
  const gp_Ax2 below(gp_Pnt(20, 20, -1), gp::DZ()), above(gp_Pnt(20, 20, 10), gp::DZ());
  TopoDS_Compound both;
  const BRep_Builder builder;
  builder.MakeCompound(both);
  builder.Add(both, BRepAlgoAPI_Cut(box(0, 0, 0, 40, 40, 10), BRepPrimAPI_MakeCylinder(below, 5, 12).Shape()).Shape());
  builder.Add(both, BRepPrimAPI_MakeCylinder(above, 5, 10).Shape());
  return both;
}

/// A closed shell without a volume: the upper half of a sphere of 10 mm, twice, with opposite normals.
TopoDS_Shape twiceOneCap() {
  const BRep_Builder builder;
  TopoDS_Shell shell;
  builder.MakeShell(shell);
  const TopoDS_Face upper = BRepBuilderAPI_MakeFace(gp_Sphere(gp_Ax3(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1)), 10), 0,
                                                    2 * std::numbers::pi, 0, std::numbers::pi / 2);
  TopoDS_Shape again = upper.EmptyCopied();
  for (TopoDS_Iterator at(upper); at.More(); at.Next()) builder.Add(again, at.Value());
  builder.Add(shell, upper);
  builder.Add(shell, again.Reversed());
  shell.Closed(true);
  return shell;
}

/// A box of 20 mm, one of whose vertices lies 2 mm beside the ends of its three edges, with a tolerance to match.
TopoDS_Shape boxWithVertexOff() {
  const TopoDS_Shape shape = box(0, 0, 0, 20, 20, 20);
  const TopoDS_Vertex vertex = TopoDS::Vertex(TopExp_Explorer(shape, TopAbs_VERTEX).Current());
  BRep_Builder().UpdateVertex(vertex, BRep_Tool::Pnt(vertex).Translated(gp_Vec(0, 0, 2)), 2.5);
  return shape;
}

TopoDS_Shape solidOf(const TopoDS_Shape& shell) {
  const BRep_Builder builder;
  TopoDS_Solid solid;
  builder.MakeSolid(solid);
  builder.Add(solid, shell);
  return solid;
}

/// Two of one block of 10 mm, 30 mm apart along x, the second turned a quarter about z; names and colours.
void assembly() {
  Handle(TDocStd_Document) document;
  XCAFApp_Application::GetApplication()->NewDocument("MDTV-XCAF", document);
  const Handle(XCAFDoc_ShapeTool) shapes = XCAFDoc_DocumentTool::ShapeTool(document->Main());
  const Handle(XCAFDoc_ColorTool) colours = XCAFDoc_DocumentTool::ColorTool(document->Main());
  const TDF_Label block = shapes->AddShape(box(0, 0, 0, 10, 10, 10), false), whole = shapes->NewShape();
  TDataStd_Name::Set(block, "block");
  TDataStd_Name::Set(whole, "pair");
  colours->SetColor(block, Quantity_Color(1, 0, 0, Quantity_TOC_sRGB), XCAFDoc_ColorSurf);
  gp_Trsf turn, move;
  turn.SetRotation(gp::OZ(), std::numbers::pi / 2);
  move.SetTranslation(gp_Vec(40, 0, 0));
  TDataStd_Name::Set(shapes->AddComponent(whole, block, TopLoc_Location()), "left");
  TDataStd_Name::Set(shapes->AddComponent(whole, block, TopLoc_Location(move * turn)), "right");
  shapes->UpdateAssemblies();
  STEPCAFControl_Writer writer;
  Interface_Static::SetCVal("write.step.unit", "MM");
  told(writer.Transfer(document) && writer.Write((folder + "/assembly.step").c_str()) == IFSelect_RetDone, "assembly");
  STEPCAFControl_Writer apart;  // each part goes into a file of its own, whose name begins with apart_
  told(apart.Transfer(document, STEPControl_AsIs, "apart_") &&
           apart.Write((folder + "/apart.step").c_str()) == IFSelect_RetDone,
       "apart");
}

void solids() {
  const TopoDS_Shape block = box(-20, -15, -10, 40, 30, 20), cylinder = BRepPrimAPI_MakeCylinder(10, 20).Shape();
  step(block, "box");
  iges(block, "box");
  brep(faces(block), "loose");
  step(box(0, 0, 0, 25.4, 25.4, 25.4), "inch", "INCH");
  step(cylinder, "cylinder");
  step(BRepBuilderAPI_NurbsConvert(block, true).Shape(), "spline_box");
  step(BRepBuilderAPI_NurbsConvert(cylinder, true).Shape(), "spline_cylinder");
  gp_Trsf mirror;
  mirror.SetMirror(gp_Ax2(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1)));
  brep(BRepBuilderAPI_Transform(cylinder, mirror, true).Shape(), "mirrored");
  brep(cylinder.Reversed(), "inside_out");
  step(BRepPrimAPI_MakeSphere(20).Shape(), "sphere");
  step(BRepPrimAPI_MakeCone(10, 0, 20).Shape(), "cone");
  step(BRepPrimAPI_MakeCylinder(10, 20, 1.5 * std::numbers::pi).Shape(), "three_quarters");
  step(BRepPrimAPI_MakeTorus(20, 5).Shape(), "torus");
  step(BRepAlgoAPI_Cut(BRepPrimAPI_MakeCylinder(10, 500), BRepPrimAPI_MakeCylinder(9.99, 500)).Shape(), "foil");
  step(BRepAlgoAPI_Cut(box(0, 0, 0, 40, 40, 10), box(10, 10, -1, 40, 40, 12)).Shape(), "bracket");
  step(BRepAlgoAPI_Fuse(box(0, 0, 0, 20, 10, 10), box(20, 0, 0, 20, 10, 10)).Shape(), "coplanar");
  const int columns = hapticd::support::kLong ? 58 : 24;
  step(plateWithHoles(columns, columns - 1), "plate");
  step(plateWithSplineHole(), "spline_hole");
}

void sheetsAndOddOnes() {
  brep(trough(), "trough");
  gp_Trsf aside;
  aside.SetTranslation({100, 0, 0});
  brep(trough().Moved(TopLoc_Location(aside)), "moved_trough");
  brep(roof(1, 1), "roof");
  brep(roof(0.7, 20), "roof_of_degree_20");
  brep(shellOff(), "shell_off");
  brep(boxWithCavity(10, 30), "cavity");
  brep(boxWithCavity(30, 60), "crossing_cavity");
  brep(faces(boxWithCavity(10, 30)), "loose_cavity");
  brep(boxWithVertexOff(), "vertex_off");
  brep(twiceOneCap(), "no_volume_shell");
  brep(solidOf(twiceOneCap()), "no_volume");
  iges(pinOnRim(), "pin_on_rim");
  brep(splineQuarter(), "spline_quarter");
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2 && argc != 3) return 2;
  folder = argv[1];
  Message::DefaultMessenger()->ChangePrinters().Clear();
  if (argc == 3) {
    const int rows = std::atoi(argv[2]);
    step(plateWithHoles(rows, rows), "plate");
    return failures;
  }
  solids();
  sheetsAndOddOnes();
  assembly();
  return failures;
}

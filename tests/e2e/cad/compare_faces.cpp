// SPDX-License-Identifier: MIT
/// Trims, feet and sides of an imported part against Open CASCADE's, face by face, at random points.
///   compare_faces FILE.step|FILE.brep PART.hpart COUNT      prints one line of JSON
/// The part has to keep the file's own parameters, and one body in the file's own frame.
#include <BRepBndLib.hxx>
#include <BRepBuilderAPI_MakeVertex.hxx>
#include <BRepClass3d_SolidClassifier.hxx>
#include <BRepClass_FaceClassifier.hxx>
#include <BRepExtrema_DistShapeShape.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <Geom_Surface.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <STEPControl_Reader.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Face.hxx>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "kernels/brep/contact/tracer.hpp"
#include "kernels/part/file.hpp"

namespace {

using namespace hapticd;
using Eigen::Vector3d;

constexpr double kMetres = 1e-3;  ///< Open CASCADE's millimetres
constexpr double kBeside = 1e-6;  ///< [mm] nearer to an edge, a point is in or out as one likes
constexpr double kSame = 1e-6;    ///< [mm] surfaces with one parameter

struct Shape {
  TopoDS_Shape whole;
  std::vector<TopoDS_Face> faces;
  std::vector<Bnd_Box> boxes;
  TopoDS_Shape solid;  ///< null: not just one
};

Shape readShape(const std::string& file) {
  Shape shape;
  if (file.size() > 5 && file.substr(file.size() - 5) == ".brep") {
    BRep_Builder builder;
    BRepTools::Read(shape.whole, file.c_str(), builder);
  } else {
    STEPControl_Reader reader;
    reader.ReadFile(file.c_str());
    reader.TransferRoots();
    shape.whole = reader.OneShape();
  }
  for (TopExp_Explorer at(shape.whole, TopAbs_FACE); at.More(); at.Next()) {
    shape.faces.push_back(TopoDS::Face(at.Current()));
    shape.boxes.emplace_back();
    BRepBndLib::Add(shape.faces.back(), shape.boxes.back());
  }
  int solids = 0;
  for (TopExp_Explorer at(shape.whole, TopAbs_SOLID); at.More(); at.Next(), ++solids) shape.solid = at.Current();
  if (solids != 1) shape.solid.Nullify();
  return shape;
}

brep::Part readOurs(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  return brep::readPart(std::as_bytes(std::span(bytes)), file);
}

struct Tally {
  long trims = 0, trim_wrong = 0, beside = 0, unmatched = 0, feet = 0, proved = 0, no_answer = 0;
  long sides = 0, side_wrong = 0;  ///< of the only solid, farther from it than its tolerance
  double farther = 0, nearer = 0;  ///< [mm] largest difference of ours to theirs, each way
  std::string side_points;         ///< JSON [x, y, z (mm), inside by ours] of the first wrong ones
};

class Comparison {
 public:
  Comparison(Shape shape, const brep::Model& model) : shape_(std::move(shape)), model_(model), search_(model) {}

  Tally run(long count) {
    for (std::uint32_t f = 0; f < model_.part().faces.size(); ++f) match(f);
    for (long i = 0; i < count; ++i) compareTrim();
    for (long i = 0; i < count; ++i) compareFoot();
    if (!shape_.solid.IsNull() && model_.placements().size() == 1 && model_.placements()[0].solid) compareSides(count);
    return tally_;
  }

 private:
  double share() { return std::uniform_real_distribution<double>(0, 1)(random_); }
  Eigen::Array2d at(const brep::Face& face, double s, double t) const {
    return {face.lo[0] + s * (face.hi[0] - face.lo[0]), face.lo[1] + t * (face.hi[1] - face.lo[1])};
  }
  gp_Pnt ours(const brep::Face& face, const Eigen::Array2d& uv) const {
    spline::SurfacePoint point;
    model_.geometry().surface(face.surface, uv[0], uv[1], point);
    const Vector3d p = point.S / kMetres;
    return {p.x(), p.y(), p.z()};
  }

  /// Which of their faces has the same surface with the same parameters, and holds ours.
  void match(std::uint32_t f) {
    const brep::Face& face = model_.part().faces[f];
    for (const TopoDS_Face& theirs : shape_.faces) {
      const Handle(Geom_Surface) surface = BRep_Tool::Surface(theirs);
      double u0 = 0, u1 = 0, v0 = 0, v1 = 0;
      BRepTools::UVBounds(theirs, u0, u1, v0, v1);
      const double off = std::abs(u0 - face.lo[0]) + std::abs(v0 - face.lo[1]) + std::abs(u1 - face.hi[0]);
      bool same = off < 1e-6 * (1 + std::abs(u1 - u0));
      for (int k = 0; k < 4 && same; ++k) {
        const Eigen::Array2d uv = at(face, 0.1 + 0.2 * k, 0.8 - 0.2 * k);
        same = surface->Value(uv[0], uv[1]).Distance(ours(face, uv)) < kSame;
      }
      if (!same) continue;
      matched_.emplace_back(f, theirs);
      return;
    }
    ++tally_.unmatched;
  }

  void compareTrim() {
    if (matched_.empty()) return;
    const auto& [f, theirs] = matched_[random_() % matched_.size()];
    const Eigen::Array2d uv = at(model_.part().faces[f], 1.2 * share() - 0.1, 1.2 * share() - 0.1);
    const bool inside = model_.face(f).trim.inside(uv[0], uv[1]);
    const BRepClass_FaceClassifier judged(theirs, gp_Pnt2d(uv[0], uv[1]), 1e-9);
    ++tally_.trims;
    if (judged.State() == TopAbs_ON || inside == (judged.State() == TopAbs_IN)) return;
    if (besideAnEdge(theirs, ours(model_.part().faces[f], uv))) {
      ++tally_.beside;
    } else {
      ++tally_.trim_wrong;
    }
  }

  static bool besideAnEdge(const TopoDS_Face& face, const gp_Pnt& p) {
    const TopoDS_Shape vertex = BRepBuilderAPI_MakeVertex(p).Shape();
    for (TopExp_Explorer at(face, TopAbs_EDGE); at.More(); at.Next()) {
      const BRepExtrema_DistShapeShape found(vertex, at.Current());
      if (found.IsDone() && found.Value() < kBeside + BRep_Tool::Tolerance(TopoDS::Edge(at.Current()))) return true;
    }
    return false;
  }

  Vector3d anywhere() {
    const Eigen::AlignedBox3d& box = model_.bounds();
    Vector3d p = box.min();
    for (int k = 0; k < 3; ++k) p[k] += (1.3 * share() - 0.15) * box.sizes()[k];
    return p;
  }

  /// Every other point is within 1 mm of the surface.
  void compareSides(long count) {
    BRepClass3d_SolidClassifier judge(shape_.solid);
    brep::Tracer tracer(model_);
    const double least = kBeside + model_.part().tolerance / kMetres;
    for (long i = 0; i < count; ++i) {
      Vector3d p = anywhere();
      contact::Foot foot = tracer.nearest(p);
      if (i % 2 == 0) foot = tracer.nearest(p = foot.point + (2 * share() - 1) * kMetres * foot.normal);
      if (foot.distance / kMetres < least) continue;
      const Vector3d q = p / kMetres;
      judge.Perform(gp_Pnt(q.x(), q.y(), q.z()), 1e-9);
      if (judge.State() != TopAbs_IN && judge.State() != TopAbs_OUT) continue;
      ++tally_.sides;
      const bool wrong = (foot.depth > 0) != (judge.State() == TopAbs_IN);
      tally_.side_wrong += wrong;
      constexpr long kMostNamed = 100;
      if (!wrong || tally_.side_wrong > kMostNamed) continue;
      char text[160];
      std::snprintf(text, sizeof text, "%s[%.17g, %.17g, %.17g, %d]", tally_.side_wrong > 1 ? ", " : "", q.x(), q.y(),
                    q.z(), foot.depth > 0 ? 1 : 0);
      tally_.side_points += text;
    }
  }

  void compareFoot() {
    const Vector3d p = anywhere();
    const brep::Nearest& found = search_.nearest(p);
    search_.reset();
    const Vector3d q = p / kMetres;
    const double distance = found.distance() / kMetres, best = theirs(gp_Pnt(q.x(), q.y(), q.z()), distance);
    ++tally_.feet;
    tally_.proved += found.proved;
    if (!(best < 1e50)) {
      ++tally_.no_answer;
      return;
    }
    tally_.farther = std::max(tally_.farther, distance - best);
    tally_.nearer = std::max(tally_.nearer, best - distance);
  }

  /// [mm] over all faces whose boxes are no farther than ours says.
  double theirs(const gp_Pnt& p, double hint) const {
    const TopoDS_Shape vertex = BRepBuilderAPI_MakeVertex(p).Shape();
    Bnd_Box point;
    point.Set(p);
    double best = 1e100;
    for (std::size_t i = 0; i < shape_.faces.size(); ++i) {
      if (shape_.boxes[i].Distance(point) > std::min(best, hint + 0.1)) continue;
      const BRepExtrema_DistShapeShape found(vertex, shape_.faces[i]);
      if (found.IsDone() && found.NbSolution() > 0) best = std::min(best, found.Value());
    }
    return best;
  }

  Shape shape_;
  const brep::Model& model_;
  brep::Search search_;
  std::vector<std::pair<std::uint32_t, TopoDS_Face>> matched_;
  std::mt19937 random_{7};
  Tally tally_;
};

}  // namespace

int main(int count, char** arguments) {
  if (count != 4) {
    std::fprintf(stderr, "usage: compare_faces FILE PART COUNT\n");
    return 2;
  }
  Message::DefaultMessenger()->ChangePrinters().Clear();
  const brep::Model model(readOurs(arguments[2]));
  const Tally t = Comparison(readShape(arguments[1]), model).run(std::atol(arguments[3]));
  std::printf(
      "{\"trims\": %ld, \"trim_wrong\": %ld, \"beside\": %ld, \"unmatched\": %ld, \"feet\": %ld, \"proved\": %ld, "
      "\"no_answer\": %ld, \"sides\": %ld, \"side_wrong\": %ld, \"side_points\": [%s], \"farther_mm\": %.3g, "
      "\"nearer_mm\": %.3g}\n",
      t.trims, t.trim_wrong, t.beside, t.unmatched, t.feet, t.proved, t.no_answer, t.sides, t.side_wrong,
      t.side_points.c_str(), t.farther, t.nearer);
  return 0;
}

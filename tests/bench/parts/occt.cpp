// SPDX-License-Identifier: MIT
#include "occt.hpp"

#ifdef HAVE_OCCT
#include <BRepAdaptor_Curve.hxx>
#include <BRepAdaptor_Surface.hxx>
#include <BRepBndLib.hxx>
#include <BRepTools.hxx>
#include <BRepTopAdaptor_FClass2d.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <Extrema_ExtPC.hxx>
#include <Extrema_ExtPS.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <STEPControl_Reader.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <algorithm>
#include <cmath>
#include <vector>
#endif

namespace hapticd::bench {

#ifndef HAVE_OCCT
std::unique_ptr<OcctPart> readOcctPart(const std::string&) {
  return nullptr;
}
#else

namespace {

constexpr double kMetres = 1e-3;  ///< metres per millimetre, the unit of Open CASCADE

struct Face {
  BRepAdaptor_Surface surface;
  Extrema_ExtPS nearest;
  std::unique_ptr<BRepTopAdaptor_FClass2d> trim;
  Bnd_Box box;
};

struct Edge {
  BRepAdaptor_Curve curve;
  Extrema_ExtPC nearest;
  Bnd_Box box;
};

class Prepared final : public OcctPart {
 public:
  explicit Prepared(const TopoDS_Shape& shape) {
    for (TopExp_Explorer at(shape, TopAbs_FACE); at.More(); at.Next()) addFace(TopoDS::Face(at.Current()));
    TopTools_IndexedMapOfShape edges;
    TopExp::MapShapes(shape, TopAbs_EDGE, edges);
    for (int i = 1; i <= edges.Extent(); ++i) addEdge(TopoDS::Edge(edges(i)));
  }

  double distance(const Eigen::Vector3d& p, double bound) override {
    const gp_Pnt point(p.x() / kMetres, p.y() / kMetres, p.z() / kMetres);
    Bnd_Box box;
    box.Set(point);
    double best = bound / kMetres;
    order_.clear();
    for (std::size_t i = 0; i < faces_.size(); ++i) order_.emplace_back(faces_[i]->box.Distance(box), i);
    for (std::size_t i = 0; i < edges_.size(); ++i)
      order_.emplace_back(edges_[i]->box.Distance(box), faces_.size() + i);
    std::sort(order_.begin(), order_.end());
    for (const auto& [far, i] : order_) {
      if (far > best) break;
      best = std::min(best, i < faces_.size() ? toFace(*faces_[i], point) : toEdge(*edges_[i - faces_.size()], point));
    }
    return best * kMetres;
  }

 private:
  void addFace(const TopoDS_Face& face) {
    auto made = std::make_unique<Face>();
    made->surface.Initialize(face);
    double u0 = 0, u1 = 0, v0 = 0, v1 = 0;
    BRepTools::UVBounds(face, u0, u1, v0, v1);
    made->nearest.SetFlag(Extrema_ExtFlag_MIN);
    made->nearest.Initialize(made->surface, u0, u1, v0, v1, 1e-9, 1e-9);
    made->trim = std::make_unique<BRepTopAdaptor_FClass2d>(face, 1e-9);
    BRepBndLib::AddOptimal(face, made->box, false, false);
    faces_.push_back(std::move(made));
  }
  void addEdge(const TopoDS_Edge& edge) {
    if (BRep_Tool::Degenerated(edge)) return;
    auto made = std::make_unique<Edge>();
    made->curve.Initialize(edge);
    made->nearest.Initialize(made->curve, made->curve.FirstParameter(), made->curve.LastParameter(), 1e-10);
    BRepBndLib::AddOptimal(edge, made->box, false, false);
    edges_.push_back(std::move(made));
  }

  /// Returns the distance [mm] to the nearest foot inside the loops of a face. Other points of the face are on its
  /// edges.
  static double toFace(Face& face, const gp_Pnt& p) {
    double best = 1e100;
    face.nearest.Perform(p);
    if (!face.nearest.IsDone()) return best;
    for (int i = 1; i <= face.nearest.NbExt(); ++i) {
      double u = 0, v = 0;
      face.nearest.Point(i).Parameter(u, v);
      if (face.trim->Perform(gp_Pnt2d(u, v)) == TopAbs_OUT) continue;
      best = std::min(best, face.nearest.SquareDistance(i));
    }
    return std::sqrt(best);
  }
  static double toEdge(Edge& edge, const gp_Pnt& p) {
    edge.nearest.Perform(p);
    double first = 0, last = 0;
    gp_Pnt a, b;
    edge.nearest.TrimmedSquareDistances(first, last, a, b);
    double best = std::min(first, last);
    if (edge.nearest.IsDone())
      for (int i = 1; i <= edge.nearest.NbExt(); ++i) best = std::min(best, edge.nearest.SquareDistance(i));
    return std::sqrt(best);
  }

  std::vector<std::unique_ptr<Face> > faces_;
  std::vector<std::unique_ptr<Edge> > edges_;
  std::vector<std::pair<double, std::size_t> > order_;
};

}  // namespace

std::unique_ptr<OcctPart> readOcctPart(const std::string& file) {
  Message::DefaultMessenger()->ChangePrinters().Clear();
  TopoDS_Shape shape;
  if (file.size() > 5 && file.substr(file.size() - 5) == ".brep") {
    BRep_Builder builder;
    BRepTools::Read(shape, file.c_str(), builder);
  } else {
    STEPControl_Reader reader;
    reader.ReadFile(file.c_str());
    reader.TransferRoots();
    shape = reader.OneShape();
  }
  return std::make_unique<Prepared>(shape);
}
#endif

}  // namespace hapticd::bench

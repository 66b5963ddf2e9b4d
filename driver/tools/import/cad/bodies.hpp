// SPDX-License-Identifier: MIT
/// Converts one body: its faces, loops, coedges, edges and vertices become records of a part.
#pragma once
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Vertex.hxx>
#include <optional>
#include <string>

#include "cad_import/healing.hpp"
#include "cad_import/outline_check.hpp"
#include "cad_import/recognition.hpp"
#include "cad_import/surfaces.hpp"

namespace hapticd::cad {

class BodyBuilder {
 public:
  /// @param name name of the body, for the list of losses
  BodyBuilder(const Colours& colours, std::string name, brep::Part& part);

  /// [main] Appends the body and returns its index. Faces that cannot be converted are listed in Part::losses.
  std::uint32_t add(const TopoDS_Shape& shape, std::uint32_t name, std::uint32_t colour);
  /// Returns how many spline faces of the body were found to be planes, cylinders, cones or spheres.
  std::size_t recognisedFaces() const { return recognised_; }
  /// Returns how far the outlines of the faces contradict themselves.
  const std::vector<OutlineOff>& outlines() const { return outlines_; }

 private:
  struct Sizes {
    std::size_t surfaces, curves3, curves2, reals, vertices, edges, coedges, loops, faces, losses;
  };
  Sizes sizes() const;
  void cutBack(const Sizes& to);
  void tryFace(const TopoDS_Face& face);
  bool addDisguised(const TopoDS_Face& face);
  void noteOutline(const TopoDS_Face& face, bool with_curves);
  void addFace(const TopoDS_Face& face, const brep::Surface* shape);
  void addLoop(const TopoDS_Face& face, const TopoDS_Shape& wire, const brep::Face& range);
  void addCoedge(const TopoDS_Face& face, const TopoDS_Edge& edge);
  std::uint32_t edgeOf(const TopoDS_Edge& edge);
  std::uint32_t vertexOf(const TopoDS_Vertex& vertex);
  void note(const std::string& what, const Kept& kept);
  bool isClosed(const brep::Body& body) const;
  void setKind(const TopoDS_Shape& shape, brep::Body& body, bool doubled, bool told);
  std::size_t addFaces(const TopoDS_Shape& shape);

  const Colours& colours_;
  std::string name_;
  brep::Part& part_;
  TopTools_IndexedMapOfShape edges_, vertices_;  ///< edges and vertices of the body; the orientation does not matter
  std::vector<std::uint32_t> edge_index_, vertex_index_;
  std::size_t face_number_ = 0, recognised_ = 0;
  std::vector<OutlineOff> outlines_;    ///< of the faces that were kept
  std::optional<Unfolding> unfolding_;  ///< set while a face is converted whose surface was recognised
};

}  // namespace hapticd::cad

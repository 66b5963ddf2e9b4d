// SPDX-License-Identifier: MIT
/// Finds the nearest point of a part: at most one search of limited work per tick, and none if the last search still
/// proves the answer.
#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "kernels/brep/model/model.hpp"
#include "kernels/brep/search/descent.hpp"
#include "kernels/brep/search/near_places.hpp"
#include "kernels/brep/search/near_planes.hpp"
#include "kernels/brep/search/near_rows.hpp"

namespace hapticd::brep {

/// Limits of the work of one search.
struct SearchBudget {
  int nodes = 2048;    ///< most nodes of the tree, of four boxes each
  int elements = 256;  ///< most elements whose foot is computed; four times as many of them if they are triangles
};

/// The result of a search.
struct Nearest {
  Hit hit;                      ///< nearest point, in the frame of its body
  std::uint32_t place = kNone;  ///< index in Model::placements(); kNone if nothing was found
  /// [m] Lower bound of the distance from the probe to every other element. If `hit` is on an edge, the faces beside it
  /// are not among these.
  double others = 0;
  /// [m^2] Lower bound of the squared distance to elements that may be nearer than `hit`, because the search was cut
  /// short or is not certain of them; infinity if there are none.
  double open2 = std::numeric_limits<double>::infinity();
  bool proved = false;     ///< `hit` is certainly the nearest point of all
  bool exhausted = false;  ///< the budget ended before the search was finished
  int nodes = 0, elements = 0;

  bool found() const noexcept { return place != kNone; }
  double distance() const noexcept;
};

/// Finds nearest points for one probe. Several Search objects can share a Model.
class Search {
 public:
  /// [main] Allocates everything that searching needs.
  explicit Search(const Model& model);

  /// [rt] Returns the nearest point of all placements to p (model frame), which must be finite: see Tracer.
  const Nearest& nearest(const Eigen::Vector3d& p, const SearchBudget& budget = {}) noexcept;
  /// [rt] Returns the nearest point of one placement, starting from `start`. @param face only this face (index in the
  /// part) and its edges are searched; kNone for all faces
  Nearest nearestOf(std::uint32_t place, std::uint32_t face, const Eigen::Vector3d& p, const Hit& start,
                    const SearchBudget& budget = {}) noexcept;
  /// [rt] Returns the nearest point of the element of `last`, starting from that point. Its d2 is infinite if the
  /// element does not contain the foot.
  Hit refine(std::uint32_t place, const Hit& last, const Eigen::Vector3d& p) noexcept;
  /// [rt] Finds the placements that bound a volume and whose boxes contain p, and returns how many it wrote to
  /// `places`, at most `cap`.
  int around(const Eigen::Vector3d& p, std::uint32_t* places, int cap) const noexcept;
  /// [rt] Forgets the last result.
  void reset() noexcept { last_.place = kNone; }
  const Nearest& last() const noexcept { return last_; }
  const Model& model() const noexcept { return model_; }

 private:
  /// Relative rounding error of a distance: a box or foot that is farther than the best one by less than this share of
  /// the distance counts as equally near.
  static constexpr double kRounding = 1e-12;
  /// [m^2] Squared distance of the nearest point up to which rows are gathered. Beyond it, an unused place among them
  /// (RowBox::kWhole) could look as near.
  static constexpr double kFarthestNear2 = 1e34;

  /// The state of one search.
  struct Run {
    Nearest best;
    SearchBudget budget;
    Element first;                      ///< the element that was examined before all others
    std::uint32_t first_place = kNone;  ///< placement of `first`
    double first_least2 = 0;            ///< result of lowerBoundOf() for `first`
    /// [m^2] squared distance to a known point of the part: the nearest point is not farther.
    double limit2 = std::numeric_limits<double>::infinity();
    double others2 = std::numeric_limits<double>::infinity();  ///< [m^2] least bound of all elements except the best
    /// [m^2] Least squared distance at which an element may have a point that was not found: its search was cut short
    /// or is not certain. If this is below best.hit.d2, the best foot is not proved to be the nearest.
    double open2 = std::numeric_limits<double>::infinity();
    bool tied = false;  ///< another element is as near as the best one, and neither of them is `first`
    int restarts = 0;   ///< number of leaves left on which Newton's method may start from several places

    /// [m^2] An element that is farther than this cannot be the nearest.
    double within2() const noexcept { return std::min(best.hit.d2, limit2); }
  };
  /// The examination of one element: how Newton's method starts, and what it found out ("out").
  struct Examination {
    const Hit* start = nullptr;  ///< the last foot on the element; null if there is none
    LeafFeet feet;
    Eigen::Array2d uv{0, 0};                                  ///< leaves: (u, v) where Newton's method starts
    bool elsewhere = true;                                    ///< LeafStart::elsewhere
    double limit2 = std::numeric_limits<double>::infinity();  ///< LeafStart::limit2
    bool proved = true;  ///< out: the element certainly has no nearer point than the one found
    int starts = 1;      ///< out: NewtonResult::starts
    double least2 = -1;  ///< out: leaves only, the result of lowerBoundOf()
  };

  /// The search of one tree.
  struct Descent {
    const BodyTree& body;
    const std::uint32_t* of_face;  ///< BodyTree::of_faces in the tree of a single face, else null
    std::uint32_t place;
    const Eigen::Vector3d& p;
    Element first;  ///< an element that was examined before
    BoxProbe probe;
  };

  double vertexLimit(const Eigen::Vector3d& p) const noexcept;
  void begin(const Eigen::Vector3d& p, Run& run) noexcept;
  class MeshWalk;
  bool walkMesh(const Eigen::Vector3d& p, const SearchBudget& budget) noexcept;
  bool reuseLast(const Eigen::Vector3d& p, double way, const Run& run) noexcept;
  bool searchNear(const Eigen::Vector3d& p, double way, Run& run) noexcept;
  void moveNear(double way) noexcept;
  template <class Near>
  bool searchNear(Near& near, const Eigen::Vector3d& p, double way, Run& run) noexcept;
  template <class Near>
  void adaptReach(const Near& near, const Eigen::Vector3d& p, double distance) noexcept;
  template <class Near>
  bool gatherNear(Near& near, const Eigen::Vector3d& p, double way, double distance) noexcept;
  template <class Near>
  void examineRows(Near& near, std::uint32_t place, const Eigen::Vector3d& p, Run& run) noexcept;
  template <class Near>
  void examineAll(Near& near, const Eigen::Vector3d& p, Run& run) noexcept;
  template <class Near>
  bool examineNear(Near& near, const Eigen::Vector3d& p, Run& run) noexcept;
  void examineTriangles(const Descent& at, const DescentEntry& entry, Run& run) noexcept;
  template <class Take>
  static void measureElements(const Descent& at, const ElementRow& row, const Take& take) noexcept;
  void examineElements(const Descent& at, const DescentEntry& entry, Run& run) noexcept;
  void searchTree(const BodyTree& body, std::int32_t root, std::uint32_t place, const Eigen::Vector3d& p,
                  Run& run) noexcept;
  void searchWhole(const Eigen::Vector3d& p, Run& run) noexcept;
  void searchPlaces(const Eigen::Vector3d& p, Run& run) noexcept;
  template <class Whole>
  static void searchWithin(Run& run, const Whole& whole) noexcept;
  double examine(std::uint32_t place, Element element, const Eigen::Vector3d& p, double bound2, Run& run) noexcept;
  void examineTriangle(std::uint32_t place, Element element, const Eigen::Vector3d& p, Run& run) noexcept;
  Eigen::Vector3d examineForFoot(std::uint32_t place, Element element, const Eigen::Vector3d& p, Run& run) noexcept;
  void examineBehind(int plane, std::uint32_t place, Element triangle, const Eigen::Vector3d& p, Run& run) noexcept;
  void examinePlanes(std::uint32_t place, const Eigen::Vector3d& p, Run& run) noexcept;
  template <class Note>
  void examineDiscs(std::uint32_t place, const BoxProbe& probe, const Note& note, Run& run) noexcept;
  void compare(std::uint32_t place, Element element, const Eigen::Vector3d& p, double before, double d2,
               Run& run) const noexcept;
  bool isAsNear(Element element, const Eigen::Vector3d& p, double d2) const noexcept;
  static double lowerBoundOf(double d2, const Examination& examination) noexcept;
  double edgeFoot(Element element, const Eigen::Vector3d& p, Hit& hit) const noexcept;
  bool mayHaveFoot(Element element, const Eigen::Vector3d& p, Examination& examination) const noexcept;
  double evaluate(Element element, const Eigen::Vector3d& p, Examination& examination, Hit& hit) const noexcept;
  double evaluateLeaf(Element element, const Eigen::Vector3d& p, Examination& examination, Hit& hit) const noexcept;
  bool mayEnterBeside(const Eigen::Vector3d& p, const Run& run) const noexcept;
  double othersOf(const Run& run) const noexcept;
  void finish(Run& run) const noexcept;

  const Model& model_;
  Nearest last_;
  Eigen::Vector3d last_p_{0, 0, 0};
  NearElements near_elements_;    ///< used if the model is one body of faces, in the frame of the body
  NearTriangles near_triangles_;  ///< used if the model is one mesh, in its frame
  NearPlanes near_planes_;        ///< planes of near_triangles_, for a slow probe
  int last_plane_ = -1;           ///< likely number of the plane of the nearest triangle
  bool gathered_now_ = false;     ///< rows were gathered in this tick
  double way_ = 0;                ///< [m] by which the probe has moved since the last tick
  NearPlaces near_places_;        ///< used if there are several placements, in the frame of the model
  int whole_nodes_ = 0;           ///< nodes that the last search of the whole model examined
  double reach_ = 0;              ///< [m] gathered rows may be farther than the nearest point by this
  int crowded_wait_ = 0;          ///< value at which crowded_ticks_ began
  int crowded_ticks_ = 0;         ///< ticks in which so many rows would be near that a search is quicker
};

}  // namespace hapticd::brep

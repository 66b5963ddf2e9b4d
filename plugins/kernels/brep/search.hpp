// SPDX-License-Identifier: MIT
/// The nearest point of a part: one bounded search a tick, and none where the last one still proves the answer.
#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "kernels/brep/model.hpp"
#include "kernels/brep/near_places.hpp"
#include "kernels/brep/near_rows.hpp"

namespace hapticd::brep {

/// Limits of the work of one search.
struct SearchBudget {
  int nodes = 2048;    ///< boxes of four
  int elements = 256;  ///< feet
};

/// What a search found.
struct Nearest {
  Hit hit;                      ///< in the frame of the body
  std::uint32_t place = kNone;  ///< in placements(); kNone: nothing was found
  /// [m] No other element is nearer to the probe than this. With `proved`, none but this one is nearer than `hit`.
  double others = 0;
  bool proved = false;     ///< hit is the nearest point of all
  bool exhausted = false;  ///< the budget ended first
  int nodes = 0, elements = 0;

  bool found() const noexcept { return place != kNone; }
  double distance() const noexcept;
};

/// Finds nearest points for one probe. Several share the Model.
class Search {
 public:
  /// [main] Allocates everything that searching needs.
  explicit Search(const Model& model);

  /// [rt] Nearest point of all placements to p (model frame).
  const Nearest& nearest(const Eigen::Vector3d& p, const SearchBudget& budget = {}) noexcept;
  /// [rt] Nearest point of one placement, from `start` on. Elements of other faces than `face` (an index in the part;
  /// kNone: all) are ignored; edges belong to all their faces.
  Nearest nearestOf(std::uint32_t place, std::uint32_t face, const Eigen::Vector3d& p, const Hit& start,
                    const SearchBudget& budget = {}) noexcept;
  /// [rt] The nearest point of one element from its last one on; d2 stays infinite if it has none.
  Hit refine(std::uint32_t place, const Hit& last, const Eigen::Vector3d& p) noexcept;
  /// [rt] Placements that bound a volume and whose boxes hold p; at most `cap` of them.
  int around(const Eigen::Vector3d& p, std::uint32_t* places, int cap) const noexcept;
  /// [rt] Forgets the last answer.
  void reset() noexcept { last_.place = kNone; }
  const Nearest& last() const noexcept { return last_; }
  const Model& model() const noexcept { return model_; }

 private:
  /// Of a distance: so little beyond the best one, a box or another foot is not counted as farther.
  static constexpr double kRounding = 1e-12;

  /// One search under way.
  struct Run {
    Nearest best;
    SearchBudget budget;
    Element first;                                            ///< the element that was examined before all others
    std::uint32_t first_place = kNone;                        ///< where it is
    double first_least2 = 0;                                  ///< leastOf() it
    double limit2 = std::numeric_limits<double>::infinity();  ///< [m^2] to a point of the part: none farther is nearest
    double others2 = std::numeric_limits<double>::infinity();  ///< nearest bound of anything except the best
    double open2 = std::numeric_limits<double>::infinity();    ///< nearest bound of what may hide a nearer foot
    bool tied = false;  ///< another element than the best is equally near, and neither was examined first
    int restarts = 0;   ///< leaves on which Newton's method may still start from several places

    /// [m^2] What is farther cannot be the nearest.
    double within2() const noexcept { return std::min(best.hit.d2, limit2); }
  };
  /// One examination of an element.
  struct Look {
    const Hit* start = nullptr;  ///< the last foot; null: none is known
    LeafSight sight;
    Eigen::Array2d uv{0, 0};                                  ///< of a leaf: where to start
    bool elsewhere = true;                                    ///< LeafStart::elsewhere
    double limit2 = std::numeric_limits<double>::infinity();  ///< LeafStart::limit2
    bool alone = true;                                        ///< out: no nearer point is hidden in the element
    int starts = 1;                                           ///< out
    double least2 = -1;                                       ///< out: for a leaf, the result of leastOf()
  };

  void begin(const Eigen::Vector3d& p, Run& run) noexcept;
  bool goesOn(const Eigen::Vector3d& p, const Run& run) noexcept;
  bool searchNear(const Eigen::Vector3d& p, Run& run) noexcept;
  void moveNear(const Eigen::Vector3d& p) noexcept;
  template <class Near>
  bool searchNear(Near& near, const Eigen::Vector3d& p, double way, Run& run) noexcept;
  template <class Near>
  bool gatherNear(Near& near, const Eigen::Vector3d& p, double way, double distance) noexcept;
  template <class Near>
  void lookAtRows(Near& near, std::uint32_t place, const Eigen::Vector3d& p, Run& run) noexcept;
  template <class Near>
  void lookAtAll(Near& near, const Eigen::Vector3d& p, Run& run) noexcept;
  template <class Near>
  bool lookAtNear(Near& near, const Eigen::Vector3d& p, Run& run) noexcept;
  void searchTree(const BodyTree& body, std::int32_t root, std::uint32_t place, const Eigen::Vector3d& p,
                  Run& run) noexcept;
  void searchWhole(const Eigen::Vector3d& p, Run& run) noexcept;
  void searchPlaces(const Eigen::Vector3d& p, Run& run) noexcept;
  template <class Whole>
  static void searchWithin(Run& run, const Whole& whole) noexcept;
  double look(std::uint32_t place, Element element, const Eigen::Vector3d& p, double bound2, Run& run) noexcept;
  bool isAsNear(Element element, const Eigen::Vector3d& p, double d2) const noexcept;
  static double leastOf(double d2, const Look& look) noexcept;
  double edgeFoot(Element element, const Eigen::Vector3d& p, Hit& hit) const noexcept;
  bool mayHold(Element element, const Eigen::Vector3d& p, Look& look) const noexcept;
  double evaluate(Element element, const Eigen::Vector3d& p, Look& look, Hit& hit) const noexcept;
  double leafOf(Element element, const Eigen::Vector3d& p, Look& look, Hit& hit) const noexcept;
  static void finish(Run& run) noexcept;

  const Model& model_;
  Nearest last_;
  Eigen::Vector3d last_p_{0, 0, 0};
  NearElements near_;       ///< of a model that is one body, in its frame
  NearTriangles nearby_;    ///< the same of one mesh
  NearPlaces near_places_;  ///< of several placements, in the frame of the model
  int whole_nodes_ = 0;     ///< of the last search of the whole model
  double reach_ = 0;        ///< [m] by which their rows extend beyond the nearest point
};

}  // namespace hapticd::brep

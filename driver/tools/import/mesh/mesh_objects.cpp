// SPDX-License-Identifier: MIT
#include "mesh_import/mesh_objects.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <unordered_map>

#include "mesh_import/mesh_edges.hpp"

namespace hapticd::importing {
namespace {

/// Finds which objects belong together.
class Together {
 public:
  explicit Together(const MeshFile& mesh) : mesh_(mesh), root_(mesh.objects.size()) {
    std::iota(root_.begin(), root_.end(), 0u);
  }

  void run() {
    const std::vector<MeshEdge> edges = meshEdges(mesh_.corners);
    for (std::size_t i = 0, end = 0; i < edges.size(); i = end) {
      end = endOfEdge(edges, i);
      joinAt(edges, i, end);
    }
  }

  std::uint32_t rootOf(std::uint32_t object) const {
    while (root_[object] != object) object = root_[object];
    return object;
  }

 private:
  /// Joins the objects that have a border at an edge: each has only one triangle there.
  void joinAt(const std::vector<MeshEdge>& edges, std::size_t begin, std::size_t end) {
    if (end - begin < 2) return;
    counts_.clear();
    for (std::size_t k = begin; k < end; ++k) ++counts_[mesh_.object[edges[k].code / 4]];
    std::uint32_t first = kNobody;
    for (const auto& [object, count] : counts_) {
      if (count != 1) continue;
      if (first == kNobody) first = object;
      const std::uint32_t a = rootOf(first), b = rootOf(object);
      root_[std::max(a, b)] = std::min(a, b);
    }
  }

  static constexpr std::uint32_t kNobody = 0xffffffffu;
  const MeshFile& mesh_;
  std::vector<std::uint32_t> root_;
  std::map<std::uint32_t, int> counts_;
};

/// Copies triangles with the points that they use.
class Copy {
 public:
  explicit Copy(const MeshFile& from) : from_(from) {}

  void add(std::size_t triangle, MeshFile& to) {
    std::array<std::uint32_t, 3> corners = from_.corners[triangle];
    for (std::uint32_t& corner : corners) {
      const auto [known, is_new] = number_.try_emplace(corner, static_cast<std::uint32_t>(to.points.size()));
      if (is_new) to.points.push_back(from_.points[corner]);
      corner = known->second;
    }
    to.corners.push_back(corners);
    if (!from_.colours.empty()) to.colours.push_back(from_.colours[triangle]);
  }

 private:
  const MeshFile& from_;
  std::unordered_map<std::uint32_t, std::uint32_t> number_;
};

/// Notes which objects became one.
void tell(const MeshFile& mesh, const Together& together, std::vector<std::string>& remarks) {
  constexpr std::size_t kMost = 5;
  std::size_t joined = 0;
  for (std::uint32_t object = 0; object < mesh.objects.size(); ++object) {
    const std::uint32_t root = together.rootOf(object);
    if (root == object || ++joined > kMost) continue;
    remarks.push_back("the object '" + mesh.objects[object] + "' is one body with '" + mesh.objects[root] +
                      "', because their borders share edges");
  }
  if (joined > kMost) remarks.push_back("and so are " + std::to_string(joined - kMost) + " more objects");
}

}  // namespace

std::vector<MeshObject> objectsOf(const MeshFile& mesh, std::vector<std::string>& remarks) {
  if (mesh.objects.size() < 2) return {{"", mesh}};
  Together together(mesh);
  together.run();
  tell(mesh, together, remarks);
  std::map<std::uint32_t, std::vector<std::size_t>> triangles;  // by object
  for (std::size_t t = 0; t < mesh.corners.size(); ++t) triangles[together.rootOf(mesh.object[t])].push_back(t);
  std::vector<MeshObject> objects;
  for (const auto& [object, own] : triangles) {
    objects.push_back({mesh.objects[object], {}});
    Copy copy(mesh);
    for (const std::size_t t : own) copy.add(t, objects.back().mesh);
  }
  return objects;
}

}  // namespace hapticd::importing

// SPDX-License-Identifier: MIT
#include "mesh_import/mesh_duplicates.hpp"

#include <algorithm>

#include "kernels/brep/model/groups.hpp"

namespace hapticd::importing {
namespace {

using Corners = std::array<std::uint32_t, 3>;
constexpr std::uint32_t kNoPair = 0xffffffffu;

/// A triangle by its corners, the smallest first, the others in the order in which it turns.
Corners turned(const Corners& c) {
  const auto least = static_cast<std::size_t>(std::min_element(c.begin(), c.end()) - c.begin());
  return {c[least], c[(least + 1) % 3], c[(least + 2) % 3]};
}

/// What lies on each other. Of each kind the first triangle of the file is kept.
struct Doubles {
  std::vector<char> drop;            ///< 1 for a triangle that another one of its kind and direction stands for
  std::vector<std::uint32_t> pair;   ///< number of the pair of each triangle that lies back to back on another
  std::vector<std::uint32_t> backs;  ///< the second triangle of each pair
};

Doubles findDoubles(const std::vector<Corners>& corners) {
  struct Entry {
    Corners sorted, turned;
    std::uint32_t triangle;
  };
  std::vector<Entry> entries;
  entries.reserve(corners.size());
  for (std::uint32_t t = 0; t < corners.size(); ++t) {
    Entry entry{corners[t], turned(corners[t]), t};
    std::sort(entry.sorted.begin(), entry.sorted.end());
    entries.push_back(entry);
  }
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
    return a.sorted != b.sorted ? a.sorted < b.sorted : a.triangle < b.triangle;
  });
  Doubles found{std::vector<char>(corners.size(), 0), std::vector<std::uint32_t>(corners.size(), kNoPair), {}};
  for (std::size_t i = 0, first = 0; i < entries.size(); ++i) {
    if (entries[i].sorted != entries[first].sorted) first = i;
    if (i == first) continue;
    const std::uint32_t front = entries[first].triangle, back = entries[i].triangle;
    found.drop[back] = 1;
    if (entries[i].turned == entries[first].turned || found.pair[front] != kNoPair) continue;
    found.drop[back] = 0;
    found.pair[front] = found.pair[back] = static_cast<std::uint32_t>(found.backs.size());
    found.backs.push_back(back);
  }
  return found;
}

/// The edges of a sheet.
struct Borders {
  std::size_t outer = 0;        ///< with triangles of one pair alone
  std::size_t attached = 0;     ///< with other triangles as well
  std::size_t odd_with = 0;     ///< with more or fewer than two triangles, if one side of the sheet is kept
  std::size_t odd_without = 0;  ///< the same, if both sides are left out
};

void count(Borders& borders, std::size_t triangles, std::size_t pairs) {
  const std::size_t others = triangles - 2 * pairs;
  borders.outer += others == 0 && pairs == 1 ? 1 : 0;
  borders.attached += others > 0 ? 1 : 0;
  borders.odd_with += others + pairs != 2 ? 1 : 0;
  borders.odd_without += others != 2 && others != 0 ? 1 : 0;
}

/// Calls see(pairs, triangles) for each edge with a pair: the numbers of its pairs, and how many triangles it has.
template <class See>
void eachEdge(const std::vector<MeshEdge>& edges, const Doubles& doubles, const See& see) {
  std::vector<std::uint32_t> pairs;
  for (std::size_t i = 0, end = 0; i < edges.size(); i = end) {
    end = endOfEdge(edges, i);
    pairs.clear();
    std::size_t triangles = 0;
    for (std::size_t k = i; k < end; ++k) {
      const std::uint32_t t = edges[k].code / 4;
      triangles += doubles.drop[t] == 0 ? 1 : 0;
      if (doubles.pair[t] != kNoPair) pairs.push_back(doubles.pair[t]);
    }
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    if (!pairs.empty()) see(pairs, triangles);
  }
}

/// Returns for each pair whether both of its triangles are left out.
std::vector<char> emptyPairs(const std::vector<Corners>& corners, const Doubles& doubles, Flange flange) {
  const std::vector<MeshEdge> edges = meshEdges(corners);
  brep::Groups sheets(doubles.backs.size());
  eachEdge(edges, doubles, [&](const std::vector<std::uint32_t>& pairs, std::size_t) {
    for (const std::uint32_t pair : pairs) sheets.join(pair, pairs.front());
  });
  std::vector<Borders> borders(doubles.backs.size());
  eachEdge(edges, doubles, [&](const std::vector<std::uint32_t>& pairs, std::size_t triangles) {
    count(borders[sheets.rootOf(pairs.front())], triangles, pairs.size());
  });
  std::vector<char> empty(doubles.backs.size(), 0);
  for (std::uint32_t pair = 0; pair < empty.size(); ++pair) {
    const Borders& b = borders[sheets.rootOf(pair)];
    const bool stays = b.attached == 0 || (b.outer > 0 && flange == Flange::kKeepOneSide);
    empty[pair] = static_cast<char>(!stays && b.odd_without < b.odd_with);
  }
  return empty;
}

}  // namespace

LeftOut leaveOutDuplicates(MeshTriangles& triangles, Flange flange) {
  const std::vector<Corners>& corners = triangles.corners;
  Doubles doubles = findDoubles(corners);
  LeftOut left;
  const std::vector<char> empty = doubles.backs.empty() ? std::vector<char>{} : emptyPairs(corners, doubles, flange);
  for (std::uint32_t t = 0; t < corners.size(); ++t) {
    const std::uint32_t pair = doubles.pair[t];
    const bool both = pair != kNoPair && empty[pair] != 0;
    if (both || (pair != kNoPair && doubles.backs[pair] == t)) doubles.drop[t] = 1;
    left.back_to_back += both ? 1 : 0;
    left.duplicates += !both && doubles.drop[t] != 0 ? 1 : 0;
  }
  triangles.eraseIf([&](std::size_t t) { return doubles.drop[t] != 0; });
  return left;
}

}  // namespace hapticd::importing

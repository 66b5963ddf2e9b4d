// SPDX-License-Identifier: MIT

#include "base/counted.hpp"
#include "base/short_number.hpp"
#include "mesh_import/mesh_part.hpp"

namespace hapticd::importing {
namespace {

using Eigen::Vector3d;

/// Returns a point as text, such as "(10, 0, 20) mm".
std::string where(const Vector3d& p) {
  std::string text;
  for (const double metres : p) text += (text.empty() ? "(" : ", ") + withDigits(1e3 * metres, 4);
  return text + ") mm";
}

/// Reports that shells, or bodies, pass through each other.
void tellCrossings(const Crossings& found, std::size_t count, const char* one, const char* many,
                   std::vector<std::string>& lines) {
  if (found.pairs > 0)
    lines.push_back(
        counted(count, one, many) +
        " pass through each other: " + counted(found.pairs, "pair of triangles crosses", "pairs of triangles cross") +
        ", the first at " + where(found.first) +
        "; the faces inside are felt as well: unite the bodies in the program that wrote the file (boolean union)");
  if (!found.all_tried)
    lines.push_back(std::string("not all pairs of triangles were tried, so its ") + many +
                    " may pass through each other");
}

}  // namespace

void MeshReport::add(const MeshReport& body) {
  triangles += body.triangles, points += body.points, joined += body.joined, slivers += body.slivers;
  solids_inside += body.solids_inside, degenerate += body.degenerate, duplicates += body.duplicates;
  back_to_back += body.back_to_back;
  flipped += body.flipped, touching += body.touching, non_manifold += body.non_manifold;
  unorientable += body.unorientable, free_edges += body.free_edges, holes += body.holes, shells += body.shells;
  closed = closed && body.closed;
  volume += body.volume;
  if (crossings.pairs == 0) crossings.first = body.crossings.first;
  crossings.pairs += body.crossings.pairs;
  crossings.all_tried = crossings.all_tried && body.crossings.all_tried;
  remarks.insert(remarks.end(), body.remarks.begin(), body.remarks.end());
}

std::vector<std::string> linesOf(const MeshReport& r) {
  std::vector<std::string> lines = r.remarks;
  const auto say = [&](std::size_t count, const char* one, const char* many) {
    if (count > 0) lines.push_back(counted(count, one, many));
  };
  say(r.joined, "point was joined with one that differs by rounding only",
      "points were joined with others that differ by rounding only");
  say(r.slivers, "triangle without width was taken into its neighbour",
      "triangles without width were taken into their neighbours");
  say(r.degenerate, "triangle of zero area was left out", "triangles of zero area were left out");
  say(r.duplicates, "duplicate triangle was left out", "duplicate triangles were left out");
  say(r.back_to_back / 2, "pair of triangles that lay back to back was left out",
      "pairs of triangles that lay back to back were left out");
  say(r.flipped, "triangle was reversed", "triangles were reversed");
  say(r.touching, "edge has more than two triangles, those of solids that touch there",
      "edges have more than two triangles, those of solids that touch there");
  say(r.non_manifold, "edge has more than two triangles", "edges have more than two triangles");
  say(r.unorientable, "edge has triangles with contradictory outward sides",
      "edges have triangles with contradictory outward sides");
  tellCrossings(r.crossings, r.shells, "shell", "shells", lines);
  tellCrossings(r.overlaps, r.bodies.size(), "body", "bodies", lines);
  say(r.solids_inside, "shell lies inside another one and faces outward as well: a body in a body, no cavity",
      "shells lie inside others and face outward as well: bodies in a body, no cavities");
  if (r.holes > 0)
    lines.push_back(counted(r.holes, "hole", "holes") + " with " + counted(r.free_edges, "free edge", "free edges") +
                    (r.borders.empty() ? "" : ", " + brep::placesOf(r.borders)));
  return lines;
}

}  // namespace hapticd::importing

// SPDX-License-Identifier: MIT
/// The sections of a part file: the name of each, and the array of Part that it holds.
#pragma once
#include "kernels/part/part.hpp"

namespace hapticd::brep {

inline constexpr std::size_t kSectionAlignment = 64;  ///< [bytes]

/// Calls `visit(name, array)` for each section, in the order of the file.
template <class PartType, class Visitor>
void forEachSection(PartType& part, Visitor&& visit) {
  visit("surface", part.surfaces);
  visit("curve3", part.curves3);
  visit("curve2", part.curves2);
  visit("real", part.reals);
  visit("vertex", part.vertices);
  visit("edge", part.edges);
  visit("coedge", part.coedges);
  visit("loop", part.loops);
  visit("face", part.faces);
  visit("body", part.bodies);
  visit("instance", part.instances);
  visit("point", part.points);
  visit("triangle", part.triangles);
  visit("colour", part.colours);
  visit("ball", part.balls);
}

constexpr std::size_t alignedSection(std::size_t offset) {
  return (offset + kSectionAlignment - 1) / kSectionAlignment * kSectionAlignment;
}

}  // namespace hapticd::brep

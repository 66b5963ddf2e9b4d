// SPDX-License-Identifier: MIT
/// Sets of things that are joined one after another, such as corners that share a normal.
#pragma once
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace hapticd::brep {

/// Numbers in disjoint sets: a union-find structure with path halving (Tarjan and van Leeuwen 1984).
class Groups {
 public:
  /// @param count how many numbers there are, from 0; each is a set of its own
  explicit Groups(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0u); }

  /// [main] Adds a number, and returns it.
  std::uint32_t add() {
    parent_.push_back(static_cast<std::uint32_t>(parent_.size()));
    return parent_.back();
  }
  /// [main] Returns the number that stands for the set of `i`, until that set is joined with another.
  std::uint32_t rootOf(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  /// [main] Joins two sets. The root of `b` stands for both.
  void join(std::uint32_t a, std::uint32_t b) { parent_[rootOf(a)] = rootOf(b); }

 private:
  std::vector<std::uint32_t> parent_;
};

}  // namespace hapticd::brep

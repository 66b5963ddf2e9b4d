// SPDX-License-Identifier: MIT
#include "document/problem.hpp"

#include <algorithm>
#include <iterator>
#include <list>
#include <map>
#include <tuple>

namespace hapticd::document {

std::string Problem::text() const {
  const std::string where =
      place.file + ":" + std::to_string(std::max(place.line, 1)) + ":" + std::to_string(std::max(place.column, 1));
  return where + ": " + (key.empty() ? "" : key + ": ") + what;
}

void report(Problems& problems, const Place& place, const std::string& key, const std::string& what) {
  Problem problem;
  problem.place = place;
  problem.key = key;
  problem.what = what;
  problems.push_back(problem);
}

void report(Problems& problems, const std::string& file, int line, int column, const std::string& key,
            const std::string& what) {
  Place place;
  place.file = file;
  place.line = line;
  place.column = column;
  report(problems, place, key, what);
}

void sortByPlace(Problems& problems) {
  std::map<std::string, size_t> order;
  for (const Problem& problem : problems) order.emplace(problem.place.file, order.size());
  // std::list::sort needs no buffer, and keeps the order of problems at the same place.
  std::list<Problem> sorted(std::make_move_iterator(problems.begin()), std::make_move_iterator(problems.end()));
  sorted.sort([&](const Problem& a, const Problem& b) {
    return std::tuple(order[a.place.file], a.place.line, a.place.column) <
           std::tuple(order[b.place.file], b.place.line, b.place.column);
  });
  problems.assign(std::make_move_iterator(sorted.begin()), std::make_move_iterator(sorted.end()));
}

}  // namespace hapticd::document

#include "scene/problem.hpp"

#include <algorithm>
#include <map>

namespace hapticd::scene {

std::string Problem::text() const {
  const std::string where =
      place.file + ":" + std::to_string(std::max(place.line, 1)) + ":" + std::to_string(std::max(place.column, 1));
  return where + ": " + (key.empty() ? "" : key + ": ") + what;
}

void sortByPlace(Problems& problems) {
  std::map<std::string, size_t> order;
  for (const Problem& problem : problems) order.emplace(problem.place.file, order.size());
  std::stable_sort(problems.begin(), problems.end(), [&](const Problem& a, const Problem& b) {
    return std::tuple(order[a.place.file], a.place.line, a.place.column) <
           std::tuple(order[b.place.file], b.place.line, b.place.column);
  });
}

}  // namespace hapticd::scene

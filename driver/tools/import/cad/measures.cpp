// SPDX-License-Identifier: MIT
#include "cad_import/measures.hpp"

#include <map>

#include "base/counted.hpp"
#include "kernels/brep/model/model.hpp"
#include "kernels/brep/model/open_borders.hpp"
#include "kernels/brep/search/tight_bounds.hpp"

namespace hapticd::cad {
namespace {

std::string lineOf(const std::string& name, const std::vector<brep::OpenBorder>& borders) {
  std::size_t edges = 0;
  for (const brep::OpenBorder& border : borders) edges += border.edges;
  return "'" + name + "': open, so it is felt from both sides: " + counted(borders.size(), "border of", "borders of") +
         " " + counted(edges, "free edge") + ", " + brep::placesOf(borders);
}

}  // namespace

Measures measured(const brep::Part& part) {
  Measures measures;
  try {
    brep::ModelOptions options;
    options.empty_balls = false;
    const brep::Model model(brep::Part(part), options);
    measures.box = brep::tightBounds(model);
    measures.notes = model.warnings();
  } catch (const std::invalid_argument& error) {
    measures.notes.emplace_back(error.what());
  }
  return measures;
}

std::vector<std::string> openBodies(const brep::Part& part) {
  std::map<std::uint32_t, std::vector<brep::OpenBorder>> by_body;
  for (const brep::OpenBorder& border : brep::openBorders(part))
    if (part.bodies[border.body].kind != brep::BodyKind::kSolid) by_body[border.body].push_back(border);
  std::vector<std::string> lines;
  for (const auto& [body, borders] : by_body) {
    const std::uint32_t name = part.bodies[body].name;
    lines.push_back(lineOf(name == brep::kNone ? "" : part.names[name], borders));
  }
  return lines;
}

}  // namespace hapticd::cad

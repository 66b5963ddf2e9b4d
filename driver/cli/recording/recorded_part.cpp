// SPDX-License-Identifier: MIT
#include "cli/recording/recorded_part.hpp"

#include <span>

#include "base/regular_file.hpp"
#include "kernels/part/file.hpp"
#include "kernels/part/limit.hpp"
#include "kernels/part/names.hpp"

namespace hapticd::cli {

std::optional<brep::Part> partOf(const scene::Model& model) {
  for (const scene::Value& value : model.parameters) {
    if (value.id != "geometry" || !value.text.ends_with(".hpart")) continue;
    const auto bytes = readRegular(value.text, brep::kMostPartBytes);
    if (!bytes) return {};
    try {
      return brep::readPart(std::as_bytes(std::span(*bytes)), value.text);
    } catch (const brep::PartError&) {
      return {};
    }
  }
  return {};
}

std::string featureNameIn(const std::optional<brep::Part>& part, std::uint32_t feature) {
  const std::string name = part ? brep::featureName(*part, feature) : "";
  return name.empty() ? "feature " + std::to_string(feature) : name;
}

}  // namespace hapticd::cli

// SPDX-License-Identifier: MIT
#include "kernels/part/names.hpp"

#include <cstdio>

namespace hapticd::brep {

std::vector<std::string> lossLines(const Part& part) {
  std::vector<std::string> lines;
  std::size_t splines = 0;
  const Loss* worst = nullptr;
  char size[64];
  for (const Loss& loss : part.losses) {
    if (loss.reason == kApproximated) {
      ++splines;
      if (worst == nullptr || loss.size > worst->size) worst = &loss;
      continue;
    }
    std::snprintf(size, sizeof size, " (%.3g m)", loss.size);
    lines.push_back("lost: " + loss.what + ": " + loss.reason + (loss.size > 0 ? size : ""));
  }
  if (splines == 0) return lines;
  std::snprintf(size, sizeof size, " by at most %.3g mm (", 1e3 * worst->size);
  lines.push_back(std::to_string(splines) +
                  (splines == 1 ? " curve or surface became a spline, and differs"
                                : " curves and surfaces became splines, and differ") +
                  size + worst->what + ")");
  return lines;
}

std::string plainText(std::string text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    const auto next = i + 1 < text.size() ? static_cast<unsigned char>(text[i + 1]) : 0;
    if (byte < ' ' || byte == 0x7f) text[i] = ' ';
    if (byte == 0xc2 && next >= 0x80 && next < 0xa0) text[i] = text[i + 1] = ' ';  // U+0080 to U+009F
  }
  return text;
}

std::string instanceName(const Part& part, std::uint32_t index) {
  const Instance& instance = part.instances[index];
  if (instance.name != kNone && !part.names[instance.name].empty()) return part.names[instance.name];
  if (instance.body != kNone && part.bodies[instance.body].name != kNone)
    return part.names[part.bodies[instance.body].name];
  return "#" + std::to_string(index);
}

std::string instancePath(const Part& part, std::uint32_t instance) {
  std::string path = instanceName(part, instance);
  for (std::uint32_t i = part.instances[instance].parent; i != kNone; i = part.instances[i].parent)
    path = instanceName(part, i) + "/" + path;
  return path;
}

std::string featureName(const Part& part, std::uint32_t feature) {
  std::uint64_t first = 0;
  for (std::uint32_t i = 0; i < part.instances.size(); ++i) {
    if (part.instances[i].body == kNone) continue;
    const Body& body = part.bodies[part.instances[i].body];
    const std::uint64_t count = std::uint64_t{body.face_count} + body.triangle_count;
    if (feature >= first + count) {
      first += count;
      continue;
    }
    const auto at = static_cast<std::uint32_t>(feature - first);
    const std::string path = instancePath(part, i);
    if (at >= body.face_count) return path + ": triangle " + std::to_string(at - body.face_count);
    const std::uint32_t name = part.faces[body.first_face + at].name;
    return path + ": face " + std::to_string(at) + (name == kNone ? "" : " '" + part.names[name] + "'");
  }
  return "";
}

std::string faceName(const Part& part, std::uint32_t face) {
  const std::uint32_t owner = part.faces[face].body;
  std::uint64_t first = 0;
  for (const Instance& instance : part.instances) {
    if (instance.body == kNone) continue;
    const Body& body = part.bodies[instance.body];
    if (instance.body == owner) return featureName(part, static_cast<std::uint32_t>(first + face - body.first_face));
    first += std::uint64_t{body.face_count} + body.triangle_count;
  }
  return "face " + std::to_string(face);
}

}  // namespace hapticd::brep

// SPDX-License-Identifier: MIT
#include "import/active_model.hpp"

#include <fmt/format.h>

#include "scene/load.hpp"

namespace hapticd::importing {

namespace fs = std::filesystem;

Result<std::unique_ptr<host::ShapeInstance>> activated(const char* plugin, const fs::path& geometry,
                                                       host::Catalog& catalog, const std::string& more, uint32_t probes,
                                                       std::string* warnings) {
  std::string quoted;
  for (const char c : fs::absolute(geometry).string()) quoted += c == '\'' ? std::string("''") : std::string(1, c);
  const std::string text =
      fmt::format("hapticd: 1\nmodels:\n  - name: body\n    plugin: {}\n    parameters: {{geometry: '{}'{}}}\n", plugin,
                  quoted, more);
  std::optional<scene::Scene> scene;
  const document::Problems problems = scene::checkText(text, fs::current_path() / "import.yaml", catalog, &scene);
  if (!scene || scene->models.empty())
    return Error{problems.empty() ? std::string("no scene") : problems.front().text()};
  std::string said;
  auto shape = host::ShapeInstance::create(scene->models[0],
                                           [&said, warnings](int level, const std::string&, const std::string& what) {
                                             if (level < HSP_LOG_WARNING) return;
                                             said = what;
                                             if (warnings != nullptr) *warnings += what + "\n";
                                           });
  if (!shape) return Error{shape.error()};
  hsp_activation activation{};
  activation.struct_size = sizeof activation;
  activation.max_probes = probes;
  activation.rate_hz = 1000;
  activation.max_probe_speed = 1;
  activation.pose.orientation[0] = 1;
  if (const auto done = (*shape)->activate(activation); !done) return Error{said.empty() ? done.error() : said};
  return shape;
}

Result<hsp_contact> touched(host::ShapeInstance& body, const Eigen::Vector3d& p) {
  hsp_probe probe{};
  Eigen::Map<Eigen::Vector3d>(probe.position) = p;
  probe.orientation[0] = 1;
  probe.flags = HSP_IN_JUMP;
  hsp_contact contact{};
  hsp_step step{};
  step.struct_size = sizeof step;
  step.count = 1;
  step.in = &probe;
  step.out = &contact;
  step.in_stride = sizeof probe;
  step.out_stride = sizeof contact;
  if (body.step(step) < 0) return Error{"the plugin gives no distance to the body"};
  return contact;
}

Result<Triangles> tessellated(host::ShapeInstance& shape, double share) {
  if (shape.geometry() == nullptr) return Error{"the model has no triangles"};
  hsp_mesh mesh{};
  if (shape.tessellate(share * shape.report().size_m, mesh) < 0) return Error{"the model cannot be cut into triangles"};
  Triangles result;
  for (uint32_t i = 0; i < mesh.vertex_count; ++i)
    result.points.emplace_back(Eigen::Map<const Eigen::Vector3f>(mesh.xyz + 3 * std::size_t{i}).cast<double>());
  for (uint32_t t = 0; t < mesh.triangle_count; ++t)
    result.corners.push_back({mesh.indices[3 * t], mesh.indices[3 * t + 1], mesh.indices[3 * t + 2]});
  return result;
}

}  // namespace hapticd::importing

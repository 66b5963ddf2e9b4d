// SPDX-License-Identifier: MIT
/// Measures medial meshes: the time for one cone, for one slab, and for a whole tick on bodies of many of them.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <random>

#include "bench.hpp"
#include "kernels/medial/mesh_body.hpp"
#include "kernels/medial/mesh_contour.hpp"
#include "scene_world.hpp"

namespace hapticd::bench_mat {
namespace {

using Eigen::Vector3d;
using medial::MedialMesh;
namespace fs = std::filesystem;

/// Returns a closed sheet of 2 n^2 slabs, bent to a torus with the radii 60 mm and 25 mm. The radii of its spheres are
/// 4 to 6 mm.
medial::MeshData torusOf(int n) {
  medial::MeshData mesh;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const double a = 2 * M_PI * i / n, b = 2 * M_PI * j / n, r = .06 + .025 * std::cos(b);
      mesh.vertices.push_back({{r * std::cos(a), r * std::sin(a), .025 * std::sin(b)}, .005 + .001 * std::sin(3 * a)});
    }
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const int k = (i + 1) % n, l = (j + 1) % n;
      mesh.triangles.push_back({i * n + j, k * n + j, k * n + l});
      mesh.triangles.push_back({i * n + j, k * n + l, i * n + l});
    }
  return mesh;
}

/// Returns a coiled rope of n cones.
medial::MeshData ropeOf(int n) {
  medial::MeshData mesh;
  for (int i = 0; i <= n; ++i) {
    const double t = 20.0 * i / n;
    mesh.vertices.push_back({{(.02 + .003 * t) * std::cos(t), (.02 + .003 * t) * std::sin(t), .004 * t}, .006});
    if (i > 0) mesh.edges.push_back({i - 1, i});
  }
  return mesh;
}

/// Returns the position of the probe after k ticks of a stroke on the torus, 2 mm deep and at 0.1 m/s.
Vector3d strokeAt(int k) {
  const double a = .0009 * k, b = .0007 * k, r = .06 + (.025 + .003) * std::cos(b);
  return {r * std::cos(a), r * std::sin(a), (.025 + .003) * std::sin(b)};
}

std::string primitives() {
  std::mt19937 engine(1);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<medial::Cone> cones;
  std::vector<medial::Slab> slabs;
  std::vector<Vector3d> points;
  const auto sphere = [&] {
    const double x = unit(engine), y = unit(engine), z = unit(engine);
    return medial::Sphere{{.1 * x, .1 * y, .1 * z}, .005 + .02 * unit(engine)};
  };
  for (int i = 0; i < 1024; ++i) {
    const medial::Sphere a = sphere(), b = sphere(), c = sphere();
    cones.emplace_back(a, b);
    slabs.emplace_back(std::array<medial::Sphere, 3>{a, b, c});
    points.push_back(sphere().center * 2 - Vector3d::Constant(.05));
  }
  double sum = 0;
  const double cone = leastTime(31, 4096, [&](int i) {
    sum += cones[static_cast<std::size_t>(i) % 1024].foot(points[static_cast<std::size_t>(7 * i) % 1024]).distance;
  });
  const double slab = leastTime(31, 4096, [&](int i) {
    sum += slabs[static_cast<std::size_t>(i) % 1024].foot(points[static_cast<std::size_t>(7 * i) % 1024]).distance;
  });
  return fmt::format(
      "## Medial meshes\n\nA signed distance with foot, normal and parameters, at random points round random "
      "primitives: "
      "{:.0f} ns a cone, {:.0f} ns a slab{}.\n\n",
      1e9 * cone, 1e9 * slab, std::isfinite(sum) ? "" : " (not finite)");
}

std::string searchLine(const char* name, const medial::MeshData& data) {
  double build = 0;
  medial::MeshFeet feet;
  const auto begun = std::chrono::steady_clock::now();
  const MedialMesh mesh(data);
  build = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  uint32_t start = MedialMesh::kNoStart;
  double evaluations = 0, cold_evaluations = 0;
  int calls = 0;
  const double warm = leastTime(11, 2000, [&](int i) {
    mesh.nearest(strokeAt(i), start, 0, feet);
    start = feet.feet[0].element;
    evaluations += feet.evaluations;
    ++calls;
  });
  const double cold = leastTime(11, 500, [&](int i) {
    mesh.nearest(strokeAt(37 * i), MedialMesh::kNoStart, 0, feet);
    cold_evaluations += feet.evaluations;
  });
  return fmt::format("| {} | {} | {} | {:.1f} ms | {:.0f} kB | {:.2f} us | {:.1f} | {:.2f} us | {:.1f} |\n", name,
                     data.vertices.size(), mesh.elements().size(), 1e3 * build, double(mesh.bytes()) / 1024, 1e6 * warm,
                     evaluations / calls, 1e6 * cold, cold_evaluations / 5500);
}

void writeMa(const medial::MeshData& data, const fs::path& file) {
  std::ofstream out(file);
  out << fmt::format("{} {} {}\n", data.vertices.size(), data.edges.size(), data.triangles.size());
  for (const medial::Sphere& s : data.vertices)
    out << fmt::format("v {:.17g} {:.17g} {:.17g} {:.17g}\n", s.center.x(), s.center.y(), s.center.z(), s.radius);
  for (const auto& f : data.triangles) out << fmt::format("f {} {} {}\n", f[0], f[1], f[2]);
}

std::string tickLine(int n, const char* setting, const fs::path& folder) {
  const medial::MeshData data = torusOf(n);
  writeMa(data, folder / "torus.ma");
  double load = 0;
  const auto world =
      buildWorld(fmt::format("hapticd: 1\nservo: {{rate: 1000}}\nmodels:\n  - name: body\n    plugin: mat_deformable\n"
                             "    parameters: {{geometry: torus.ma{}}}\n",
                             setting),
                 folder, load);
  Hand hand(*world);
  Ticks ticks = hand.ticks(3000, strokeAt);
  return fmt::format("| {}{} | {:.0f} ms | {:.0f} kB | {:.1f} us | {:.1f} us | {:.1f} us |\n", data.triangles.size(),
                     setting, 1e3 * load, double(world->lockedBytes()) / 1024, ticks.at(.5), ticks.at(.99),
                     ticks.at(1));
}

/// Returns a body of two fingers and a stem, like that of the scene soft-branch.
medial::MeshBodyData branches() {
  medial::MeshBodyData data;
  data.mesh.vertices.push_back({{0, 0, 0}, .01});
  for (const double angle : {0.5, 2.6, -1.57}) {
    const Vector3d along(std::cos(angle), std::sin(angle), 0);
    for (int i = 1; i <= 8; ++i) {
      const int here = static_cast<int>(data.mesh.vertices.size());
      data.mesh.vertices.push_back({.005 * i * along, .01 - .0005 * i});
      data.mesh.edges.push_back({i == 1 ? 0 : here - 1, here});
    }
  }
  data.stiffness = {400};
  data.damping = {.5};
  data.mass = {.01};
  return data;
}

/// Measures the cost and the effect of the knob `crease` where branches meet. Without it the direction of the force
/// jumps there.
std::string creaseTable() {
  const medial::MeshBody body(branches(), {});
  std::string text =
      "In the crotch of a branch, 2 mm deep, crossed in steps of 0.01 mm. *Turn*: the greatest turn of the normal in a "
      "step; *off*: its greatest angle from that of the nearest part alone, which is the price.\n\n"
      "| crease | time of a foot | primitives looked at | turn | off |\n|---|---|---|---|---|\n";
  const auto at = [](int k) { return Vector3d(-.01 + 1e-5 * k, .009, .001); };
  for (const double crease : {0.0, 2e-4, 5e-4, 1e-3, 2e-3, 5e-3}) {
    medial::SkeletonFoot foot = body.foot(at(0), MedialMesh::kNoStart, crease), before = foot;
    double turn = 0, off = 0, looked = 0;
    for (int k = 0; k <= 2000; ++k) {
      foot = body.foot(at(k), before.element, crease);
      const Vector3d alone = body.foot(at(k), before.element, 0).normal;
      turn = std::max(turn, std::acos(std::min(1.0, foot.normal.dot(before.normal))));
      off = std::max(off, std::acos(std::min(1.0, foot.normal.dot(alone))));
      looked += foot.evaluations / 2001.0;
      before = foot;
    }
    const double time = leastTime(11, 2000, [&](int i) { foot = body.foot(at(i % 2001), foot.element, crease); });
    text += fmt::format("| {:g} m | {:.0f} ns | {:.1f} | {:.2f} degrees | {:.1f} degrees |\n", crease, 1e9 * time,
                        looked, 180 / M_PI * turn, 180 / M_PI * off);
  }
  return text + "\n";
}

/// What a contact does to the vertices while it slides over the body.
struct Slide {
  double jump = 0, peak = 0;  ///< [m] greatest motion of a vertex in a step, greatest displacement
  std::size_t moved = 0;      ///< most vertices that moved at once
};

/// @param slide presses the body at step k
Slide watched(const medial::MeshBody& body, std::size_t vertices, const std::function<void(int)>& slide) {
  Slide seen;
  std::vector<Eigen::Vector4d> before(vertices), now(vertices);
  for (int k = 0; k < 2000; ++k) {
    slide(k);
    seen.moved = std::max(seen.moved, body.deformation().awake());
    for (std::size_t i = 0; i < now.size(); ++i) {
      now[i] = body.deformation().displacement(i);
      if (k > 0) seen.jump = std::max(seen.jump, (now[i] - before[i]).norm());
      seen.peak = std::max(seen.peak, now[i].norm());
    }
    std::swap(before, now);
  }
  return seen;
}

/// Measures, for each number of rings, how many vertices a contact moves, and how far they jump while the contact
/// slides from slab to slab.
std::string ringsTable() {
  medial::MeshBodyData data;
  data.mesh = torusOf(22);
  data.stiffness = {400};
  data.damping = {.5};
  data.mass = {.01};
  std::string text =
      "A press of 2 mm that slides over the torus of 968 slabs in steps of 0.1 mm. *Jump*: the greatest motion of a "
      "vertex in a step; *peak*: its greatest displacement, both over the depth. More rings make the dent wider and "
      "flatter; "
      "its motion is smooth with any number.\n\n"
      "| rings | vertices moved | time of a press | jump | peak |\n|---|---|---|---|---|\n";
  for (const int rings : {0, 1, 2, 3, 5, 8}) {
    medial::BodyOptions options;
    options.deformation.rings = rings;
    options.deformation.dynamics = false;
    medial::MeshBody body(data, options);
    uint32_t start = MedialMesh::kNoStart;
    const auto slide = [&](int i) {
      const medial::SkeletonFoot foot = body.foot(strokeAt(i), start, 0);
      start = foot.element;
      const medial::Press press{foot.u, foot.v, foot.normal, .002, 0, foot.element};
      body.deformation().press({&press, 1});
    };
    const Slide seen = watched(body, data.mesh.vertices.size(), slide);
    const double time = leastTime(11, 1000, slide);
    text += fmt::format("| {} | {} | {:.0f} ns | {:.3f} | {:.2f} |\n", rings, seen.moved, 1e9 * time, seen.jump / .002,
                        seen.peak / .002);
  }
  return text + "\n";
}

}  // namespace

std::string meshTables() {
  std::string text =
      primitives() +
      "| body | vertices | cones, slabs | tree | memory | warm search | looked at | cold search | looked at "
      "|\n|---|---|---|---|---|---|---|---|---|\n";
  text += searchLine("rope", ropeOf(100));
  text += searchLine("rope", ropeOf(10000));
  for (const int n : {7, 22, 71}) text += searchLine("torus", torusOf(n));
  text +=
      "\nA whole servo tick of 1 ms with contact, deformation and search by the simulation side every 5 ms, while the "
      "probe strokes the torus 2 mm deep at 0.1 m/s:\n\n"
      "| slabs, setting | load and check | memory | median | 99 % | longest |\n|---|---|---|---|---|---|\n";
  const fs::path folder = fs::temp_directory_path() / fmt::format("hapticd-bench-mesh-{}", ::getpid());
  fs::create_directories(folder);
  for (const int n : {7, 22, 71}) text += tickLine(n, "", folder);
  for (const char* setting : {", crease: 0", ", rings: 0", ", rings: 5", ", dynamics: off", ", volume: on"})
    text += tickLine(71, setting, folder);
  fs::remove_all(folder);
  return text + "\n" + creaseTable() + ringsTable();
}

}  // namespace hapticd::bench_mat

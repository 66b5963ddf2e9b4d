// SPDX-License-Identifier: MIT
/// Measures accuracy against speed, with one table per knob.
#include <fmt/format.h>

#include "bench.hpp"
#include "bodies.hpp"
#include "kernels/medial/body.hpp"
#include "kernels/medial/contour.hpp"

namespace hapticd::bench_mat {
namespace {

using Eigen::Vector3d;
using medial::Envelope;
using medial::Skeleton;
using medial::SkeletonFoot;

/// A stroke over a domed body with varying radii, 4 mm deep, with the true foot at each point.
struct Stroke {
  Skeleton skeleton;
  std::vector<Vector3d> path;
  std::vector<SkeletonFoot> truth;

  explicit Stroke(spline::Form form = spline::Form::kTable, int ticks = 2000)
      : skeleton(medial::test::build(medial::test::sheets()[4], true, form)) {
    for (int k = 0; k < ticks; ++k) {
      const double s = .5 + .3 * std::sin(4e-3 * k), t = .5 + .3 * std::cos(3.1e-3 * k);
      spline::SurfacePoint at;
      skeleton.surface().evaluate1(s, t, at);
      path.push_back(at.S + .006 * at.Su.cross(at.Sv).normalized());
      medial::NewtonOptions best;
      best.tolerance = 1e-13;
      truth.push_back(skeleton.search(path.back(), best));
    }
  }
};

struct Errors {
  double depth = 0, foot = 0, normal = 0;  ///< m, m, degrees
  double evaluations = 0, ns = 0;

  std::string text() const {
    return fmt::format("{:.1f} | {:.0f} ns | {:.1e} m | {:.1e} m | {:.1e} |\n", evaluations, ns, depth, foot, normal);
  }
};

constexpr const char* kErrorHead = "evaluations | time | worst depth error | worst foot error | normal [degrees] |\n";

template <class Find>
Errors judge(const Stroke& stroke, Find&& find) {
  Errors errors;
  SkeletonFoot foot = stroke.truth[0];
  for (std::size_t k = 0; k < stroke.path.size(); ++k) {
    foot = find(stroke.path[k], foot);
    const SkeletonFoot& truth = stroke.truth[k];
    errors.depth = std::max(errors.depth, std::fabs(foot.depth - truth.depth));
    errors.foot = std::max(errors.foot, (foot.center - truth.center).norm());
    errors.normal = std::max(errors.normal, 180 / M_PI * foot.normal.cross(truth.normal).norm());
    errors.evaluations += double(foot.evaluations) / double(stroke.path.size());
  }
  foot = stroke.truth[0];
  errors.ns = 1e9 * leastTime(11, 300, [&](int i) {
                foot = find(stroke.path[static_cast<std::size_t>(i) % stroke.path.size()], foot);
              });
  return errors;
}

std::string searchKnobs() {
  const Stroke stroke;
  std::string text = fmt::format(
      "## Knobs\n\nA stroke over a domed body whose radii vary, 0.1 m/s at 1 kHz, 4 mm deep.\n\n"
      "| search, tolerance, depth | {}|---|---|---|---|---|---|\n",
      kErrorHead);
  for (const double tolerance : {1e-3, 1e-4, 1e-5, 1e-6, 1e-8, 1e-10, 1e-12}) {
    medial::NewtonOptions options;
    options.tolerance = tolerance;
    const Errors e = judge(stroke, [&](const Vector3d& p, const SkeletonFoot& last) {
      return stroke.skeleton.nearest(p, last.u, last.v, options);
    });
    text += fmt::format("| newton, {:.0e} m | ", tolerance) + e.text();
  }
  for (const int depth : {4, 6, 8, 10, 12, 16, 20}) {
    const Errors e = judge(stroke, [&](const Vector3d& p, const SkeletonFoot&) {
      return stroke.skeleton.bisect(p, Envelope::kExact, depth);
    });
    text += fmt::format("| binary, {} halvings | ", depth) + e.text();
  }
  medial::NewtonOptions options;
  options.envelope = Envelope::kFoot;
  const auto newton = [&](const Vector3d& p, const SkeletonFoot& last) {
    return stroke.skeleton.nearest(p, last.u, last.v, options);
  };
  text += "| envelope: foot | " + judge(stroke, newton).text();
  const Stroke small(spline::Form::kNet);
  text += "| evaluation: small | " + judge(small, [&](const Vector3d& p, const SkeletonFoot& last) {
                                       return small.skeleton.nearest(p, last.u, last.v, {});
                                     }).text();
  return text + fmt::format("\nMemory of this skeleton: {:.1f} kB fast, {:.1f} kB small.\n\n",
                            double(stroke.skeleton.bytes()) / 1024, double(small.skeleton.bytes()) / 1024);
}

constexpr double kFineChord = 2e-5;  ///< [m] chord error of the contour with which others are compared
constexpr double kPressed = .004;    ///< [m]

std::vector<float> shown(const medial::MovingMesh& contour, const medial::Nodes& body) {
  std::vector<float> xyz(3 * contour.vertexCount());
  contour.write([&body](std::size_t i) -> Eigen::Vector4f { return body.displacement(i).cast<float>(); }, xyz.data(),
                contour.vertexCount(), static_cast<float>(body.bulge()));
  return xyz;
}

Vector3d placeIn(const std::vector<float>& xyz, std::size_t i) {
  return Eigen::Map<const Eigen::Vector3f>(xyz.data() + 3 * i).cast<double>();
}

/// Returns the greatest distance [m] between corresponding vertices of two states of one mesh.
double farthest(const std::vector<float>& a, const std::vector<float>& b) {
  double most = 0;
  for (std::size_t i = 0; 3 * i < a.size(); ++i) most = std::max(most, (placeIn(a, i) - placeIn(b, i)).norm());
  return most;
}

/// Returns the greatest jump of a control point while a press slides over the body, divided by the depth of the press.
double greatestJump(medial::Deformation& body) {
  std::vector<Eigen::Vector4d> before, now;
  double jump = 0;
  for (int i = 0; i <= 20000; ++i) {
    const medial::Press slide{i / 20000.0, .37, Vector3d::UnitZ(), .01, 0};
    body.press({&slide, 1});
    now.clear();
    for (std::size_t c = 0; c < body.count(); ++c) now.push_back(body.displacement(c));
    for (std::size_t c = 0; c < before.size(); ++c) jump = std::max(jump, (now[c] - before[c]).norm());
    std::swap(before, now);
  }
  return jump / .01;
}

std::string influenceKnob() {
  const Skeleton skeleton = medial::test::build(medial::test::sheets()[4], true);
  const medial::Contour contour(skeleton, 2e-4);
  const medial::Press still{.43, .37, Vector3d::UnitZ(), kPressed, 0};
  medial::Deformation whole(skeleton, {medial::Oscillator{.01, .5, 200}}, {});
  whole.press({&still, 1});
  const std::vector<float> dent = shown(contour, whole);
  std::string text =
      "What a contact moves is seen, not felt. *Off the dent of 4 x 4*: the greatest distance of a vertex drawn, over "
      "the "
      "depth, while the contact holds. *Left*: the greatest distance of a vertex from its place at rest, over the "
      "depth, "
      "10 ms after the contact has gone; without dynamics the dent is gone at once.\n\n"
      "| influence p' x q', dynamics | control points moved | time of a press | greatest jump of a control point, per "
      "depth | off the dent of 4 x 4 | left |\n|---|---|---|---|---|---|\n";
  for (const bool dynamics : {false, true}) {
    for (int p = 1; p <= 4; ++p) {
      medial::DeformationOptions options;
      options.influence = {p, p};
      options.dynamics = dynamics;
      medial::Deformation body(skeleton, {medial::Oscillator{.01, .5, 200}}, options);
      const double ns = 1e9 * leastTime(11, 500, [&](int i) {
                          const medial::Press slide{.2 + 1e-4 * (i % 6000), .37, Vector3d::UnitZ(), .01, 0};
                          body.advance(1e-3);
                          body.press({&slide, 1});
                        });
      body.reset();
      body.press({&still, 1});
      const double off = farthest(shown(contour, body), dent) / kPressed;
      for (int i = 0; i < 10; ++i) {
        body.advance(1e-3);
        body.press({});
      }
      const double left = farthest(shown(contour, body), contour.atRest()) / kPressed;
      text += fmt::format("| {} x {}, {} | {} | {:.0f} ns | {} | {:.3f} | {:.3f} |\n", p, p, dynamics ? "on" : "off",
                          p * p, ns, dynamics ? "" : fmt::format("{:.3f}", greatestJump(body)), off, left);
    }
  }
  return text + "\n";
}

/// Returns the greatest distance [m] of the triangles of a coarse mesh from a fine mesh. Samples are the middles of the
/// triangles and of two of their sides. The distance is measured from the nearest vertex of the fine mesh, along the
/// normal there.
double displayError(const medial::MovingMesh& coarse, const std::vector<float>& xyz, const medial::MovingMesh& fine,
                    const std::vector<float>& truth) {
  const std::vector<float> normals = fine.normalsOf(truth);
  double most = 0;
  const auto look = [&](const Vector3d& p) {
    std::size_t best = 0;
    double least = HUGE_VAL;
    for (std::size_t i = 0; i < fine.vertexCount(); ++i) {
      const double d2 = (placeIn(truth, i) - p).squaredNorm();
      if (d2 < least) least = d2, best = i;
    }
    most = std::max(most, std::fabs(placeIn(normals, best).dot(p - placeIn(truth, best))));
  };
  const std::size_t triangles = coarse.indices().size() / 3, stride = 1 + triangles / 1500;
  for (std::size_t t = 0; t < triangles; t += stride) {
    const Vector3d a = placeIn(xyz, coarse.indices()[3 * t]), b = placeIn(xyz, coarse.indices()[3 * t + 1]),
                   c = placeIn(xyz, coarse.indices()[3 * t + 2]);
    for (const Vector3d& p : {Vector3d((a + b + c) / 3), Vector3d((a + b) / 2), Vector3d((b + c) / 2)}) look(p);
  }
  return most;
}

std::string displayKnob() {
  const Skeleton skeleton = medial::test::build(medial::test::sheets()[4], true);
  medial::Deformation body(skeleton, {medial::Oscillator{.01, .5, 200}}, {});
  const medial::Press still{.43, .37, Vector3d::UnitZ(), kPressed, 0};
  body.press({&still, 1});
  const medial::Contour fine(skeleton, kFineChord);
  const std::vector<float> truth = shown(fine, body);
  std::string text =
      "*Display error*: the greatest distance of the triangles of a body that is pressed 4 mm deep from those of a "
      "contour of 2e-5 m.\n\n"
      "| tessellation: chord error | vertices | triangles | building | vertices of a deformed body | display error |\n"
      "|---|---|---|---|---|---|\n";
  for (const double error : {2e-3, 1e-3, 5e-4, 2e-4, 1e-4}) {
    const double build = medianTime(3, 1, [&](int) { medial::Contour contour(skeleton, error); });
    const medial::Contour contour(skeleton, error);
    std::vector<float> xyz(3 * contour.vertexCount());
    const double write = leastTime(9, 5, [&](int) {
      contour.write([](std::size_t i) { return Eigen::Vector4f(0, 0, 1e-3F * float(i % 7), 0); }, xyz.data(),
                    contour.vertexCount());
    });
    const double off = displayError(contour, shown(contour, body), fine, truth);
    text += fmt::format("| {:.0e} m | {} | {} | {:.2f} ms | {:.0f} us | {:.1e} m |\n", error, contour.vertexCount(),
                        contour.indices().size() / 3, 1e3 * build, 1e6 * write, off);
  }
  return text + "\n";
}

std::string forceKnob() {
  medial::BodyData data;
  data.grid.count = {7, 7};
  for (int i = 0; i < 49; ++i) {
    const double s = (i / 7) / 6.0, t = (i % 7) / 6.0;
    data.grid.points.emplace_back(.1 * s, .1 * t, .04 * (s * (1 - s) + t * (1 - t)));
    data.grid.radius.push_back(.01 + .004 * std::sin(3 * s + 2 * t));
    data.stiffness.push_back(200 + 100 * s);
  }
  std::string text =
      "| shear_offset | time of the force | force over the normal spring's, 4 mm deep | least slope of the force, "
      "share "
      "of the normal spring's |\n|---|---|---|---|\n";
  for (const double offset : {0.0, 0.02, 0.05, 0.1, 0.2, 0.5}) {
    medial::BodyOptions options;
    options.shear_offset = offset;
    const medial::Body body(data, options);
    spline::SurfacePoint at;
    body.skeleton().surface().evaluate1(.4, .6, at);
    const Vector3d p = at.S + .0081 * at.Su.cross(at.Sv).normalized();
    const SkeletonFoot foot = body.skeleton().search(p, {});
    medial::BodyForce answer;
    const double ns = 1e9 * leastTime(11, 500, [&](int) { answer = body.press(p, foot, foot.normal, foot.depth, 0); });
    text += fmt::format("| {} | {:.0f} ns | {:.2f} | {:.2f} |\n", offset, ns,
                        answer.normal / (answer.stiffness * foot.depth), body.checkMonotonicity().slope);
  }
  return text + "\n";
}

}  // namespace

std::string knobTables() {
  return searchKnobs() + influenceKnob() + forceKnob() + displayKnob();
}

}  // namespace hapticd::bench_mat

/// Accuracy against speed, a table a knob.
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

/// A stroke over a domed body with varying radii, 4 mm deep.
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
  errors.ns = 1e9 * medianTime(11, 300, [&](int i) {
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

/// The greatest jump of a control point while a press slides over the body, over its depth.
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
  std::string text =
      "| influence p' x q', dynamics | control points moved | time of a press | greatest jump of a control point, per "
      "depth |\n|---|---|---|---|\n";
  for (const bool dynamics : {false, true}) {
    for (int p = 1; p <= 4; ++p) {
      medial::DeformationOptions options;
      options.influence = {p, p};
      options.dynamics = dynamics;
      medial::Deformation body(skeleton, {medial::Oscillator{.01, .5, 200}}, options);
      const double ns = 1e9 * medianTime(11, 500, [&](int i) {
                          const medial::Press slide{.2 + 1e-4 * (i % 6000), .37, Vector3d::UnitZ(), .01, 0};
                          body.advance(1e-3);
                          body.press({&slide, 1});
                        });
      text += fmt::format("| {} x {}, {} | {} | {:.0f} ns | {} |\n", p, p, dynamics ? "on" : "off", p * p, ns,
                          dynamics ? "" : fmt::format("{:.3f}", greatestJump(body)));
    }
  }
  return text + "\n";
}

std::string displayKnob() {
  const Skeleton skeleton = medial::test::build(medial::test::sheets()[4], true);
  std::string text =
      "| tessellation: chord error | vertices | triangles | building | vertices of a deformed body |\n"
      "|---|---|---|---|---|\n";
  for (const double error : {2e-3, 1e-3, 5e-4, 2e-4, 1e-4, 2e-5}) {
    const double build = medianTime(3, 1, [&](int) { medial::Contour contour(skeleton, error); });
    const medial::Contour contour(skeleton, error);
    std::vector<float> xyz(3 * contour.vertexCount());
    const double write = medianTime(5, 5, [&](int) {
      contour.write([](std::size_t i) { return Eigen::Vector4f(0, 0, 1e-3F * float(i % 7), 0); }, xyz.data(),
                    contour.vertexCount());
    });
    text += fmt::format("| {:.0e} m | {} | {} | {:.2f} ms | {:.0f} us |\n", error, contour.vertexCount(),
                        contour.indices().size() / 3, 1e3 * build, 1e6 * write);
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
    const double ns = 1e9 * medianTime(11, 500, [&](int) { answer = body.press(p, foot, foot.normal, foot.depth, 0); });
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

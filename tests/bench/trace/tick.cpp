#include <algorithm>
#include <cmath>
#include <cstdio>

#include "bench.hpp"
#include "kernels/trace/tracer.hpp"

namespace hapticd::bench {
namespace {

constexpr int kTicks = 4000;
constexpr int kRounds = 5;
constexpr double kStep = 0.3e-3;   // [m] a tick: 0.3 m/s at 1 kHz
constexpr double kDepth = 2.5e-3;  // [m] to either side

class OurSolver : public Solver {
 public:
  OurSolver(std::string name, const spline::SurfaceData& data, const trace::TraceOptions& options)
      : name_(std::move(name)), model_({data}), tracer_(model_), options_(options) {}
  std::string name() const override { return name_; }
  void start(double u, double v) override {
    tracer_.reset();
    tracer_.activate(0, u, v);
  }
  Eigen::Vector3d step(const Eigen::Vector3d& probe) override {
    const trace::Foot foot = tracer_.step(probe, options_);
    worst_ = std::max(worst_, foot.evaluations);
    return foot.point;
  }
  int worstEvaluations() const override { return worst_; }
  std::size_t bytes() const override { return model_.patch(0).surface.bytes(); }

 private:
  std::string name_;
  trace::Model model_;
  trace::Tracer tracer_;
  trace::TraceOptions options_;
  int worst_ = 0;
};

struct Result {
  double ns = HUGE_VAL, error_p99 = 0, error_worst = 0;
};

/// One walk along the path; the first walk also measures the errors.
void walk(Solver& solver, const Path& path, bool measure, Result& result) {
  std::vector<Eigen::Vector3d> feet(path.probe.size());
  solver.start(path.uv[0][0], path.uv[0][1]);
  const double ns = nanoseconds(static_cast<int>(path.probe.size()), [&] {
    for (std::size_t i = 0; i < path.probe.size(); ++i) feet[i] = solver.step(path.probe[i]);
  });
  result.ns = std::min(result.ns, ns);
  if (!measure) return;
  std::vector<double> errors;
  for (std::size_t i = 0; i < feet.size(); ++i) {
    const double error = (feet[i] - path.foot[i]).norm();
    errors.push_back(std::isfinite(error) ? error : HUGE_VAL);
  }
  std::sort(errors.begin(), errors.end());
  result.error_p99 = errors[errors.size() * 99 / 100];
  result.error_worst = errors.back();
}

std::vector<std::unique_ptr<Solver>> allSolvers(const spline::SurfaceData& data) {
  auto solvers = ourSolvers(data);
#ifdef HAPTICD_WITH_OCCT
  for (auto& solver : occtSolvers(data)) solvers.push_back(std::move(solver));
#endif
#ifdef HAPTICD_WITH_SISL
  for (auto& solver : sislSolvers(data)) solvers.push_back(std::move(solver));
#endif
  return solvers;
}

/// Cost of a surface when `count` of them are traced at once, all about equally near.
double costOfMany(int count) {
  const spline::SurfaceData data = surfaces()[0];
  std::vector<spline::SurfaceData> models(static_cast<std::size_t>(count), data);
  for (int i = 0; i < count; ++i) {
    for (auto& point : models[static_cast<std::size_t>(i)].points) point.z() += 1e-4 * i;
  }
  const trace::Model model(models);
  trace::Tracer tracer(model);
  const Path path = contactPath(data, kStep, kDepth, kTicks);
  double best = HUGE_VAL;
  for (int round = 0; round < kRounds; ++round) {
    tracer.reset();
    for (int i = 0; i < count; ++i) tracer.activate(i, path.uv[0][0], path.uv[0][1]);
    best = std::min(best, nanoseconds(kTicks * count, [&] {
                      for (const auto& probe : path.probe) keep(tracer.step(probe).depth);
                    }));
  }
  return best;
}

}  // namespace

std::vector<std::unique_ptr<Solver>> ourSolvers(const spline::SurfaceData& data) {
  trace::TraceOptions direct, newton, loose;
  direct.method = trace::Method::kDirect;
  loose.tolerance = 1e-6;
  std::vector<std::unique_ptr<Solver>> solvers;
  solvers.push_back(std::make_unique<OurSolver>("hapticd newton 1 nm", data, newton));
  solvers.push_back(std::make_unique<OurSolver>("hapticd newton 1 um", data, loose));
  for (int iterations : {1, 2, 3}) {
    direct.iterations = iterations;
    solvers.push_back(std::make_unique<OurSolver>("hapticd dpt x" + std::to_string(iterations), data, direct));
  }
  return solvers;
}

void printTicks() {
  std::printf(
      "\nOne tick: closest point, %.1f mm a tick, up to %.1f mm from the surface; best of %d interleaved rounds\n",
      1e3 * kStep, 1e3 * kDepth, kRounds);
  std::printf("  %-28s %9s %8s %13s %13s %6s %9s\n", "", "ns", "ratio", "p99 error mm", "worst mm", "evals", "bytes");
  for (const auto& data : surfaces()) {
    const Path path = contactPath(data, kStep, kDepth, kTicks);
    auto solvers = allSolvers(data);
    std::vector<Result> results(solvers.size());
    for (int round = 0; round < kRounds; ++round) {
      for (std::size_t i = 0; i < solvers.size(); ++i) walk(*solvers[i], path, round == 0, results[i]);
    }
    std::printf("%s\n", data.name.c_str());
    for (std::size_t i = 0; i < solvers.size(); ++i) {
      std::printf("  %-28s %9.1f %8.1f %13.1e %13.1e %6d %9zu\n", solvers[i]->name().c_str(), results[i].ns,
                  results[i].ns / results[0].ns, 1e3 * results[i].error_p99, 1e3 * results[i].error_worst,
                  solvers[i]->worstEvaluations(), solvers[i]->bytes());
    }
  }
  std::printf("\nBicubic sheets traced at once, 0.1 mm apart [ns a surface]\n ");
  for (int count : {1, 2, 4, 8, 16, 32}) std::printf("  %d: %.1f", count, costOfMany(count));
  std::printf("\n");
}

}  // namespace hapticd::bench

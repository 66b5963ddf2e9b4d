// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "bench.hpp"
#include "kernels/trace/tracer.hpp"

namespace hapticd::bench {
namespace {

constexpr int kRounds = 9;

class OurSolver : public Solver {
 public:
  OurSolver(std::string name, const spline::SurfaceData& data, const trace::TraceOptions& options,
            spline::Form form = spline::Form::kTable)
      : name_(std::move(name)), model_({data}, {0, {}, form}), tracer_(model_), options_(options) {}
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

 private:
  std::string name_;
  trace::Model model_;
  trace::Tracer tracer_;
  trace::TraceOptions options_;
  int worst_ = 0;
};

struct Result {
  Stretches free, waiting;
  double error_p99 = 0, error_worst = 0;
};

/// Walks along the path twice. In the second walk each probe depends on the foot before, as in a servo loop. If
/// `measure` is true, the first walk also measures the errors.
void walk(Solver& solver, const Path& path, bool measure, Result& result) {
  std::vector<Eigen::Vector3d> feet(path.probe.size());
  solver.start(path.uv[0][0], path.uv[0][1]);
  result.free.walk([&](std::size_t i) { feet[i] = solver.step(path.probe[i]); });
  solver.start(path.uv[0][0], path.uv[0][1]);
  Eigen::Vector3d foot(0, 0, 0);
  result.waiting.walk([&](std::size_t i) { foot = solver.step(path.probe[i] + 1e-200 * foot); });
  keep(foot[0]);
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

}  // namespace

std::vector<std::unique_ptr<Solver>> ourSolvers(const spline::SurfaceData& data) {
  trace::TraceOptions nearest, newton;
  newton.rule = {};  // the default rule holds contacts
  trace::TraceOptions direct = newton, tight = newton;
  direct.method = trace::Method::kDirect;
  tight.tolerance = 1e-15;
  std::vector<std::unique_ptr<Solver>> solvers;
  solvers.push_back(std::make_unique<OurSolver>("hapticd newton, 1 nm (default)", data, newton));
  solvers.push_back(std::make_unique<OurSolver>("hapticd newton, 1 fm", data, tight));
  solvers.push_back(std::make_unique<OurSolver>("hapticd newton, 1 nm, contact_hysteresis 0", data, nearest));
  solvers.push_back(std::make_unique<OurSolver>("hapticd newton, 1 nm, net form", data, newton, spline::Form::kNet));
  for (int iterations : {1, 2, 3}) {
    direct.iterations = iterations;
    solvers.push_back(std::make_unique<OurSolver>("hapticd dpt x" + std::to_string(iterations), data, direct));
  }
  return solvers;
}

void printTicks() {
  std::printf("\n## One tick: the closest point near the last one\n\n");
  std::printf("%.1f mm a tick, up to %.1f mm from the surface, each true foot known; best of %d interleaved rounds.\n",
              1e3 * kStep, 1e3 * kDepth, kRounds);
  std::printf(
      "**ns**: a tick, the next probe known; **waiting**: the next probe waits for this foot, as in a loop with a\n"
      "hand. **Error**: from the true foot. Ratios: to the first row of the surface, and to\n"
      "the second, which like OCCT goes on until rounding stops it: a few units in the last place.\n");
  for (const auto& data : surfaces()) {
    const Path path = contactPath(data, kStep, kDepth, kTicks);
    auto solvers = allSolvers(data);
    std::vector<Result> results(solvers.size());
    for (int round = 0; round < kRounds; ++round) {
      for (std::size_t i = 0; i < solvers.size(); ++i) walk(*solvers[i], path, round == 0, results[i]);
    }
    std::printf(
        "\n| %s | ns | ratio | to 1 fm | waiting ns | p99 error mm | worst mm | most evaluations "
        "|\n|---|---|---|---|---|---|---|---|\n",
        data.name.c_str());
    for (std::size_t i = 0; i < solvers.size(); ++i) {
      std::printf("| %s | %.1f | %.1f | %.1f | %.1f | %.1e | %.1e | ", solvers[i]->name().c_str(),
                  results[i].free.mean(), results[i].free.mean() / results[0].free.mean(),
                  results[i].free.mean() / results[1].free.mean(), results[i].waiting.mean(),
                  1e3 * results[i].error_p99, 1e3 * results[i].error_worst);
      std::printf(solvers[i]->worstEvaluations() > 0 ? "%d |\n" : "- |\n", solvers[i]->worstEvaluations());
    }
  }
}

}  // namespace hapticd::bench

// SPDX-License-Identifier: MIT
/// velocity: compares the velocity estimators, and checks the claims of the NURBS paper about its own. It prints
/// tables. With --write it writes driver/docs/reports/velocity.md and its picture.
#include <fmt/format.h>

#include <cmath>
#include <complex>
#include <filesystem>
#include <fstream>
#include <random>
#include <stdexcept>

#include "base/regular_file.hpp"
#include "delays.hpp"
#include "record/plot.hpp"
#include "response.hpp"
#include "servo/velocity/estimator.hpp"

namespace {

using hapticd::record::colourOf;
using hapticd::record::Curve;
using hapticd::record::Picture;
namespace velocity = hapticd::velocity;
namespace bench = hapticd::velocity_bench;

struct Kind {
  std::string name;
  double parameter;
  std::string words;
};
const std::vector<Kind> kKinds{{"window", 15, "window n = 15 (paper)"},
                               {"window", 3, "window n = 3"},
                               {"butterworth", 120, "butterworth 120 Hz"},
                               {"foaw", 15, "foaw 15"},
                               {"least_squares", 15, "least_squares 15"},
                               {"kalman", 1e3, "kalman 1e3"},
                               {"kalman", 1e5, "kalman 1e5"}};

double rounded(double x, double step) {
  return step > 0 ? std::round(x / step) * step : x;
}

/// Gain relative to the ideal differentiator, and delay [s], at one frequency. The input is a sine of `amplitude` [m],
/// rounded to steps.
struct Response {
  double gain, delay;
};
Response responseOf(const Kind& kind, double rate, double frequency, double amplitude, double step) {
  auto estimator = velocity::make(kind.name, kind.parameter, rate, step > 0 ? step : 1e-9);
  const double w = 2 * M_PI * frequency;
  std::complex<double> sum = 0;
  const int settle = static_cast<int>(0.3 * rate),
            count = static_cast<int>(std::round(std::max(1.0, std::floor(2 * frequency)) / frequency * rate));
  for (int i = 0; i < settle + count; ++i) {
    const double t = i / rate;
    const Eigen::Vector3d v =
        estimator.update({rounded(amplitude * std::sin(w * t), step), 0, 0}, i == 0 ? 0 : 1 / rate);
    if (i >= settle) sum += v.x() * std::polar(1.0, -w * t) * 2.0 / static_cast<double>(count);
  }
  return {std::abs(sum) / (amplitude * w), -std::arg(sum) / w};
}

/// Position [m] and velocity [m/s] of a hand at one time, in closed form. strokes() has strokes and a tremor.
struct Motion {
  double x, v;
};
Motion strokes(double t) {
  Motion m{0, 0};
  const double part[][2] = {{0.05, 0.4}, {0.01, 1.7}, {0.002, 4.3}, {5e-5, 10}};
  for (const auto& [amplitude, frequency] : part) {
    const double w = 2 * M_PI * frequency;
    m.x += amplitude * std::sin(w * t + frequency), m.v += amplitude * w * std::cos(w * t + frequency);
  }
  return m;
}
/// Returns the motion of a hand that hits a wall at 0.2 m/s every half second. The contact is half a swing at 45 Hz (75
/// g on 6000 N/m), then the hand moves away.
Motion taps(double t) {
  constexpr double kWall = 2 * M_PI * 45, kSpeed = 0.2, kContact = M_PI / kWall;
  const double phase = std::fmod(t, 0.5) - 0.25;
  if (phase < 0) return {kSpeed * phase, kSpeed};
  if (phase < kContact) return {kSpeed / kWall * std::sin(kWall * phase), kSpeed * std::cos(kWall * phase)};
  return {-kSpeed * (phase - kContact), -kSpeed};
}

/// Returns the rms error [m/s] over four runs of two seconds. In each run the counts of the encoder are shifted at
/// random.
template <class Path>
double rmsError(const Kind& kind, double rate, double step, const Path& path, bool jumps) {
  std::mt19937 random(1);
  double sum = 0;
  long count = 0;
  for (int run = 0; run < 4; ++run) {
    const double shift = std::uniform_real_distribution<double>(0, 1)(random) * step;
    auto estimator = velocity::make(kind.name, kind.parameter, rate, step);
    for (int i = 0; i < 2 * rate; ++i) {
      const double t = i / rate;
      const Motion m = path(t);
      const Eigen::Vector3d v = estimator.update({rounded(m.x + shift, step), 0, 0}, i == 0 ? 0 : 1 / rate);
      const bool back = jumps && std::fmod(t, 0.5) < 0.1;  // the path jumps back to its start there
      if (i < 0.2 * rate || back) continue;
      sum += (v.x() - m.v) * (v.x() - m.v), ++count;
    }
  }
  return std::sqrt(sum / static_cast<double>(count));
}

std::string table(double rate, double step) {
  std::string text = fmt::format(
      "\n## {:g} Hz, steps of {:g} um\n\n| estimator | rms error, strokes [mm/s] | rms error, taps [mm/s] | delay at 5 "
      "Hz [ms] | "
      "gain at 20 Hz | gain at 45 Hz |\n|---|---|---|---|---|---|\n",
      rate, step * 1e6);
  for (const Kind& kind : kKinds)
    text += fmt::format("| {} | {:.2f} | {:.1f} | {:.2f} | {:.2f} | {:.2f} |\n", kind.words,
                        1e3 * rmsError(kind, rate, step, strokes, false), 1e3 * rmsError(kind, rate, step, taps, true),
                        1e3 * responseOf(kind, rate, 5, 0.01, step).delay, responseOf(kind, rate, 20, 0.003, step).gain,
                        responseOf(kind, rate, 45, 0.0007, step).gain);
  return text;
}

std::string claims() {
  constexpr double kRate = 1500;
  const auto window = bench::windowResponse(15, kRate, 10);
  const double cutoff = bench::windowCutoff(15, kRate);
  std::string text = fmt::format(
      "\n## What the paper says of Eq. 5\n\n| statement | found |\n|---|---|\n"
      "| \"nearly delay-free\" at n = 15, 1500 Hz | the delay is n T / 2 = {:.3f} ms at every frequency; -3 dB at "
      "{:.1f} Hz; white noise "
      "of the positions comes out {:.0f} times as large a second |\n"
      "| Chebyshev and Butterworth filters behind a difference have \"a delay of three times\" | true from order 6 "
      "(Butterworth) and 5 "
      "(Chebyshev) on, cut off at the same frequency: below |\n"
      "| the impulse response (6) is the ideal differentiator's | exact; but cut to few taps it must be made to have "
      "gain 1, and it is noisy: below |\n"
      "| \"as good, on average, as the Kalman filter\" | not here: see the tables above |\n\n"
      "| low pass behind a difference | delay over that of Eq. 5 |\n|---|---|\n",
      window.delay * 1e3, cutoff, window.noise_gain);
  for (const int order : {2, 4, 6, 7})
    text += fmt::format("| Butterworth, order {} | {:.2f} |\n", order,
                        bench::butterworthDelay(order, cutoff, kRate) / window.delay);
  for (const int order : {2, 4, 5})
    text += fmt::format("| Chebyshev 1 dB, order {} | {:.2f} |\n", order,
                        bench::chebyshevDelay(order, 1, cutoff, kRate) / window.delay);
  text +=
      "\n| taps of Eq. 6 | gain at 0 before it is made 1 | delay [samples] | noise at 1500 Hz [1/s] "
      "|\n|---|---|---|---|\n";
  for (const int taps : {2, 4, 8, 16, 32})
    text += fmt::format("| {} | {:.3f} | {} | {:.0f} |\n", taps, bench::truncatedGain(taps), (taps - 1) / 2.0,
                        bench::truncatedNoise(taps, kRate));
  return text +
         fmt::format("| plain difference | 1 | 0.5 | {:.0f} |\n", bench::windowResponse(1, kRate, 10).noise_gain);
}

constexpr double kDrawnRate = 1500, kDrawnStep = 10e-6;  // [Hz], [m]

/// Adds the gain and the delay of each estimator over the frequency.
void drawResponses(Picture& picture) {
  constexpr double kRate = kDrawnRate, kStep = kDrawnStep;
  std::vector<Curve> gains, delays;
  Curve ideal{"ideal differentiator", "#222", {}, {}, 1.0};
  for (size_t i = 0; i < kKinds.size(); ++i) {
    gains.push_back({kKinds[i].words, colourOf(i), {}, {}});
    delays.push_back({kKinds[i].words, colourOf(i), {}, {}});
  }
  for (double f = 1; f <= 400; f *= 1.08) {
    ideal.x.push_back(f), ideal.y.push_back(1);
    for (size_t i = 0; i < kKinds.size(); ++i) {
      const Response r = responseOf(kKinds[i], kRate, f, 0.3 / (2 * M_PI * f), kStep);
      gains[i].x.push_back(f), gains[i].y.push_back(r.gain);
      delays[i].x.push_back(f), delays[i].y.push_back(f > 100 ? std::nan("") : r.delay * 1e3);
    }
  }
  gains.push_back(ideal);
  picture.add(
      {"Gain against the ideal differentiator, 0.3 m/s", {"frequency [Hz]", 1, 400, true}, {"gain", 0, 1.6}, gains});
  picture.add(hapticd::record::Panel("Delay", {"frequency [Hz]", 1, 100, true}, {"[ms]", -2, 8}, delays));
}

/// Adds what each estimator makes of a fast and of a slow motion.
void drawMotions(Picture& picture) {
  constexpr double kRate = kDrawnRate, kStep = kDrawnStep;
  std::vector<Curve> tap{{"truth", "#222", {}, {}, 2.2}}, slow{{"truth", "#222", {}, {}, 2.2}};
  for (const bool fast : {true, false})
    for (size_t i = 0; i < kKinds.size(); ++i) {
      auto estimator = velocity::make(kKinds[i].name, kKinds[i].parameter, kRate, kStep);
      Curve curve{kKinds[i].words, colourOf(i), {}, {}, 1.1};
      for (int k = 0; k < 0.5 * kRate; ++k) {
        const double t = k / kRate, x = fast ? taps(t).x : 0.002 * t + 1e-4 * std::sin(2 * M_PI * 8 * t);
        const double v = estimator.update({rounded(x, kStep), 0, 0}, k == 0 ? 0 : 1 / kRate).x();
        const double truth = fast ? taps(t).v : 0.002 + 1e-4 * 2 * M_PI * 8 * std::cos(2 * M_PI * 8 * t);
        if (t < 0.24 || t > (fast ? 0.29 : 0.4)) continue;
        curve.x.push_back((t - 0.25) * 1e3), curve.y.push_back(v * 1e3);
        if (i > 0) continue;
        Curve& line = fast ? tap[0] : slow[0];
        line.x.push_back((t - 0.25) * 1e3), line.y.push_back(truth * 1e3);
      }
      (fast ? tap : slow).push_back(curve);
    }
  picture.add(hapticd::record::Panel("A tap on a wall of 45 Hz", {"t [ms]", -10, 40}, {"v [mm/s]", -300, 300}, tap));
  picture.add(
      hapticd::record::Panel("Slow motion: the steps are seen", {"t [ms]", -10, 150}, {"v [mm/s]", -15, 20}, slow));
}

void draw(const std::string& file) {
  Picture picture("Velocity estimators at 1500 Hz, steps of 10 um", {520, 520});
  drawResponses(picture);
  drawMotions(picture);
  if (auto saved = hapticd::writeWhole(file, picture.svg()); !saved) throw std::runtime_error(saved.error());
}

int run(bool write) {
  const std::string text = table(1000, 30e-6) + table(1500, 10e-6) + table(10000, 3e-6) + claims();
  fmt::print("{}", text);
  if (!write) return 0;
  const std::filesystem::path folder = HAPTICD_SOURCE_DIR "/driver/docs/reports";
  std::filesystem::create_directories(folder / "pictures");
  draw(folder / "pictures/velocity.svg");
  std::ofstream out(folder / "velocity.md");
  out << "# Velocity from positions\n\nMade by `velocity --write` (in the build folder's `bench/`).\n\n"
         "Encoders count; velocity must be worked out, and every way to do so pays in delay, noise or both. "
         "`servo.velocity` names the\n"
         "estimator and its one parameter; none runs where nothing in the scene uses velocity.\n\n"
         "- `window`, n samples: the mean velocity over the last n (Eq. 5 of Thompson et al. 1999). Delay n T/2, noise "
         "1/n.\n"
         "- `butterworth`, cut-off in Hz: the difference of two samples through a low pass of second order.\n"
         "- `foaw`, longest window: short in motion, long at rest (Janabi-Sharifi, Hayward and Chen 2000). For stiff "
         "walls.\n"
         "- `least_squares`, n samples: slope of a parabola. Accurate, but overshoots fast motion.\n"
         "- `kalman`, density of the jerk in m^2/s^5: the most accurate where the motion is smooth; a larger density "
         "follows faster\n"
         "  and is noisier. What is best for accuracy is not what holds the stiffest wall: short windows and foaw do\n"
         "  ([zwidth.md](zwidth.md)).\n\n"
         "![gain, delay, a tap and slow motion](pictures/velocity.svg)\n\n"
         "Strokes are swings of up to 5 cm and 4 Hz with a tremor; taps hit a wall of 45 Hz (75 g on 6000 N/m) at 0.2 "
         "m/s.\n"
      << text;
  if (!out.flush()) throw std::runtime_error("velocity.md: cannot be written");
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  constexpr const char* kUsage =
      "Usage: velocity [--write]\n\n"
      "Compares the velocity estimators on steps of an encoder and prints tables.\n"
      "  --write  overwrite driver/docs/reports/velocity.md and its picture\n\n"
      "Exit code 2: bad usage.\n";
  const std::string word = argc > 1 ? argv[1] : "";
  if (word == "--help" || word == "-h") {
    fmt::print("{}", kUsage);
    return 0;
  }
  if (argc > 2 || (argc == 2 && word != "--write")) {
    fmt::print(stderr, "error: {} is not an option\n{}", argv[argc - 1], kUsage);
    return 2;
  }
  try {
    return run(word == "--write");
  } catch (const std::exception& e) {
    fmt::print(stderr, "error: {}\n", e.what());
    return 1;
  }
}

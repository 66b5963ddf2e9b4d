// SPDX-License-Identifier: MIT
/// Gain, phase, delay and noise of velocity estimates, in closed form.
#pragma once

namespace hapticd::velocity_bench {

/// Frequency response of the window of Eq. 5, H = (1 - exp(-j w n T)) / (nT).
struct WindowResponse {
  double gain;        ///< |H| [1/s]
  double phase;       ///< arg H [rad]; pi/2 for an ideal differentiator
  double delay;       ///< nT/2 [s], at every frequency
  double noise_gain;  ///< [1/s] rms of the velocity over rms of white noise in the positions
};
/// [any] @param n samples  @param rate [Hz]  @param frequency [Hz]
WindowResponse windowResponse(int n, double rate, double frequency) noexcept;

/// [any] Impulse response of the ideal differentiator with half a sample of delay, per sample (Eq. 6):
/// (-1)^n / (pi (n - 1/2)^2). Divide by T for 1/s.
double idealTap(int n) noexcept;

}  // namespace hapticd::velocity_bench

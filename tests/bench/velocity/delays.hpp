// SPDX-License-Identifier: MIT
/// The delays that the NURBS paper compares: low passes behind a difference of two samples, cut off where its window
/// is.
#pragma once
#include <vector>

namespace hapticd::velocity_bench {

/// [Hz] Where the window of n samples has lost 3 dB against an ideal differentiator.
double windowCutoff(int n, double rate);

/// [s] Delay at low frequency of a difference of two samples behind a low pass by the bilinear transform: order even or
/// odd, -3 dB at `cutoff`. Chebyshev with a ripple of `ripple_db` below its passband's top.
double butterworthDelay(int order, double cutoff, double rate);
double chebyshevDelay(int order, double ripple_db, double cutoff, double rate);

/// Gain at frequency 0 of the ideal differentiator of Eq. 6 cut to its `taps` middle taps; 1 when nothing is cut.
double truncatedGain(int taps);

/// [1/s] rms of the velocity over that of white noise in the positions, for those taps, made to have gain 1.
double truncatedNoise(int taps, double rate);

}  // namespace hapticd::velocity_bench

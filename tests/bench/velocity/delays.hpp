// SPDX-License-Identifier: MIT
/// The delays that the NURBS paper compares: those of its window, and of low passes behind a difference of two samples
/// with the same cut-off frequency.
#pragma once
#include <vector>

namespace hapticd::velocity_bench {

/// Returns the frequency [Hz] at which the window of n samples is 3 dB below an ideal differentiator.
double windowCutoff(int n, double rate);

/// Return the delay [s] at low frequency of a difference of two samples with a low pass behind it, made by the bilinear
/// transform. @param order even or odd @param cutoff [Hz] frequency at which the gain is 3 dB lower @param ripple_db
/// [dB] ripple of the Chebyshev filter, below the maximum of its passband
double butterworthDelay(int order, double cutoff, double rate);
double chebyshevDelay(int order, double ripple_db, double cutoff, double rate);

/// Returns the gain at frequency 0 of the ideal differentiator of Eq. 6, if only its `taps` middle taps are kept; 1
/// with all taps.
double truncatedGain(int taps);

/// Returns the rms of the velocity divided by the rms of white noise in the positions [1/s], for these taps after they
/// are scaled to gain 1.
double truncatedNoise(int taps, double rate);

}  // namespace hapticd::velocity_bench

// SPDX-License-Identifier: MIT
/// Elementary functions whose results are the same bits on every machine and with every compiler: sums, products,
/// quotients and square roots in a fixed order, which IEEE 754 defines to the last bit. C libraries differ from each
/// other, and from themselves on processors with and without fused multiplication. Errors are below 3 units in the last
/// place (a power: 5); special values are those of C.
#pragma once

namespace hapticd::elementary {

double sine(double x) noexcept;                               ///< [any] x in rad
double cosine(double x) noexcept;                             ///< [any]
void sineAndCosine(double x, double* s, double* c) noexcept;  ///< [any]
double tangent(double x) noexcept;                            ///< [any]
double arcTangent(double x) noexcept;                         ///< [any]
double angleOf(double y, double x) noexcept;                  ///< [any] of the vector (x, y), as atan2
double arcSine(double x) noexcept;                            ///< [any]
double arcCosine(double x) noexcept;                          ///< [any]
double exponential(double x) noexcept;                        ///< [any]
double exponentialLessOne(double x) noexcept;                 ///< [any] exp(x) - 1, exact near 0
double logarithm(double x) noexcept;                          ///< [any] natural
double logarithmOfOnePlus(double x) noexcept;                 ///< [any]
double power(double x, double y) noexcept;                    ///< [any]
double hypotenuse(double x, double y) noexcept;               ///< [any] without overflow on the way
double hyperbolicTangent(double x) noexcept;                  ///< [any]

}  // namespace hapticd::elementary

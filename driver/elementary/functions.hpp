// SPDX-License-Identifier: MIT
/// Elementary functions whose results have the same bits on every machine and with every compiler. They consist of
/// sums, products, quotients and square roots in a fixed order, and IEEE 754 defines each of these to the last bit. The
/// C libraries' own functions differ between libraries, and between processors with and without fused multiplication.
/// Errors are below 3 units in the last place (power: 5). Special values, such as infinities, give the results of C.
#pragma once

namespace hapticd::elementary {

double sine(double x) noexcept;                               ///< [any] x in rad
double cosine(double x) noexcept;                             ///< [any]
void sineAndCosine(double x, double* s, double* c) noexcept;  ///< [any]
double tangent(double x) noexcept;                            ///< [any]
double arcTangent(double x) noexcept;                         ///< [any]
double angleOf(double y, double x) noexcept;                  ///< [any] angle of the vector (x, y), as atan2(y, x)
double arcSine(double x) noexcept;                            ///< [any]
double arcCosine(double x) noexcept;                          ///< [any]
double exponential(double x) noexcept;                        ///< [any]
double exponentialLessOne(double x) noexcept;                 ///< [any] exp(x) - 1, accurate near 0
double logarithm(double x) noexcept;                          ///< [any] natural logarithm
double logarithmOfOnePlus(double x) noexcept;                 ///< [any] ln(1 + x), accurate near 0
double power(double x, double y) noexcept;                    ///< [any]
double hypotenuse(double x, double y) noexcept;  ///< [any] sqrt(x^2 + y^2), without overflow of the squares
double hyperbolicTangent(double x) noexcept;     ///< [any]

}  // namespace hapticd::elementary

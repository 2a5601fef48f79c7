#pragma once

/// Elementary functions that give the same bits with every compiler, processor and C library: made of + - * / and
/// square roots of IEEE doubles, which are exact to the last bit. The C library promises no last bit, and selects code
/// by processor. Use these in the library; scripts/test.d/plain_cmake.sh fails if it calls others.
///
/// The largest errors that test/common/elementary_test.cpp finds are below 0.9 units in the last place, most below 0.6.
/// Special values (zero, infinity, NaN, arguments out of range) are those of the C library. No errno, no flags.
///
/// Methods: reduction of the argument by constants in several parts (Cody & Waite 1980, "Software manual for the
/// elementary functions"), of huge angles with as many digits of 2/pi as needed (Payne & Hanek 1983, "Radian reduction
/// for trigonometric functions"); then a Taylor polynomial, with leading terms in two doubles (Dekker 1971, "A
/// floating-point technique for extending the available precision"), as in Tang 1990, "Table-driven implementation of
/// the logarithm function", and Tang 1991, "Table-lookup algorithms for elementary functions".
namespace vibe::math {

double exp(double x);
double expm1(double x);  ///< exp(x) - 1
double log(double x);
double log1p(double x);  ///< log(1 + x)
double sin(double x);
double cos(double x);
double tan(double x);
double acos(double x);
double atan2(double y, double x);
double tanh(double x);
double asinh(double x);
double cbrt(double x);
double hypot(double x, double y);

}  // namespace vibe::math

#pragma once

namespace vibe::vision {

/// Probability that the size of a t-distributed number is larger than |t|. @param freedom  degrees of freedom, >= 1
double studentTail(double t, int freedom);
/// The t for which studentTail() is `tail`, (0, 1).
double studentQuantile(double tail, int freedom);

}  // namespace vibe::vision

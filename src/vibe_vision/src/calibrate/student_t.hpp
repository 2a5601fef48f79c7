#pragma once

namespace vibe {

/// Probability that the size of a t-distributed number is larger than |t|. @param freedom  degrees of freedom, >= 1
double studentTail(double t, int freedom);

}  // namespace vibe

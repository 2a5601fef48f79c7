#include "vibe_core/program/floating_point.hpp"

#if defined(__SSE__)
#include <xmmintrin.h>
#else
#include <cfenv>
#endif

#include "vibe_core/program/error.hpp"

namespace vibe {

namespace {

#if defined(__SSE__)
bool roundsToNearest() {
  return (_mm_getcsr() & 0x6000U) == 0;  // the field RC of MXCSR (Intel SDM volume 1, 10.2.3)
}
bool keepsSmallNumbers() {
  return (_mm_getcsr() & 0x8040U) == 0;  // its bits FZ and DAZ
}
#else
bool roundsToNearest() {
  return std::fegetround() == FE_TONEAREST;
}
bool keepsSmallNumbers() {
  const volatile double small = 0x1p-1000, factor = 0x1p-50;
  return small * factor != 0;
}
#endif

}  // namespace

void checkFloatingPoint() {
  if (!roundsToNearest())
    throw Error(
        "This thread does not round to nearest, so that a step would have other results; call "
        "fesetround(FE_TONEAREST) after what has changed it.");
  if (!keepsSmallNumbers())
    throw Error(
        "This thread takes small numbers for 0 (flush to zero), so that a step would have other results; switch that "
        "off, such as by torch.set_flush_denormal(False).");
}

}  // namespace vibe

#pragma once

#include <emmintrin.h>

#include <cmath>
#include <xsimd/xsimd.hpp>

// a b + c for kernels, for a scalar or a pack of scalars. Everything is a template or inline in an unnamed namespace:
// this file is compiled for several instruction sets, and a function shared between them could run on a machine that
// lacks the instructions.

namespace vibe {

/// SSE2 with an emulated fused multiply-add: slow, with the bits of the processors that have one.
struct FusedSse2 : xsimd::sse2 {};

/// What KernelSets::VIBE_KERNEL_SET compiles for.
struct KernelSets {
  using Sse2 = xsimd::sse2;
  using FusedSse2 = vibe::FusedSse2;
  using Avx2 = xsimd::fma3<xsimd::avx2>;
};

}  // namespace vibe

namespace xsimd::types {
XSIMD_DECLARE_SIMD_REGISTER_ALIAS(vibe::FusedSse2, sse2);
}  // namespace xsimd::types

#ifdef __AVX512F__
namespace xsimd {
/// The sign is changed, as in all other instruction sets; xsimd 8 subtracts from 0 here, which differs for 0.
template <>
inline batch<float, avx512bw> batch<float, avx512bw>::operator-() const noexcept {
  return _mm512_xor_ps(data, _mm512_set1_ps(-0.0f));
}
}  // namespace xsimd
#endif

namespace vibe {
namespace {

/// a b + c. A pack of floats or doubles rounds once, unless its architecture has no fused operation.
template <class B>
inline B mulAdd(const B& a, const B& b, const B& c) {
  return a * b + c;
}
template <class T, class A>
inline xsimd::batch<T, A> mulAdd(const xsimd::batch<T, A>& a, const xsimd::batch<T, A>& b,
                                 const xsimd::batch<T, A>& c) {
  return xsimd::fma(a, b, c);
}

/// c - a b
template <class B>
inline B minusMul(const B& a, const B& b, const B& c) {
  return c - a * b;
}
template <class T, class A>
inline xsimd::batch<T, A> minusMul(const xsimd::batch<T, A>& a, const xsimd::batch<T, A>& b,
                                   const xsimd::batch<T, A>& c) {
  return xsimd::fnma(a, b, c);
}

#ifdef __AVX512F__
// xsimd 8 has no fused operations for AVX-512
using WidePack = xsimd::batch<float, xsimd::avx512bw>;
inline WidePack mulAdd(const WidePack& a, const WidePack& b, const WidePack& c) {
  return _mm512_fmadd_ps(a, b, c);
}
inline WidePack minusMul(const WidePack& a, const WidePack& b, const WidePack& c) {
  return _mm512_fnmadd_ps(a, b, c);
}
#endif

/// product + c of doubles, rounded to odd: where the sum is not exact, its last bit is 1. Rounded to float afterwards
/// it is the exact sum rounded once (Boldo & Melquiond 2008, "Emulation of a FMA and correctly rounded sums"). Products
/// of floats are exact in double precision.
inline __m128d sumToOdd(__m128d product, __m128d c) {
  const __m128d sum = _mm_add_pd(product, c), part = _mm_sub_pd(sum, product), zero = _mm_setzero_pd();
  const __m128d error = _mm_add_pd(_mm_sub_pd(product, _mm_sub_pd(sum, part)), _mm_sub_pd(c, part));
  const __m128i inexact = _mm_castpd_si128(_mm_or_pd(_mm_cmplt_pd(error, zero), _mm_cmpgt_pd(error, zero)));
  const __m128i bits = _mm_castpd_si128(sum);
  const __m128i unit = _mm_andnot_si128(bits, _mm_and_si128(inexact, _mm_set1_epi64x(1)));  // 1 if the last bit is 0
  const __m128i inward = _mm_srli_epi64(_mm_castpd_si128(_mm_xor_pd(error, sum)), 63);      // 1 if the sum is too large
  const __m128i back = _mm_slli_epi64(_mm_and_si128(unit, inward), 1);
  return _mm_castsi128_pd(_mm_add_epi64(bits, _mm_sub_epi64(unit, back)));
}

using FusedFloats = xsimd::batch<float, FusedSse2>;
inline FusedFloats mulAdd(const FusedFloats& a, const FusedFloats& b, const FusedFloats& c) {
  const auto upper = [](__m128 x) { return _mm_cvtps_pd(_mm_movehl_ps(x, x)); };
  const __m128d low = sumToOdd(_mm_mul_pd(_mm_cvtps_pd(a), _mm_cvtps_pd(b)), _mm_cvtps_pd(c));
  const __m128d high = sumToOdd(_mm_mul_pd(upper(a), upper(b)), upper(c));
  return FusedFloats(_mm_movelh_ps(_mm_cvtpd_ps(low), _mm_cvtpd_ps(high)));
}
inline FusedFloats minusMul(const FusedFloats& a, const FusedFloats& b, const FusedFloats& c) {
  return mulAdd(-a, b, c);
}

using FusedDoubles = xsimd::batch<double, FusedSse2>;
inline FusedDoubles mulAdd(const FusedDoubles& a, const FusedDoubles& b, const FusedDoubles& c) {
  alignas(16) double x[2], y[2], z[2];
  a.store_aligned(x), b.store_aligned(y), c.store_aligned(z);
  return FusedDoubles(_mm_set_pd(std::fma(x[1], y[1], z[1]), std::fma(x[0], y[0], z[0])));
}

}  // namespace
}  // namespace vibe

#pragma once
#include <immintrin.h>

#include <cstdint>
#include <xsimd/xsimd.hpp>

#include "arithmetic/multiply_add.hpp"
#include "tissue/element_batch.hpp"

namespace vibe {
namespace {

/// Loads the nodes of the lanes, 4 floats each, and adds to them, and forms sums over elements. Here for SSE2, where a
/// batch has two parts. The order of additions is the same in all instruction sets: everything of a node before the
/// next node, lanes in ascending order.
template <class Arch>
struct BatchLanes {
  using Pack = xsimd::batch<float, Arch>;

  static void load(const float* base, const std::uint32_t* offset, Pack (&out)[3]) {
    const __m128 a = _mm_loadu_ps(base + offset[0]), b = _mm_loadu_ps(base + offset[1]);
    const __m128 c = _mm_loadu_ps(base + offset[2]), d = _mm_loadu_ps(base + offset[3]);
    const __m128 ab = _mm_unpacklo_ps(a, b), cd = _mm_unpacklo_ps(c, d);
    out[0] = Pack(_mm_movelh_ps(ab, cd));
    out[1] = Pack(_mm_movehl_ps(cd, ab));
    out[2] = Pack(_mm_movelh_ps(_mm_unpackhi_ps(a, b), _mm_unpackhi_ps(c, d)));
  }

  // One lane after another, because lanes may share a node.
  static void add(float* base, const std::uint32_t* offset, const Pack (&in)[3]) {
    const __m128 zero = _mm_setzero_ps();
    const __m128 xy = _mm_unpacklo_ps(in[0], in[1]), xy2 = _mm_unpackhi_ps(in[0], in[1]);
    const __m128 z = _mm_unpacklo_ps(in[2], zero), z2 = _mm_unpackhi_ps(in[2], zero);
    addTo(base + offset[0], _mm_movelh_ps(xy, z));
    addTo(base + offset[1], _mm_movehl_ps(z, xy));
    addTo(base + offset[2], _mm_movelh_ps(xy2, z2));
    addTo(base + offset[3], _mm_movehl_ps(z2, xy2));
  }

  static void addTo(float* node, __m128 value) { _mm_storeu_ps(node, _mm_add_ps(_mm_loadu_ps(node), value)); }

  struct Sum {  // in double precision, two lanes each
    __m128d lanes[4] = {_mm_setzero_pd(), _mm_setzero_pd(), _mm_setzero_pd(), _mm_setzero_pd()};

    void add(const Pack& value, int part) {
      lanes[2 * part] = _mm_add_pd(lanes[2 * part], _mm_cvtps_pd(value));
      lanes[2 * part + 1] = _mm_add_pd(lanes[2 * part + 1], _mm_cvtps_pd(_mm_movehl_ps(value, value)));
    }
    double total() const {
      alignas(16) double part[4];
      _mm_store_pd(part, _mm_add_pd(lanes[0], lanes[2]));
      _mm_store_pd(part + 2, _mm_add_pd(lanes[1], lanes[3]));
      return (part[0] + part[1]) + (part[2] + part[3]);
    }
  };
};

#ifdef __AVX2__
template <>
struct BatchLanes<xsimd::fma3<xsimd::avx2>> {
  using Pack = xsimd::batch<float, xsimd::fma3<xsimd::avx2>>;

  // nodes of lanes k and k + 4
  static __m256 pair(const float* base, const std::uint32_t* offset, int k) {
    return _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_loadu_ps(base + offset[k])),
                                _mm_loadu_ps(base + offset[k + 4]), 1);
  }

  static void load(const float* base, const std::uint32_t* offset, Pack (&out)[3]) {
    const __m256 a = pair(base, offset, 0), b = pair(base, offset, 1);
    const __m256 c = pair(base, offset, 2), d = pair(base, offset, 3);
    const __m256 ab = _mm256_unpacklo_ps(a, b), cd = _mm256_unpacklo_ps(c, d);
    out[0] = Pack(_mm256_shuffle_ps(ab, cd, _MM_SHUFFLE(1, 0, 1, 0)));
    out[1] = Pack(_mm256_shuffle_ps(ab, cd, _MM_SHUFFLE(3, 2, 3, 2)));
    out[2] = Pack(_mm256_shuffle_ps(_mm256_unpackhi_ps(a, b), _mm256_unpackhi_ps(c, d), _MM_SHUFFLE(1, 0, 1, 0)));
  }

  // One lane after another, because lanes may share a node.
  static void add(float* base, const std::uint32_t* offset, const Pack (&in)[3]) {
    const __m256 zero = _mm256_setzero_ps();
    const __m256 xy = _mm256_unpacklo_ps(in[0], in[1]), xy2 = _mm256_unpackhi_ps(in[0], in[1]);
    const __m256 z = _mm256_unpacklo_ps(in[2], zero), z2 = _mm256_unpackhi_ps(in[2], zero);
    const __m256 row[4] = {
        _mm256_shuffle_ps(xy, z, _MM_SHUFFLE(1, 0, 1, 0)), _mm256_shuffle_ps(xy, z, _MM_SHUFFLE(3, 2, 3, 2)),
        _mm256_shuffle_ps(xy2, z2, _MM_SHUFFLE(1, 0, 1, 0)), _mm256_shuffle_ps(xy2, z2, _MM_SHUFFLE(3, 2, 3, 2))};
    for (int k = 0; k < 4; ++k) addTo(base + offset[k], _mm256_castps256_ps128(row[k]));
    for (int k = 0; k < 4; ++k) addTo(base + offset[k + 4], _mm256_extractf128_ps(row[k], 1));
  }

  static void addTo(float* node, __m128 value) { _mm_storeu_ps(node, _mm_add_ps(_mm_loadu_ps(node), value)); }

  struct Sum {  // in double precision
    __m256d low = _mm256_setzero_pd(), high = _mm256_setzero_pd();

    void add(const Pack& value, int /*part*/ = 0) {
      low = _mm256_add_pd(low, _mm256_cvtps_pd(_mm256_castps256_ps128(value)));
      high = _mm256_add_pd(high, _mm256_cvtps_pd(_mm256_extractf128_ps(value, 1)));
    }
    double total() const {
      alignas(32) double part[4];
      _mm256_store_pd(part, _mm256_add_pd(low, high));
      return (part[0] + part[1]) + (part[2] + part[3]);
    }
  };
};
#endif

}  // namespace
}  // namespace vibe

#pragma once

#include <emmintrin.h>
#ifdef __F16C__
#include <immintrin.h>
#endif

#include <cstddef>

#include "arithmetic/multiply_add.hpp"
#include "sparse/panel_kernel.hpp"

namespace vibe {
namespace {

/// Eight floats in as many registers as the architecture requires.
template <class Arch>
struct Eight {
  using Pack = xsimd::batch<float, Arch>;
  static constexpr int kWidth = static_cast<int>(Pack::size);
  static constexpr int kParts = kTile / kWidth;
  Pack part[kParts];

  static Eight all(float value) {
    Eight r;
    for (Pack& p : r.part) p = Pack(value);
    return r;
  }
  static Eight load(const float* from) {
    Eight r;
    for (int i = 0; i < kParts; ++i) r.part[i] = Pack::load_aligned(from + i * kWidth);
    return r;
  }
  // four halves at a time: interpret the bits as a float with a wrong exponent, then correct the exponent by one exact
  // product
  static __m128 widen(__m128i half) {
    const __m128i magnitude = _mm_slli_epi32(_mm_and_si128(half, _mm_set1_epi32(0x7fff)), 13);
    const __m128 sign = _mm_castsi128_ps(_mm_slli_epi32(_mm_and_si128(half, _mm_set1_epi32(0x8000)), 16));
    return _mm_or_ps(_mm_mul_ps(_mm_castsi128_ps(magnitude), _mm_set1_ps(0x1p112F)), sign);
  }
  static Eight load(const std::uint16_t* from) {
    const __m128i halves = _mm_load_si128(reinterpret_cast<const __m128i*>(from));
    Eight r;
#ifdef __F16C__
    r.part[0] = Pack(_mm256_cvtph_ps(halves));
#else
    r.part[0] = Pack(widen(_mm_unpacklo_epi16(halves, _mm_setzero_si128())));
    r.part[1] = Pack(widen(_mm_unpackhi_epi16(halves, _mm_setzero_si128())));
#endif
    return r;
  }
  void store(float* to) const {
    for (int i = 0; i < kParts; ++i) part[i].store_aligned(to + i * kWidth);
  }
  void addProduct(const Eight& a, const Eight& b) {
    for (int i = 0; i < kParts; ++i) part[i] = mulAdd(a.part[i], b.part[i], part[i]);
  }
  void add(const Eight& a) {
    for (int i = 0; i < kParts; ++i) part[i] = part[i] + a.part[i];
  }
  /// The sums of eight Eights, each ((0 + 1) + (2 + 3)) + ((4 + 5) + (6 + 7)) in every architecture.
  static Eight sums(const Eight* list) {
    Eight r;
    if constexpr (kParts == 1) {
      Pack whole[kTile];
      for (int j = 0; j < kTile; ++j) whole[j] = list[j].part[0];
      r.part[0] = xsimd::haddp(whole);
    } else {
      for (int i = 0; i < kParts; ++i) r.part[i] = fourSums(list + i * kWidth, 0) + fourSums(list + i * kWidth, 1);
    }
    return r;
  }
  static Pack fourSums(const Eight* list, int half) {
    __m128 a = list[0].part[half], b = list[1].part[half], c = list[2].part[half], d = list[3].part[half];
    _MM_TRANSPOSE4_PS(a, b, c, d);
    return Pack(_mm_add_ps(_mm_add_ps(a, b), _mm_add_ps(c, d)));
  }
};

template <class Arch, class Number>
struct PanelKernel {
  using Lane = Eight<Arch>;

  // prefetches a block of rows, this many bytes ahead of p: panels come from the outer caches, or from memory
  template <int kColumns>
  static void prefetchBlock(const Number* p, std::ptrdiff_t ahead) {
    constexpr int kBytes = kTile * kColumns * static_cast<int>(sizeof(Number));
    const char* first = reinterpret_cast<const char*>(p) + ahead;
    for (int i = 0; i < kBytes; i += 64) _mm_prefetch(first + i, _MM_HINT_T0);
  }

  // ---- forward: a tile times the entries of its columns, added to work (or written, for the first tile)
  template <int kColumns, bool kFirst>
  static void forwardTile(const Number* p, int blocks, const float* x, const float* scale, float* work,
                          std::ptrdiff_t ahead) {
    Lane factor[kColumns];
    for (int j = 0; j < kColumns; ++j) factor[j] = Lane::all(x[j] * scale[j]);
    for (int block = 0; block < blocks; ++block, p += kTile * kColumns, work += kTile) {
      prefetchBlock<kColumns>(p, ahead);
      Lane even = kFirst ? Lane::all(0) : Lane::load(work), odd = Lane::all(0);
      for (int j = 0; j < kColumns; ++j) (j % 2 == 0 ? even : odd).addProduct(Lane::load(p + j * kTile), factor[j]);
      even.add(odd);
      even.store(work);
    }
  }

  template <bool kFirst>
  static void forwardTile(int columns, const Number* p, int blocks, const float* x, const float* scale, float* work,
                          std::ptrdiff_t ahead) {
    switch (columns) {
      case 1:
        return forwardTile<1, kFirst>(p, blocks, x, scale, work, ahead);
      case 2:
        return forwardTile<2, kFirst>(p, blocks, x, scale, work, ahead);
      case 3:
        return forwardTile<3, kFirst>(p, blocks, x, scale, work, ahead);
      case 4:
        return forwardTile<4, kFirst>(p, blocks, x, scale, work, ahead);
      case 5:
        return forwardTile<5, kFirst>(p, blocks, x, scale, work, ahead);
      case 6:
        return forwardTile<6, kFirst>(p, blocks, x, scale, work, ahead);
      case 7:
        return forwardTile<7, kFirst>(p, blocks, x, scale, work, ahead);
      default:
        return forwardTile<kTile, kFirst>(p, blocks, x, scale, work, ahead);
    }
  }

  // rows of some blocks of the product of a panel with its own rows
  static void forwardRows(const PanelSet& set, const PanelStep& step, BlockRange rows, const float* own, float* work) {
    const Number* p = static_cast<const Number*>(set.numbers) + step.panel;
    const float* scale = set.column_scale + step.first_row;
    const int last = rows.last * kTile < step.columns ? rows.last * kTile : step.columns;
    for (int column = 0, block = 0; column < last; column += kTile, ++block) {
      const int width = step.columns - column < kTile ? step.columns - column : kTile;
      const int first = rows.first > block ? rows.first : block;
      const Number* from = p + static_cast<std::ptrdiff_t>(kTile * width) * (first - block);
      if (column == 0)
        forwardTile<true>(width, from, rows.last - first, own, scale, work + first * kTile, set.ahead);
      else
        forwardTile<false>(width, from, rows.last - first, own + column, scale + column, work + first * kTile,
                           set.ahead);
      p += kTile * width * (step.row_blocks - block);
    }
  }

  // @returns where the next step records
  static float* forwardStep(const PanelSet& set, const PanelStep& step, float* vector, float* work, float* record) {
    float* own = vector + step.first_row;
    forwardRows(set, step, {0, step.row_blocks}, own, work);
    for (int i = 0; i < step.columns; ++i) own[i] = work[i];
    const float* update = work + step.columns;
    const std::int32_t *index = set.row_index + step.first_index, *end = index + step.below_nodes;
    for (; index < end && *index < set.end_row; ++index, update += 3) {
      float* row = vector + *index;
      row[0] += update[0];
      row[1] += update[1];
      row[2] += update[2];
    }
    for (; index < end; ++index, update += 3, record += 3)
      for (int a = 0; a < 3; ++a) record[a] = update[a];
    return record;
  }

  static void forward(const PanelSet& set, float* vector, float* work) {
    float* record = set.record;
    for (int s = 0; s < set.step_count; ++s) record = forwardStep(set, set.steps[s], vector, work, record);
  }

  // ---- backward: the columns of a tile times the rows; reads from the end to the start, because the data that the
  // forward pass read last is still in the cache
  template <int kColumns>
  static void backwardTile(const Number* end, int blocks, const float* work, const float* scale, float* x,
                           std::ptrdiff_t ahead) {
    Lane sum[kTile];
    for (Lane& s : sum) s = Lane::all(0);
    for (int block = blocks - 1; block >= 0; --block) {
      end -= kTile * kColumns;
      prefetchBlock<kColumns>(end, -ahead);
      const Lane row = Lane::load(work + block * kTile);
      for (int j = 0; j < kColumns; ++j) sum[j].addProduct(Lane::load(end + j * kTile), row);
    }
    alignas(32) float result[kTile];
    Lane::sums(sum).store(result);
    for (int j = 0; j < kColumns; ++j) x[j] = result[j] * scale[j];
  }

  static void backwardTile(int columns, const Number* end, int blocks, const float* work, const float* scale, float* x,
                           std::ptrdiff_t ahead) {
    switch (columns) {
      case 1:
        return backwardTile<1>(end, blocks, work, scale, x, ahead);
      case 2:
        return backwardTile<2>(end, blocks, work, scale, x, ahead);
      case 3:
        return backwardTile<3>(end, blocks, work, scale, x, ahead);
      case 4:
        return backwardTile<4>(end, blocks, work, scale, x, ahead);
      case 5:
        return backwardTile<5>(end, blocks, work, scale, x, ahead);
      case 6:
        return backwardTile<6>(end, blocks, work, scale, x, ahead);
      case 7:
        return backwardTile<7>(end, blocks, work, scale, x, ahead);
      default:
        return backwardTile<kTile>(end, blocks, work, scale, x, ahead);
    }
  }

  static void gather(const PanelSet& set, const PanelStep& step, const float* vector, float* work) {
    const float* own = vector + step.first_row;
    for (int i = 0; i < step.columns; ++i) work[i] = own[i];
    float* below = work + step.columns;
    const std::int32_t* index = set.row_index + step.first_index;
    for (int i = 0; i < step.below_nodes; ++i, below += 3) {
      const float* row = vector + index[i];
      below[0] = row[0];
      below[1] = row[1];
      below[2] = row[2];
    }
    for (float* end = work + step.row_blocks * kTile; below < end; ++below) *below = 0;
  }

  // own rows of some tiles, from all rows of the supernode
  static void backwardTiles(const PanelSet& set, const PanelStep& step, BlockRange tiles, const float* work,
                            float* vector) {
    const Number* end =
        static_cast<const Number*>(set.numbers) + step.panel +
        panelSize(tiles.last * kTile < step.columns ? tiles.last * kTile : step.columns, step.row_blocks);
    for (int tile = tiles.last - 1; tile >= tiles.first; --tile) {
      const int column = tile * kTile, blocks = step.row_blocks - tile;
      const int width = step.columns - column < kTile ? step.columns - column : kTile;
      backwardTile(width, end, blocks, work + column, set.column_scale + step.first_row + column,
                   vector + step.first_row + column, set.ahead);
      end -= kTile * width * blocks;
    }
  }

  static void backwardStep(const PanelSet& set, const PanelStep& step, float* vector, float* work) {
    gather(set, step, vector, work);
    backwardTiles(set, step, {0, (step.columns + kTile - 1) / kTile}, work, vector);
  }

  static void backward(const PanelSet& set, float* vector, float* work) {
    for (int s = set.step_count - 1; s >= 0; --s) backwardStep(set, set.steps[s], vector, work);
  }

  // ---- three vectors: columns [0, kColumns) of a tile of `stride` numbers per block
  template <int kColumns>
  static void threeColumns(const Number* p, int stride, int blocks, const float* x, const float* scale, float* work,
                           int plane) {
    Lane factor[3][kColumns];
    for (int j = 0; j < kColumns; ++j)
      for (int k = 0; k < 3; ++k) factor[k][j] = Lane::all(x[3 * j + k] * scale[j]);
    for (int block = 0; block < blocks; ++block, p += stride, work += kTile) {
      Lane a = Lane::load(work), b = Lane::load(work + plane), c = Lane::load(work + 2 * plane);
      for (int j = 0; j < kColumns; ++j) {
        const Lane number = Lane::load(p + j * kTile);
        a.addProduct(number, factor[0][j]);
        b.addProduct(number, factor[1][j]);
        c.addProduct(number, factor[2][j]);
      }
      a.store(work);
      b.store(work + plane);
      c.store(work + 2 * plane);
    }
  }

  // four columns at a time: twelve factors, three sums and one number fit into sixteen registers
  static void threeTile(int columns, const Number* p, int blocks, const float* x, const float* scale, float* work,
                        int plane) {
    const int stride = kTile * columns;
    for (; columns >= 4; columns -= 4, p += 4 * kTile, x += 12, scale += 4)
      threeColumns<4>(p, stride, blocks, x, scale, work, plane);
    for (; columns > 0; --columns, p += kTile, x += 3, ++scale)
      threeColumns<1>(p, stride, blocks, x, scale, work, plane);
  }

  static void stepOfThree(const PanelSet& set, int index_of_step, int from, float* vectors, float* work) {
    const PanelStep& step = set.steps[index_of_step];
    const int plane = step.row_blocks * kTile, first = from / kTile * kTile;
    for (int i = 0; i < 3 * plane; ++i) work[i] = 0;
    const Number* p = static_cast<const Number*>(set.numbers) + step.panel;
    float* own = vectors + 3 * step.first_row;
    for (int column = 0, blocks = step.row_blocks; column < step.columns; column += kTile, --blocks) {
      const int width = step.columns - column < kTile ? step.columns - column : kTile;
      if (column >= first)
        threeTile(width, p, blocks, own + 3 * column, set.column_scale + step.first_row + column, work + column, plane);
      p += kTile * width * blocks;
    }
    for (int i = first; i < step.columns; ++i)
      for (int k = 0; k < 3; ++k) own[3 * i + k] = work[k * plane + i];
    const float* update = work + step.columns;
    for (int i = 0; i < step.below_nodes; ++i, update += 3) {
      float* row = vectors + 3 * set.row_index[step.first_index + i];
      for (int a = 0; a < 3; ++a)
        for (int k = 0; k < 3; ++k) row[3 * a + k] += update[k * plane + a];
    }
  }

  static void rowsOf(const PanelSet& set, int step, BlockRange rows, const float* own, float* work) {
    forwardRows(set, set.steps[step], rows, own, work);
  }

  static void tilesOf(const PanelSet& set, int step, BlockRange tiles, const float* work, float* vector) {
    backwardTiles(set, set.steps[step], tiles, work, vector);
  }

  static PanelKernels functions() { return {forward, backward, stepOfThree, rowsOf, tilesOf}; }
};

}  // namespace

PanelKernels VIBE_KERNEL(halfKernels)() {
  return PanelKernel<KernelSets::VIBE_KERNEL_SET, std::uint16_t>::functions();
}

PanelKernels VIBE_KERNEL(floatKernels)() {
  return PanelKernel<KernelSets::VIBE_KERNEL_SET, float>::functions();
}

}  // namespace vibe

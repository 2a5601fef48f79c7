#pragma once

#include <sys/mman.h>

#include <cstdint>
#include <cstdlib>
#include <memory>
#include <new>

namespace vibe {

/// Zero-initialised memory, aligned to cache lines and padded by one line at its end. Large buffers request huge pages:
/// a factor is streamed through, and the hardware prefetchers stop at page boundaries.
template <class Number>
class AlignedBuffer {
 public:
  void resize(std::int64_t count) {
    const std::size_t alignment = count * sizeof(Number) < kHugePage ? kLine : kHugePage;
    const std::size_t bytes = (count * sizeof(Number) + 2 * kLine - 1) / kLine * kLine;
    void* memory = nullptr;
    if (posix_memalign(&memory, alignment, bytes) != 0) throw std::bad_alloc();
    memory_.reset(static_cast<Number*>(memory));
    if (alignment == kHugePage)
      madvise(memory_.get(), bytes, MADV_HUGEPAGE);  // a hint; its return value does not matter
    size_ = count;
    std::uninitialized_fill_n(memory_.get(), bytes / sizeof(Number), Number());
  }
  /// At least this many numbers; those that are there already keep their values where it is large enough.
  void grow(std::int64_t count) {
    if (size_ < count) resize(count);
  }
  std::int64_t size() const { return size_; }
  Number* data() { return memory_.get(); }
  const Number* data() const { return memory_.get(); }

 private:
  struct Free {
    void operator()(Number* memory) const { std::free(memory); }
  };
  static constexpr std::size_t kLine = 64, kHugePage = std::size_t(1) << 21;
  std::unique_ptr<Number, Free> memory_;
  std::int64_t size_ = 0;
};

}  // namespace vibe

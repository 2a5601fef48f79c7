#pragma once

#include <cerrno>
#include <cstddef>
#include <cstdlib>

/// Counts the memory that the calling thread asks for, by new, by Eigen or otherwise. Weak symbols, so
/// that several sources of a program may include this. With the GNU C library; sanitizers bring their own memory and
/// count nothing.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || !defined(__GLIBC__)
#define VIBE_COUNTS_ALLOCATIONS 0
#else
#define VIBE_COUNTS_ALLOCATIONS 1
#endif

namespace vibe::test {

/// Requests of the calling thread since it began; set it to 0 before what is to be counted.
inline thread_local long allocations = 0;

}  // namespace vibe::test

#if VIBE_COUNTS_ALLOCATIONS
extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* old, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);

[[gnu::weak]] void* malloc(std::size_t size) noexcept {
  ++vibe::test::allocations;
  return __libc_malloc(size);
}
[[gnu::weak]] void* calloc(std::size_t count, std::size_t size) noexcept {
  ++vibe::test::allocations;
  return __libc_calloc(count, size);
}
[[gnu::weak]] void* realloc(void* old, std::size_t size) noexcept {
  ++vibe::test::allocations;
  return __libc_realloc(old, size);
}
[[gnu::weak]] void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept {
  ++vibe::test::allocations;
  return __libc_memalign(alignment, size);
}
[[gnu::weak]] int posix_memalign(void** out, std::size_t alignment, std::size_t size) noexcept {
  ++vibe::test::allocations;
  *out = __libc_memalign(alignment, size);
  return *out == nullptr ? ENOMEM : 0;
}
}
#endif

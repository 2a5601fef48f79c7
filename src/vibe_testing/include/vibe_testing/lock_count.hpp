#pragma once

#include <dlfcn.h>
#include <pthread.h>

/// Counts the mutexes that the calling thread locks. The symbol is weak, so that several sources of a program may
/// include this. With the GNU C library; sanitizers bring functions of their own and count nothing.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || !defined(__GLIBC__)
#define VIBE_COUNTS_LOCKS 0
#else
#define VIBE_COUNTS_LOCKS 1
#endif

namespace vibe::test {

inline thread_local long locks = 0;  ///< taken by the calling thread since it began; stays 0 unless VIBE_COUNTS_LOCKS

}  // namespace vibe::test

#if VIBE_COUNTS_LOCKS
extern "C" [[gnu::weak]] int pthread_mutex_lock(pthread_mutex_t* mutex) noexcept {
  using Lock = int (*)(pthread_mutex_t*);
  static const Lock lock = reinterpret_cast<Lock>(::dlsym(RTLD_NEXT, "pthread_mutex_lock"));
  ++vibe::test::locks;
  return lock(mutex);
}
#endif

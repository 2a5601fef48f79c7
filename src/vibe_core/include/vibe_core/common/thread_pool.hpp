#pragma once
#include <functional>
#include <memory>

namespace vibe {

/// Threads for the parallel parts of a step. The results of a step do not depend on their number.
class ThreadPool {
 public:
  /// @param threads  number of threads in parallelFor(), 1 or more; 1 uses the calling thread only
  explicit ThreadPool(int threads = 1);
  ~ThreadPool();
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  int threads() const { return threads_; }  ///< as many as the constructor was given, the calling one included

  /// Calls body(first, last) for consecutive pieces of [0, count) with at most `grain` items each. The pieces do not
  /// depend on the number of threads.
  void parallelFor(int count, int grain, const std::function<void(int first, int last)>& body);

 private:
  struct Arena;
  int threads_;
  std::unique_ptr<Arena> arena_;  // null with one thread
};

}  // namespace vibe

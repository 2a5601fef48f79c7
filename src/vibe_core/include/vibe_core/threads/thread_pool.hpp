#pragma once
#include <atomic>
#include <memory>

namespace vibe {

/// Threads for the parallel parts of a step. The results of a step do not depend on their number. One thread at a time
/// calls parallelFor(). Between parts that follow each other within a fraction of a millisecond the others stay awake.
class ThreadPool {
 public:
  /// @param threads  number of threads in parallelFor(), 1 or more; 1 uses the calling thread only
  explicit ThreadPool(int threads = 1);
  ~ThreadPool();
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  int threads() const { return threads_; }  ///< as many as the constructor was given, the calling one included

  /// Calls body(first, last) for consecutive pieces of [0, count) with at most `grain` items each. The pieces do not
  /// depend on the number of threads. Asks for no memory. A body throws nothing if there are several.
  template <class Body>
  void parallelFor(int count, int grain, const Body& body) {
    run({count, grain, &body,
         [](const void* of, int first, int last) { (*static_cast<const Body*>(of))(first, last); }});
  }

  /// Waits until a count is 0, for a piece that needs what pieces before it do.
  static void await(const std::atomic<int>& left);

 private:
  struct Job {
    int count = 0, grain = 1;
    const void* body = nullptr;
    void (*call)(const void* body, int first, int last) = nullptr;
    int pieces() const { return (count + grain - 1) / grain; }
    void runPiece(int k) const { call(body, k * grain, (k + 1) * grain < count ? (k + 1) * grain : count); }
  };
  class Crew;
  void run(const Job& job);

  int threads_;
  std::unique_ptr<Crew> crew_;  // null with one thread
};

}  // namespace vibe

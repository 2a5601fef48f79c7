#include "vibe_core/common/thread_pool.hpp"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>

namespace vibe {

struct ThreadPool::Arena {
  explicit Arena(int threads) : arena(threads) {}
  tbb::task_arena arena;
};

ThreadPool::ThreadPool(int threads)
    : threads_(std::max(threads, 1)), arena_(threads_ > 1 ? std::make_unique<Arena>(threads_) : nullptr) {}

ThreadPool::~ThreadPool() = default;

void ThreadPool::parallelFor(int count, int grain, const std::function<void(int, int)>& body) {
  if (!arena_) {
    for (int first = 0; first < count; first += grain) body(first, std::min(first + grain, count));
    return;
  }
  arena_->arena.execute([&] {
    tbb::parallel_for(
        tbb::blocked_range<int>(0, (count + grain - 1) / grain, 1),
        [&](const tbb::blocked_range<int>& pieces) {
          for (int piece = pieces.begin(); piece < pieces.end(); ++piece)
            body(piece * grain, std::min((piece + 1) * grain, count));
        },
        tbb::simple_partitioner());
  });
}

}  // namespace vibe

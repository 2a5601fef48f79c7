#include "vibe_core/common/thread_pool.hpp"

#include <algorithm>
#include <cerrno>
#include <utility>

#include <pthread.h>
#include <sched.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "common/background_worker.hpp"

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

namespace {

void await(sem_t& semaphore) {
  while (::sem_wait(&semaphore) != 0 && errno == EINTR) {
  }
}

}  // namespace

BackgroundWorker::BackgroundWorker(std::function<void()> job) : job_(std::move(job)) {
  ::sem_init(&go_, 0, 0);
  ::sem_init(&done_, 0, 0);
}

BackgroundWorker::~BackgroundWorker() {
  wait();
  ends_ = true;
  if (thread_.joinable()) {
    ::sem_post(&go_);
    thread_.join();
  }
  ::sem_destroy(&go_);
  ::sem_destroy(&done_);
}

void BackgroundWorker::start() {
  finish();
  if (!thread_.joinable()) thread_ = std::thread([this] { run(); });
  givePriority(false);
  busy_ = true;
  ::sem_post(&go_);
}

void BackgroundWorker::finish() {
  wait();
  if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
}

void BackgroundWorker::wait() {
  if (!busy_) return;
  if (::sem_trywait(&done_) != 0) {
    givePriority(true);
    await(done_);
  }
  busy_ = false;
}

void BackgroundWorker::run() {
  while (true) {
    await(go_);
    if (ends_) return;
    try {
      job_();
    } catch (...) {
      error_ = std::current_exception();
    }
    ::sem_post(&done_);
  }
}

// A thread without real-time priority gives none, but takes away what the worker has from an earlier one.
// @param own  the priority of the calling thread, else the lowest
void BackgroundWorker::givePriority(bool own) {
  int policy = SCHED_OTHER;
  sched_param parameters{};
  if (::pthread_getschedparam(::pthread_self(), &policy, &parameters) != 0) return;
  if (policy != SCHED_OTHER && !own) parameters.sched_priority = ::sched_get_priority_min(policy);
  if (parameters.sched_priority == given_) return;
  if (::pthread_setschedparam(thread_.native_handle(), policy, &parameters) == 0) given_ = parameters.sched_priority;
}

}  // namespace vibe

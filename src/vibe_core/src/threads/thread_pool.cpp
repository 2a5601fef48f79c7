#include "vibe_core/threads/thread_pool.hpp"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <deque>
#include <thread>
#include <utility>

#include <pthread.h>
#include <sched.h>

#include "threads/background_worker.hpp"

namespace vibe {

namespace {

using Clock = std::chrono::steady_clock;

// Time without work until a thread sleeps. Design choice: parts of a step follow each other within it.
constexpr std::chrono::microseconds kAwake{300};
// Time for what others have begun until the caller sleeps between looks. Design choice: far above what a piece takes;
// the other has been kept from the processor, maybe by the caller itself.
constexpr std::chrono::milliseconds kPatience{5};
constexpr std::chrono::microseconds kNap{50};

// Does not give the processor away: what comes then may keep it for milliseconds.
void pause() {
#if defined(__x86_64__)
  __builtin_ia32_pause();
#else
  std::this_thread::yield();
#endif
}

void awaitPost(sem_t& semaphore) {
  while (::sem_wait(&semaphore) != 0 && errno == EINTR) {
  }
}

template <class Done>
void awaitOthers(const Done& done) {
  if (done()) return;
  const Clock::time_point begin = Clock::now();
  while (!done())
    if (Clock::now() - begin < kPatience)
      pause();
    else
      std::this_thread::sleep_for(kNap);
}

}  // namespace

// The calling thread puts up a job, works on it as the others do, and waits for what they have begun: it has no need of
// a thread that sleeps or that another program keeps from the processor.
class ThreadPool::Crew {
 public:
  explicit Crew(int helpers) {
    CPU_ZERO(&allowed_);
    ::sched_getaffinity(0, sizeof allowed_, &allowed_);
    for (int k = 0; k < helpers; ++k) helpers_.emplace_back();
    for (Helper& helper : helpers_) helper.thread = std::thread([this, &helper] { help(helper); });
  }
  ~Crew() {
    ends_ = true;
    for (Helper& helper : helpers_) {
      wake(helper);
      helper.thread.join();
    }
  }

  void run(const Job& job) {
    job_ = &job;
    done_.store(0, std::memory_order_relaxed);
    const auto pieces = static_cast<std::uint32_t>(job.pieces());
    left_.store(((left_.load(std::memory_order_relaxed) >> 32) + 1) << 32 | pieces);
    for (Helper& helper : helpers_) wake(helper);
    while (takePiece()) {
    }
    awaitOthers([&] { return done_.load(std::memory_order_acquire) == pieces; });
  }

 private:
  struct Helper {
    Helper() { ::sem_init(&go, 0, 0); }
    ~Helper() { ::sem_destroy(&go); }
    std::atomic<bool> sleeps{false};
    sem_t go;
    int avoids = -1;  // processor
    std::thread thread;
  };

  void wake(Helper& helper) const {
    if (!helper.sleeps.exchange(false)) return;
    placeElsewhere(helper);
    ::sem_post(&helper.go);
  }

  // Some kernels wake a thread on the processor of the one that wakes it, and move it away milliseconds later.
  void placeElsewhere(Helper& helper) const {
    const int here = ::sched_getcpu();
    if (here < 0 || here == helper.avoids || CPU_COUNT(&allowed_) < 2 || CPU_ISSET(here, &allowed_) == 0) return;
    cpu_set_t elsewhere = allowed_;
    CPU_CLR(here, &elsewhere);
    if (::pthread_setaffinity_np(helper.thread.native_handle(), sizeof elsewhere, &elsewhere) == 0)
      helper.avoids = here;
  }

  bool hasWork() const { return static_cast<std::uint32_t>(left_.load()) != 0 || ends_; }

  // A job stays as long as a piece of it has not been done.
  bool takePiece() {
    std::uint64_t left = left_.load(std::memory_order_acquire);
    do {
      if (static_cast<std::uint32_t>(left) == 0) return false;
    } while (!left_.compare_exchange_weak(left, left - 1, std::memory_order_acq_rel));
    const Job& job = *job_;
    job.runPiece(job.pieces() - static_cast<int>(static_cast<std::uint32_t>(left)));
    done_.fetch_add(1, std::memory_order_release);
    return true;
  }

  void help(Helper& self) {
    Clock::time_point last = Clock::now();
    while (!ends_) {
      if (takePiece()) {
        last = Clock::now();
      } else if (Clock::now() - last < kAwake) {
        pause();
      } else {
        sleep(self);
        last = Clock::now();
      }
    }
  }

  void sleep(Helper& self) const {
    self.sleeps = true;
    if (!hasWork() || !self.sleeps.exchange(false)) awaitPost(self.go);
  }

  const Job* job_ = nullptr;
  std::atomic<std::uint64_t> left_{0};  // number of the job, then how many of its pieces nobody has taken
  std::atomic<std::uint32_t> done_{0};
  std::atomic<bool> ends_{false};
  cpu_set_t allowed_;
  std::deque<Helper> helpers_;
};

ThreadPool::ThreadPool(int threads)
    : threads_(std::max(threads, 1)), crew_(threads_ > 1 ? std::make_unique<Crew>(threads_ - 1) : nullptr) {}

ThreadPool::~ThreadPool() = default;

void ThreadPool::await(const std::atomic<int>& left) {
  awaitOthers([&] { return left.load(std::memory_order_acquire) == 0; });
}

void ThreadPool::run(const Job& job) {
  if (crew_ && job.pieces() > 1) return crew_->run(job);
  for (int k = 0; k < job.pieces(); ++k) job.runPiece(k);
}

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
    awaitPost(done_);
  }
  busy_ = false;
}

void BackgroundWorker::run() {
  while (true) {
    awaitPost(go_);
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

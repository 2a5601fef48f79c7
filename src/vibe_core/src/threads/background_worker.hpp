#pragma once
#include <semaphore.h>

#include <exception>
#include <functional>
#include <thread>

namespace vibe {

/// One thread that works ahead for steps to come, on one job at a time. Begin and end of a job ask for no memory and
/// take no lock, so that the thread that steps may call them. Of that thread's real-time priority, if it has one, the
/// worker gets the lowest: it must not take the processor just when the next step is due. While a step waits for the
/// job, the worker has the priority of the waiting thread.
///
/// All functions are called from one thread.
class BackgroundWorker {
 public:
  /// @param job  what start() does each time; it finds its task where the caller has put it
  explicit BackgroundWorker(std::function<void()> job);
  /// Waits for the end of the job.
  ~BackgroundWorker();
  BackgroundWorker(const BackgroundWorker&) = delete;
  BackgroundWorker& operator=(const BackgroundWorker&) = delete;

  /// Begins the job, after the end of the one before. The first call makes the thread.
  /// @throws what the job before has thrown
  void start();
  /// Waits for the end of the job, if one was begun. @throws what it has thrown
  void finish();

 private:
  std::function<void()> job_;
  std::exception_ptr error_;
  bool busy_ = false, ends_ = false;
  int given_ = 0;  // real-time priority of the worker, as set last; 0: none
  sem_t go_, done_;
  std::thread thread_;

  void run();
  void wait();
  void givePriority(bool own);
};

}  // namespace vibe

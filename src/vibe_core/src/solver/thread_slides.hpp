#pragma once

#include <array>
#include <vector>

#include "solver/contact_problem.hpp"
#include "suture/thread_run.hpp"

namespace vibe {

/// Tensions and slides of all threads of a step together: each as slideThread() has it, but that its segments cannot
/// become shorter than a fold of the wall. A segment gives away at most `spare` of its thread. One that has given it
/// away keeps its length, and what is drawn through it passes from its one neighbour to the other against the friction
/// of both eyelets.
///
/// Which eyelets stick, which let thread slide, and which parts are slack is guessed from the last solution; all
/// tensions follow from one dense system, and what contradicts them changes the guess. Only where that does not end,
/// threads are solved one after the other with slideThread(): none of 4,800 problems of a sixth set that is cinched,
/// which took 1.7 to 2.5 guesses. The dense factor is kept while the guess stays. Keeps its memory.
class ThreadSlides {
 public:
  /// @param guesses  that are tried in each problem; 0: threads are always solved one after the other
  explicit ThreadSlides(int guesses = 12) : guesses_(guesses) {}
  /// Forgets the threads and all guesses.
  void clear();
  void addThread();
  /// Of the last thread.
  /// @param capstan  largest ratio of the tensions of this segment and the next one of the thread, 1 or more [1]
  /// @param spare    thread that may slide out of it, 0 or more [m]
  void addSegment(double capstan, double spare);
  /// Another compliance between all segments, to be set by compliance() (lower and upper part).
  void beginCompliance();
  /// @see slideThread() [m/N]
  double& compliance(int i, int j) { return compliance_[at(i, j)]; }

  int size() const { return static_cast<int>(capstan_.size()); }
  /// @param lack  of each segment without tension [m]
  /// @returns sweeps over the threads: 1, or more where they were solved one after the other
  int solve(const double* lack);
  /// Of the last solution.
  double tension(int segment) const { return tension_[index(segment)]; }  ///< 0 or more [N]
  /// Through the eyelet behind a segment, to the next one; 0 for the last of a thread [m].
  double slide(int segment) const { return slide_[index(segment)]; }
  /// Thread that slid out of a segment into others [m].
  double lost(int segment) const;
  /// Problems since clear() in which the guess did not end.
  int failures() const { return failures_; }

 private:
  static constexpr int kProblems = 4;
  static constexpr int kNone = -1;
  struct Thread {
    int first = 0, count = 0;
  };
  /// What acts in one of the problems that are solved one after the other, each with more exhausted segments.
  struct Problem {
    bool known = false, factored = false;
    std::vector<char> exhausted;         // per segment
    std::vector<int> next;               // per segment: the next of its thread that still slides
    std::vector<double> factor;          // of the eyelets between
    std::vector<int> heads;              // first segments of runs, within which thread may slide
    std::vector<detail::Eyelet> eyelet;  // per segment: of the eyelets between it and the next
    std::vector<char> tight;             // per segment: its run has tension
    int groups = 0;                      // of segments that slide into each other
    std::vector<int> group;              // per segment
    std::vector<double> ratio;           // per segment: tension over that of the first of its group
    DenseLu lu;
  };
  static std::size_t index(int i) { return static_cast<std::size_t>(i); }
  std::size_t at(int i, int j) const { return index(i) * index(size()) + index(j); }
  static bool holds(const Problem& p, int k) {
    return p.next[index(k)] == kNone || p.factor[index(k)] >= kHoldingFactor;
  }

  void prepare(int number);
  void link(Problem& p) const;
  void guess(int number);
  bool settle(Problem& p);
  void groupSegments(Problem& p) const;
  bool factor(Problem& p);
  void findTensions(Problem& p);
  bool isRight(Problem& p);
  bool runIsRight(Problem& p, int head, double force, double length);
  bool eyeletIsRight(Problem& p, int k, double force, double length) const;
  double ownPull(const Problem& p, int head) const;
  void setTight(Problem& p, int head, bool tight);
  void dealOut(const Problem& p, int head);
  int solveOneByOne(Problem& p);
  double solveThread(const Problem& p, const Thread& thread);
  void guessFromSolution(Problem& p);
  void addSlides(const Problem& p);
  bool exhaust();
  void giveAway(const Thread& thread, int segment, double amount, int direction);

  int guesses_;
  DenseRowKernels kernels_ = denseRowKernels();
  std::vector<Thread> threads_;
  std::vector<double> capstan_, spare_;  // per segment
  std::vector<double> compliance_;       // row after row
  std::array<Problem, kProblems> problem_;
  std::vector<char> exhausted_;
  std::vector<double> lack_, left_, tension_, right_;
  std::vector<double> through_;        // per segment: slide to the next that still slides
  std::vector<double> given_, slide_;  // per segment, through the eyelet behind it; given: by exhausted segments
  std::vector<double> run_factor_, run_slack_, run_slide_;
  int failures_ = 0;
  // of one thread, those that still slide first
  std::vector<int> order_;
  detail::SegmentVector thread_lack_, thread_factor_;
  detail::SegmentMatrix thread_compliance_;
  ThreadSlide thread_slide_;
};

}  // namespace vibe

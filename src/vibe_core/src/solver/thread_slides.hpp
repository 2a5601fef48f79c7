#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "solver/contact_problem.hpp"
#include "suture/capstan.hpp"

namespace vibe {

/// Tensions and slides of all threads of a step together. A thread is weightless and has segments between eyelets with
/// Coulomb friction. With
///   slack_k = slide_{k-1} - slide_k - lack_k + (C tension)_k,
/// slack and tension are 0 or more and never both above 0. The tensions at an eyelet differ at most by its capstan
/// factor. Thread slides only where they differ by exactly this factor, and towards the larger one. A slack thread
/// slides freely: a part that lacks thread takes it from the parts with the least friction in between. The ends are
/// fixed. The solution is unique if C is diagonal.
///
/// A segment cannot become shorter than a fold of the wall: it gives away at most `spare` of its thread. One that has
/// given it away keeps its length, and what is drawn through it passes from its one neighbour to the other against the
/// friction of both eyelets.
///
/// Which eyelets stick, which let thread slide, and which parts are slack is guessed from the last solution; all
/// tensions follow from one dense system, and what contradicts them changes the guess: at first all of it at once, and
/// where that runs in a circle the first of it alone (Judice and Pires, Comput Oper Res 21:587, 1994, after Murty). All
/// of 4,800 problems of a sixth set that is cinched took 1.7 to 2.5 guesses. Of 10,000 random threads, 47 ran in a
/// circle, and none took more than 40 guesses. The dense factor is kept while the guess stays. Keeps its memory.
class ThreadSlides {
 public:
  static constexpr int kGuesses = 100;
  /// @param guesses  in each problem, at most
  explicit ThreadSlides(int guesses = kGuesses) : guesses_(guesses) {}
  /// Forgets the threads and all guesses.
  void clear();
  void addThread();
  /// Of the last thread.
  /// @param capstan  largest ratio of the tensions of this segment and the next one of the thread, 1 or more
  /// @param spare    thread that may slide out of it, 0 or more [m]
  void addSegment(double capstan, double spare);
  /// Another compliance between all segments, to be set by compliance() (lower and upper part).
  void beginCompliance();
  /// How much the pull of segment j shortens the path of segment i, plus the stretch of the thread where i = j [m/N].
  double& compliance(int i, int j) { return compliance_[at(i, j)]; }

  int size() const { return static_cast<int>(capstan_.size()); }
  /// @param lack  path length of each segment without tension, minus its thread length; below 0: slack [m]
  void solve(const double* lack);
  /// Of the last solution.
  double tension(int segment) const { return tension_[index(segment)]; }  ///< 0 or more [N]
  /// Through the eyelet behind a segment, to the next one; 0 for the last of a thread [m].
  double slide(int segment) const { return slide_[index(segment)]; }
  /// Thread that slid out of a segment into others [m].
  double lost(int segment) const;
  /// By how much the worst condition is missed: 0, or more where no guess was right. Then tensions and slides are those
  /// of the guess that missed least, with no tension below 0 and no slide against what friction allows [m].
  double violation() const { return violation_; }

 private:
  static constexpr int kProblems = 4;
  static constexpr int kNone = -1;
  /// State of an eyelet. Smooth ones (factor 1) let thread slide in both directions.
  enum class Eyelet : std::int8_t { Backward = -1, Sticks = 0, Forward = 1, Smooth = 2 };
  struct Thread {
    int first = 0, count = 0;
  };
  /// What is guessed.
  struct Guess {
    std::vector<Eyelet> eyelet;  // per segment: of the eyelets between it and the next
    std::vector<char> tight;     // per segment: its run has tension
  };
  /// What acts in one of the problems that are solved one after the other, each with more exhausted segments.
  struct Problem : Guess {
    bool known = false, factored = false;
    std::vector<char> exhausted;  // per segment
    std::vector<int> next;        // per segment: the next of its thread that still slides
    std::vector<double> factor;   // of the eyelets between
    std::vector<int> heads;       // first segments of runs, within which thread may slide
    int groups = 0;               // of segments that slide into each other
    std::vector<int> group;       // per segment
    std::vector<double> ratio;    // per segment: tension over that of the first of its group
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
  void settle(Problem& p);
  void takeBest(Problem& p, double missed);
  void groupSegments(Problem& p) const;
  bool factor(Problem& p);
  void findTensions(Problem& p);
  bool isRight(Problem& p);
  bool runIsRight(Problem& p, int head, double force, double length);
  bool eyeletIsRight(Problem& p, int k, double force, double length);
  bool mayChange(const Problem& p) const { return together_ || p.factored; }
  double ownPull(const Problem& p, int head) const;
  void setTight(Problem& p, int head, bool tight);
  void dealOut(const Problem& p, int head);
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
  std::vector<int> run_;               // its segments
  std::vector<double> run_factor_, run_slack_;
  bool together_ = true;               // all that contradicts a guess changes, otherwise the first of it
  double missed_ = 0, violation_ = 0;  // of this guess; of the solution [m]
  Guess tried_, best_;
};

}  // namespace vibe

#include "solver/thread_slides.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vibe {

namespace {

using detail::Eyelet;

// A condition is met to this share of the largest length or tension.
constexpr double kMet = 1e-9;
// Sweeps over threads that are solved one after the other. Design choice: threads affect each other little; what a
// sweep more would change slides in the next iteration.
constexpr int kThreadSweeps = 30;
// They end when no tension moves its segment farther than this. Design choice: a hundredth of what can be seen [m].
constexpr double kThreadMove = 1e-7;
// Rounding of a slide [m].
constexpr double kSpareRounding = 1e-10;

}  // namespace

void ThreadSlides::clear() {
  threads_.clear();
  capstan_.clear(), spare_.clear();
  for (Problem& p : problem_) p.known = p.factored = false;
  failures_ = 0;
}

void ThreadSlides::addThread() {
  Thread thread;
  thread.first = size();
  threads_.push_back(thread);
}

void ThreadSlides::addSegment(double capstan, double spare) {
  ++threads_.back().count;
  capstan_.push_back(capstan);
  spare_.push_back(spare);
}

void ThreadSlides::beginCompliance() {
  compliance_.resize(index(size()) * index(size()));
  for (Problem& p : problem_) p.factored = false;
}

double ThreadSlides::lost(int segment) const {
  return slide(segment) - (segment > 0 ? slide(segment - 1) : 0);
}

int ThreadSlides::solve(const double* lack) {
  const std::size_t m = capstan_.size();
  lack_.assign(lack, lack + m);
  tension_.assign(m, 0.0);
  exhausted_.assign(m, 0);
  given_.assign(m, 0.0);
  through_.assign(m, 0.0);
  int sweeps = 1;
  for (int number = 0; number < kProblems; ++number) {
    prepare(number);
    Problem& p = problem_[index(number)];
    if (!settle(p)) {
      ++failures_;
      sweeps += solveOneByOne(p);
    }
    addSlides(p);
    if (!exhaust()) break;
  }
  for (double& tension : tension_) tension = std::max(0.0, tension);
  return sweeps;
}

// What acts is guessed: the same as when this problem was solved last, or as in the problem before it.
void ThreadSlides::prepare(int number) {
  Problem& p = problem_[index(number)];
  if (p.known && p.exhausted == exhausted_) return;
  p.known = true;
  p.factored = false;
  p.exhausted = exhausted_;
  link(p);
  guess(number);
}

// Thread passes an exhausted segment as if its two eyelets were one.
void ThreadSlides::link(Problem& p) const {
  const std::size_t m = capstan_.size();
  p.next.assign(m, kNone);
  p.factor.assign(m, std::numeric_limits<double>::infinity());
  p.heads.clear();
  for (const Thread& thread : threads_) {
    int last = kNone;
    double product = 1;
    for (int k = thread.first; k < thread.first + thread.count; ++k) {
      const bool slides = p.exhausted[index(k)] == 0;
      if (slides && last != kNone) {
        p.next[index(last)] = k;
        p.factor[index(last)] = product;
      }
      if (!slides || last == kNone || product >= kHoldingFactor) p.heads.push_back(k);
      if (slides) last = k, product = 1;
      product *= capstan_[index(k)];
    }
  }
}

void ThreadSlides::guess(int number) {
  Problem& p = problem_[index(number)];
  const std::size_t m = capstan_.size();
  if (number > 0) {
    p.eyelet = problem_[index(number - 1)].eyelet;
    p.tight = problem_[index(number - 1)].tight;
  } else {
    p.eyelet.assign(m, Eyelet::Sticks);
    p.tight.assign(m, 0);
    for (const int head : p.heads) {
      double sum = lack_[index(head)];
      for (int k = head; !holds(p, k);) sum += lack_[index(k = p.next[index(k)])];
      setTight(p, head, sum > 0);
    }
  }
  for (std::size_t k = 0; k < m; ++k) {
    const bool smooth = p.factor[k] < detail::kSmoothFactor;
    if (smooth) p.eyelet[k] = Eyelet::Smooth;
    if ((!smooth && p.eyelet[k] == Eyelet::Smooth) || p.factor[k] >= kHoldingFactor) p.eyelet[k] = Eyelet::Sticks;
  }
}

void ThreadSlides::setTight(Problem& p, int head, bool tight) {
  p.factored = false;
  p.tight[index(head)] = tight ? 1 : 0;
  for (int k = head; !holds(p, k);) p.tight[index(k = p.next[index(k)])] = tight ? 1 : 0;
}

// @returns whether a guess meets all conditions
bool ThreadSlides::settle(Problem& p) {
  for (int guess = 0; guess < guesses_; ++guess) {
    if (!p.factored && !factor(p)) return false;
    findTensions(p);
    if (isRight(p)) {
      for (const int head : p.heads)
        if (p.tight[index(head)] == 0) dealOut(p, head);
      return true;
    }
    if (p.factored) return false;  // nothing to change
  }
  return false;
}

void ThreadSlides::groupSegments(Problem& p) const {
  const std::size_t m = capstan_.size();
  p.group.assign(m, kNone);
  p.ratio.assign(m, 0.0);
  p.groups = 0;
  for (const int head : p.heads) {
    if (p.tight[index(head)] == 0) continue;
    int k = head;
    p.group[index(k)] = p.groups++;
    p.ratio[index(k)] = 1;
    while (!holds(p, k)) {
      const std::size_t from = index(k), to = index(k = p.next[index(k)]);
      const bool slides = p.eyelet[from] != Eyelet::Sticks;
      p.group[to] = slides ? p.group[from] : p.groups++;
      p.ratio[to] = slides ? p.ratio[from] : 1;
      if (p.eyelet[from] == Eyelet::Forward) p.ratio[to] *= p.factor[from];
      if (p.eyelet[from] == Eyelet::Backward) p.ratio[to] /= p.factor[from];
    }
  }
}

// The tensions of segments that slide into each other have known ratios, and the sum of what they lack is independent
// of the slide.
bool ThreadSlides::factor(Problem& p) {
  groupSegments(p);
  p.lu.resize(p.groups);
  for (int i = 0; i < size(); ++i) {
    if (p.group[index(i)] == kNone) continue;
    double* const row = p.lu.row(p.group[index(i)]);
    const double* const from = &compliance_[at(i, 0)];
    for (std::size_t j = 0; j < capstan_.size(); ++j)
      if (p.group[j] != kNone) row[p.group[j]] += from[j] * p.ratio[j];
  }
  return p.factored = p.lu.factor();
}

void ThreadSlides::findTensions(Problem& p) {
  const std::size_t m = capstan_.size();
  right_.assign(index(p.groups), 0.0);
  for (std::size_t k = 0; k < m; ++k)
    if (p.group[k] != kNone) right_[index(p.group[k])] += lack_[k];
  p.lu.solve(right_.data());
  for (std::size_t k = 0; k < m; ++k) tension_[k] = p.group[k] == kNone ? 0 : p.ratio[k] * right_[index(p.group[k])];
  left_ = lack_;
  kernels_.subtractRows(left_.data(), size(), compliance_.data(), tension_.data(), size());
  through_.assign(m, 0.0);
  for (const int head : p.heads) {
    double through = 0;
    for (int k = head; !holds(p, k); k = p.next[index(k)]) {
      const bool linked = p.group[index(k)] != kNone && p.group[index(k)] == p.group[index(p.next[index(k)])];
      through_[index(k)] = through = linked ? through - left_[index(k)] : 0;
    }
  }
}

// Changes the guess where it contradicts what follows from it.
bool ThreadSlides::isRight(Problem& p) {
  double force = 0, length = 0;
  for (std::size_t k = 0; k < capstan_.size(); ++k) {
    force = std::max(force, std::abs(tension_[k]));
    length = std::max(length, std::abs(lack_[k]) + std::abs(lack_[k] - left_[k]));
  }
  bool right = true;
  for (const int head : p.heads) right = runIsRight(p, head, kMet * force, kMet * length) && right;
  return right;
}

bool ThreadSlides::runIsRight(Problem& p, int head, double force, double length) {
  double least = tension_[index(head)], sum = left_[index(head)];
  for (int k = head; !holds(p, k);) {
    k = p.next[index(k)];
    least = std::min(least, tension_[index(k)]);
    sum += left_[index(k)];
  }
  if (p.tight[index(head)] == 0) {
    if (sum <= length) return true;
    setTight(p, head, true);
    return false;
  }
  bool right = least >= -force;
  if (!right && !(ownPull(p, head) > 0)) {
    setTight(p, head, false);
    return false;
  }
  for (int k = head; !holds(p, k); k = p.next[index(k)]) right = eyeletIsRight(p, k, force, length) && right;
  return right;
}

// How much a run pulls itself shorter.
double ThreadSlides::ownPull(const Problem& p, int head) const {
  double sum = 0;
  for (int i = head;; i = p.next[index(i)]) {
    for (int j = head;; j = p.next[index(j)]) {
      sum += compliance_[at(i, j)] * tension_[index(j)];
      if (holds(p, j)) break;
    }
    if (holds(p, i)) break;
  }
  return sum;
}

bool ThreadSlides::eyeletIsRight(Problem& p, int k, double force, double length) const {
  const double factor = p.factor[index(k)], here = tension_[index(k)], there = tension_[index(p.next[index(k)])];
  Eyelet& eyelet = p.eyelet[index(k)];
  Eyelet better = eyelet;
  if (eyelet == Eyelet::Sticks && !(factor * here - there >= -force * factor)) better = Eyelet::Forward;
  if (eyelet == Eyelet::Sticks && !(factor * there - here >= -force * factor)) better = Eyelet::Backward;
  if (eyelet == Eyelet::Forward && !(through_[index(k)] >= -length)) better = Eyelet::Sticks;
  if (eyelet == Eyelet::Backward && !(through_[index(k)] <= length)) better = Eyelet::Sticks;
  if (better == eyelet) return true;
  eyelet = better;
  p.factored = false;
  return false;
}

void ThreadSlides::dealOut(const Problem& p, int head) {
  run_factor_.clear(), run_slack_.clear(), run_slide_.clear();
  for (int k = head;; k = p.next[index(k)]) {
    run_slack_.push_back(-left_[index(k)]);
    if (holds(p, k)) break;
    run_factor_.push_back(p.factor[index(k)]);
    run_slide_.push_back(0);
  }
  detail::dealOut(static_cast<int>(run_slack_.size()), run_factor_.data(), run_slack_.data(), run_slide_.data());
  std::size_t i = 0;
  for (int k = head; !holds(p, k); k = p.next[index(k)]) through_[index(k)] = run_slide_[i++];
}

// @returns the number of sweeps
int ThreadSlides::solveOneByOne(Problem& p) {
  for (double& tension : tension_) tension = 0;
  int sweep = 0;
  for (double moved = 2 * kThreadMove; sweep < kThreadSweeps && moved > kThreadMove; ++sweep) {
    moved = 0;
    for (const Thread& thread : threads_) moved = std::max(moved, solveThread(p, thread));
  }
  guessFromSolution(p);
  return sweep;
}

// For given tensions of the others.
// @returns the largest move of a segment [m]
double ThreadSlides::solveThread(const Problem& p, const Thread& thread) {
  const int count = thread.count, end = thread.first + count;
  order_.clear();
  for (const bool exhausted : {false, true})
    for (int k = thread.first; k < end; ++k)
      if ((p.exhausted[index(k)] != 0) == exhausted) order_.push_back(k);
  thread_lack_.resize(count);
  thread_factor_.setConstant(count - 1, std::numeric_limits<double>::infinity());
  thread_compliance_.resize(count, count);
  for (int i = 0; i < count; ++i) {
    const int row = order_[index(i)];
    double lack = lack_[index(row)];
    for (int j = 0; j < size(); ++j)
      if (j < thread.first || j >= end) lack -= compliance_[at(row, j)] * tension_[index(j)];
    thread_lack_[i] = lack;
    if (i + 1 < count && p.next[index(row)] != kNone) thread_factor_[i] = p.factor[index(row)];
    for (int j = 0; j < count; ++j) thread_compliance_(i, j) = compliance_[at(row, order_[index(j)])];
  }
  slideThread(thread_lack_, thread_compliance_, thread_factor_, thread_slide_);
  double moved = 0;
  for (int i = 0; i < count; ++i) {
    double& tension = tension_[index(order_[index(i)])];
    moved = std::max(moved, std::abs(thread_slide_.tension[i] - tension) * thread_compliance_(i, i));
    tension = thread_slide_.tension[i];
    through_[index(order_[index(i)])] = i + 1 < count ? thread_slide_.slide[i] : 0;
  }
  return moved;
}

void ThreadSlides::guessFromSolution(Problem& p) {
  for (const int head : p.heads) {
    bool tight = tension_[index(head)] > 0;
    for (int k = head; !holds(p, k); k = p.next[index(k)]) {
      tight = tight || tension_[index(p.next[index(k)])] > 0;
      if (p.eyelet[index(k)] == Eyelet::Smooth) continue;
      const double through = through_[index(k)];
      p.eyelet[index(k)] = through > 0 ? Eyelet::Forward : through < 0 ? Eyelet::Backward : Eyelet::Sticks;
    }
    setTight(p, head, tight);
  }
}

void ThreadSlides::addSlides(const Problem& p) {
  slide_ = given_;
  for (int k = 0; k < size(); ++k)
    for (int e = k; p.next[index(k)] != kNone && e < p.next[index(k)]; ++e) slide_[index(e)] += through_[index(k)];
}

// Finds the segments that give away more than they have, and takes what they have.
// @returns whether there are any that were not known
bool ThreadSlides::exhaust() {
  bool found = false;
  for (const Thread& thread : threads_)
    for (int k = thread.first; k < thread.first + thread.count; ++k) {
      const double next = slide_[index(k)], before = k > thread.first ? -slide_[index(k - 1)] : 0;
      if (exhausted_[index(k)] != 0 || next + before <= spare_[index(k)] + kSpareRounding) continue;
      exhausted_[index(k)] = found = true;
      giveAway(thread, k, spare_[index(k)], next > before ? 1 : -1);
    }
  return found;
}

// To the nearest segment in this direction that can take it.
void ThreadSlides::giveAway(const Thread& thread, int segment, double amount, int direction) {
  const int first = thread.first, end = thread.first + thread.count;
  int taker = segment + direction;
  while (taker >= first && taker < end && exhausted_[index(taker)] != 0) taker += direction;
  if (taker < first || taker >= end) return;
  lack_[index(segment)] += amount;
  lack_[index(taker)] -= amount;
  for (int e = std::min(segment, taker); e < std::max(segment, taker); ++e) given_[index(e)] += direction * amount;
}

}  // namespace vibe

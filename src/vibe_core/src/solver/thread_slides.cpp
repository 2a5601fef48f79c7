#include "solver/thread_slides.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "arithmetic/elementary.hpp"

namespace vibe {

namespace {

// Guesses in which all that contradicts the last one changes. A circle that does not end by then does not end: of
// 10,000 random threads, none took 13 to 200.
constexpr int kTogether = 12;
// Capstan factors below this count as 1.
constexpr double kSmoothFactor = 1 + 1e-12;
// Rounding of a slide [m].
constexpr double kSpareRounding = 1e-10;

/// The segment with spare length from which the friction to `taker` is least; -1: none.
int nearestGiver(const std::vector<double>& factor, const std::vector<double>& slack, int taker) {
  const int count = static_cast<int>(slack.size());
  int giver = -1;
  double min = std::numeric_limits<double>::infinity();
  for (const int direction : {-1, 1}) {
    double friction = 0;
    for (int k = taker + direction; k >= 0 && k < count; k += direction) {
      friction += math::log(factor[static_cast<std::size_t>(direction < 0 ? k : k - 1)]);
      if (slack[static_cast<std::size_t>(k)] <= 0) continue;
      if (friction < min) {
        min = friction;
        giver = k;
      }
      break;
    }
  }
  return giver;
}

}  // namespace

void ThreadSlides::clear() {
  threads_.clear();
  capstan_.clear(), spare_.clear();
  violation_ = 0;
  for (Problem& p : problem_) p.known = p.factored = false;
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

void ThreadSlides::solve(const double* lack) {
  const std::size_t m = capstan_.size();
  lack_.assign(lack, lack + m);
  tension_.assign(m, 0.0);
  exhausted_.assign(m, 0);
  given_.assign(m, 0.0);
  through_.assign(m, 0.0);
  violation_ = 0;
  for (int number = 0; number < kProblems; ++number) {
    prepare(number);
    Problem& p = problem_[index(number)];
    settle(p);
    addSlides(p);
    if (!exhaust()) break;
  }
  for (double& tension : tension_) tension = std::max(0.0, tension);
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
    const bool smooth = p.factor[k] < kSmoothFactor;
    if (smooth) p.eyelet[k] = Eyelet::Smooth;
    if ((!smooth && p.eyelet[k] == Eyelet::Smooth) || p.factor[k] >= kHoldingFactor) p.eyelet[k] = Eyelet::Sticks;
  }
}

void ThreadSlides::setTight(Problem& p, int head, bool tight) {
  p.factored = false;
  p.tight[index(head)] = tight ? 1 : 0;
  for (int k = head; !holds(p, k);) p.tight[index(k = p.next[index(k)])] = tight ? 1 : 0;
}

void ThreadSlides::settle(Problem& p) {
  double least = std::numeric_limits<double>::infinity();
  bool right = false;
  for (int guess = 0; guess < guesses_ && !right; ++guess) {
    together_ = guess < kTogether;
    if (!p.factored && !factor(p)) break;
    findTensions(p);
    const Guess& made = p;
    tried_ = made;
    right = isRight(p);
    if (right || !(missed_ < least)) continue;
    least = missed_;
    best_ = tried_;
  }
  if (!right) takeBest(p, least);
  for (const int head : p.heads)
    if (p.tight[index(head)] == 0) dealOut(p, head);
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

// Slack segments have enough thread in total: those that lack length take it from the parts with the least friction in
// between.
void ThreadSlides::dealOut(const Problem& p, int head) {
  run_.clear(), run_factor_.clear(), run_slack_.clear();
  for (int k = head;; k = p.next[index(k)]) {
    run_.push_back(k);
    run_slack_.push_back(-left_[index(k)]);
    if (holds(p, k)) break;
    run_factor_.push_back(p.factor[index(k)]);
    through_[index(k)] = 0;
  }
  for (std::size_t k = 0; k < run_.size(); ++k)
    while (run_slack_[k] < 0) {
      const int taker = static_cast<int>(k), giver = nearestGiver(run_factor_, run_slack_, taker);
      if (giver < 0) break;  // rounding error
      const double amount = std::min(run_slack_[index(giver)], -run_slack_[k]);
      run_slack_[index(giver)] -= amount;
      run_slack_[k] += amount;
      for (int e = std::min(giver, taker); e < std::max(giver, taker); ++e)
        through_[index(run_[index(e)])] += giver < taker ? amount : -amount;
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

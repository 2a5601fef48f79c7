#include <algorithm>
#include <cmath>

#include "solver/thread_slides.hpp"

// Whether what follows from a guess contradicts it, and what is taken where no guess is right; thread_slides.cpp has
// what follows.

namespace vibe {

namespace {

// A condition is met to this share of the largest length or tension.
constexpr double kMet = 1e-9;

}  // namespace

// Changes the guess where it contradicts what follows from it.
bool ThreadSlides::isRight(Problem& p) {
  double force = 0, length = 0;
  missed_ = 0;
  for (std::size_t k = 0; k < capstan_.size(); ++k) {
    force = std::max(force, std::abs(tension_[k]));
    length = std::max(length, std::abs(lack_[k]) + std::abs(lack_[k] - left_[k]));
  }
  bool right = true;
  for (const int head : p.heads) right = runIsRight(p, head, kMet * force, kMet * length) && right;
  return right;
}

bool ThreadSlides::runIsRight(Problem& p, int head, double force, double length) {
  int least = head;
  double sum = left_[index(head)];
  for (int k = head; !holds(p, k);) {
    k = p.next[index(k)];
    if (tension_[index(k)] < tension_[index(least)]) least = k;
    sum += left_[index(k)];
  }
  if (p.tight[index(head)] == 0) {
    if (sum <= length) return true;
    missed_ = std::max(missed_, sum);
    if (mayChange(p)) setTight(p, head, true);
    return false;
  }
  const bool pulls = tension_[index(least)] >= -force;
  if (!pulls) missed_ = std::max(missed_, -tension_[index(least)] * compliance_[at(least, least)]);
  if (together_ && !pulls && !(ownPull(p, head) > 0)) {
    setTight(p, head, false);
    return false;
  }
  bool right = pulls;
  for (int k = head; !holds(p, k); k = p.next[index(k)]) right = eyeletIsRight(p, k, force, length) && right;
  if (!together_ && !pulls && mayChange(p)) setTight(p, head, false);  // no eyelet is to blame
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

bool ThreadSlides::eyeletIsRight(Problem& p, int k, double force, double length) {
  const double factor = p.factor[index(k)], here = tension_[index(k)], there = tension_[index(p.next[index(k)])];
  Eyelet& eyelet = p.eyelet[index(k)];
  Eyelet better = eyelet;
  const double forward = factor * here - there, backward = factor * there - here;
  if (eyelet == Eyelet::Sticks && !(forward >= -force * factor)) better = Eyelet::Forward;
  if (eyelet == Eyelet::Sticks && !(backward >= -force * factor)) better = Eyelet::Backward;
  if (eyelet == Eyelet::Forward && !(through_[index(k)] >= -length)) better = Eyelet::Sticks;
  if (eyelet == Eyelet::Backward && !(through_[index(k)] <= length)) better = Eyelet::Sticks;
  if (better == eyelet) return true;
  const double excess = -std::min(forward, backward) * compliance_[at(k, k)];
  missed_ = std::max(missed_, eyelet == Eyelet::Sticks ? excess : std::abs(through_[index(k)]));
  if (mayChange(p)) {
    eyelet = better;
    p.factored = false;
  }
  return false;
}

// Where no guess was right: the one that missed least. Without any, nothing pulls.
void ThreadSlides::takeBest(Problem& p, double missed) {
  if (std::isfinite(missed)) {
    static_cast<Guess&>(p) = best_;
    p.factored = false;
  }
  if (std::isfinite(missed) && factor(p)) {
    findTensions(p);
  } else {
    std::fill(p.tight.begin(), p.tight.end(), 0);
    tension_.assign(tension_.size(), 0.0);
    through_.assign(through_.size(), 0.0);
    left_ = lack_;
    missed = std::max(0.0, *std::max_element(lack_.begin(), lack_.end()));
  }
  violation_ = std::max(violation_, missed);
  for (std::size_t k = 0; k < tension_.size(); ++k) {
    tension_[k] = std::max(0.0, tension_[k]);
    if (p.eyelet[k] == Eyelet::Forward) through_[k] = std::max(0.0, through_[k]);
    if (p.eyelet[k] == Eyelet::Backward) through_[k] = std::min(0.0, through_[k]);
  }
}

}  // namespace vibe

// Where the bites of a set lie, and how it is sewn.
#include <algorithm>
#include <string>

#include "trainee/operator.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_core/suture/technique.hpp"
#include "vibe_core/trainee/suture_pattern.hpp"

namespace vibe {

namespace {

constexpr double kAsideStep = 1e-3;  // [m]
// Design choices, of the length of a pattern: how far it moves, so that sets keep their order, and how much of it is
// left where sets lie close; with half of it bites that miss by 2 mm are still recognised as planned.
constexpr double kAsideMost = 0.5, kShortest = 0.5;

// Margin with which a set is to be read: with 0.5 bites that miss by 4 mm take one more try in three sets, and 99 of
// 100 sets are read as planned instead of 90; design choice
constexpr double kClear = 0.5;
constexpr double kInstead = 10e-3;  // from a target at which no bite could be taken; design choice [m]

/// Distance of the centres of neighbours in a row [m].
double spacingAt(const SutureSetGoal& goal, const AnatomicalMap& map) {
  Place before = goal.centre, after = goal.centre;
  before.along = std::max(0.0, before.along - 0.5 * goal.spacing);
  after.along = std::min(1.0, after.along + 0.5 * goal.spacing);
  const double distance = (map.position(find(after, map)) - map.position(find(before, map))).norm();
  return distance * goal.spacing / (after.along - before.along);
}

/// In a row on a short organ a pattern is shorter than planned, so that its bites are beside the neighbours' threads.
double lengthOf(const SutureSetGoal& goal, const AnatomicalMap& map) {
  if (goal.spacing <= 0) return goal.length;
  return std::clamp(spacingAt(goal, map) - kBesideThread, kShortest * goal.length, goal.length);
}

/// @param moved  along the organ [m]
/// @throws Error if it does not lie on the organ
std::vector<WallPoint> laidOut(const SutureSetGoal& goal, double moved, const AnatomicalMap& map) {
  const WallPoint centre = find(goal.centre, map);
  std::vector<WallPoint> targets;
  for (const Eigen::Vector2d& place : suturePattern(goal.pattern, goal.bites, lengthOf(goal, map), goal.width))
    targets.push_back(map.walk(centre, moved + place.x(), goal.mirrored ? -place.y() : place.y()));
  return targets;
}

/// Of the nearest bite of an earlier set from one of the targets; no more than kBesideThread [m].
double distanceOfThreads(const std::vector<WallPoint>& targets, const Operator& me) {
  const AnatomicalMap& map = *me.seen_map;
  double min = kBesideThread;
  for (const WallPoint& target : targets)
    for (const WallPoint& stitch : me.stitches)
      min = std::min(min, (map.position(stitch) - map.position(target)).norm());
  return min;
}

}  // namespace

std::vector<WallPoint> targetsOf(const SutureSetGoal& goal, Operator& me) {
  const AnatomicalMap& map = me.map();
  std::vector<WallPoint> best = laidOut(goal, 0, map);
  double room = distanceOfThreads(best, me);
  const int most = static_cast<int>(kAsideMost * goal.length / kAsideStep);
  for (int k = 2; k < 2 * (most + 1) && room < kBesideThread; ++k) {  // -1, 1, -2, 2, ... steps
    const double moved = (k % 2 == 0 ? -1 : 1) * (k / 2) * kAsideStep;
    try {
      const std::vector<WallPoint> targets = laidOut(goal, moved, map);
      const double roomier = distanceOfThreads(targets, me);
      if (roomier > room) best = targets, room = roomier;
    } catch (const Error&) {  // beyond the end of the organ
    }
  }
  return best;
}

// -1: read as another pattern.
double SetInHand::marginOf(const std::vector<WallPoint>& bites, const AnatomicalMap& map) const {
  std::vector<Eigen::Vector3d> places;
  for (const WallPoint& bite : bites) places.push_back(map.position(bite));
  const TechniqueResult read = recogniseTechnique(places, TechniqueRule::Corrected);
  return read.technique == pattern ? read.margin : -1;
}

bool SetInHand::isSpoiledBy(const WallPoint& place, const AnatomicalMap& map) const {
  if (next >= points.size()) return false;
  std::vector<WallPoint> bites = points;
  bites[next] = place;
  return marginOf(points, map) >= kClear && marginOf(bites, map) < kClear;
}

std::optional<WallPoint> SetInHand::placeInstead(const AnatomicalMap& map) const {
  std::vector<WallPoint> bites = points;
  bites.erase(bites.begin() + static_cast<std::ptrdiff_t>(next));
  if (marginOf(bites, map) >= kClear) return {};
  bites = points;
  std::optional<WallPoint> best;
  double clearest = kClear;
  for (const auto& [distal, anterior] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
    try {
      bites[next] = map.walk(points[next], distal * kInstead, anterior * kInstead);
    } catch (const Error&) {  // beyond the end of the organ
      continue;
    }
    const double margin = marginOf(bites, map);
    if (margin >= clearest) best = bites[next], clearest = margin;
  }
  return best;
}

namespace {

/// A bite of the set in hand. Where it cannot be taken at its target and the set would not be read without it, such as
/// at a corner, it is taken beside it.
bool takeNext(const WallPoint& target, Operator& me) {
  if (takeBite(target, me).reached) return true;
  const std::optional<WallPoint> place = me.set.placeInstead(*me.seen_map);
  if (!place) return false;
  me.say("the pattern needs this bite: beside its target");
  me.set.points[me.set.next] = *place;
  return takeBite(*place, me).reached;
}

}  // namespace

GoalResult perform(const SutureSetGoal& goal, Operator& me) {
  if (!me.view().needle_loaded) return {false, "there is no needle"};
  const std::vector<WallPoint> targets = targetsOf(goal, me);
  me.set = {goal.pattern, targets, 0};
  for (std::size_t k = 0; k < targets.size(); ++k) {
    me.say("bite " + std::to_string(k + 1) + " of " + std::to_string(targets.size()));
    const auto point = me.set.points.begin() + static_cast<std::ptrdiff_t>(me.set.next);
    if (takeNext(targets[k], me))
      *point = me.tries.needle, ++me.set.next;
    else
      me.set.points.erase(point);
  }
  const std::size_t taken = me.set.next;
  me.stitches.insert(me.stitches.end(), me.set.points.begin(), me.set.points.end());
  me.set = {};
  if (taken < 2) return {false, "only " + std::to_string(taken) + " bites could be taken"};
  if (goal.cinched) {
    me.say("T-tag and cinch");
    const GoalResult cinch = perform(CinchGoal{}, me);
    if (!cinch.reached) return cinch;
  }
  return {taken == targets.size(), std::to_string(taken) + " of " + std::to_string(targets.size()) + " bites taken"};
}

}  // namespace vibe

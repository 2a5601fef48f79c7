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
// Of a whole set whose first bite is out of reach, design choices: half of what the sets of a sleeve are apart, what is
// left of its width, and how often
constexpr double kInward = 12e-3;  // [m]
constexpr double kNarrower = 0.75;
constexpr int kMoves = 2;

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

void sayNext(std::size_t number, std::size_t count, Operator& me) {
  me.say("bite " + std::to_string(number) + " of " + std::to_string(count));
}

/// The same set farther from the end of the organ to which it is nearer, and narrower.
SutureSetGoal movedInward(SutureSetGoal goal, const AnatomicalMap& map) {
  const Place& centre = goal.centre;
  const double along = centre.region ? map.alongIn(*centre.region, centre.along) : centre.along;
  goal.centre.distal += along < 0.5 ? kInward : -kInward;
  goal.width *= kNarrower;
  return goal;
}

/// Lays the set out and takes its first bite. Where that cannot be taken, the whole set moves towards the middle of the
/// organ and becomes narrower: there the scope has more room and bends less. Where it cannot be taken there either, it
/// is given up, and the set is where it was planned.
/// @returns whether it was taken
bool takeFirst(const SutureSetGoal& goal, Operator& me) {
  SutureSetGoal moved = goal;
  for (int k = 0; k <= kMoves; ++k, moved = movedInward(moved, me.map())) {
    try {
      me.set = {goal.pattern, targetsOf(moved, me), 0};
    } catch (const Error&) {  // the organ ends beside it
      if (k == 0) throw;
      break;
    }
    if (k > 0) me.say("the whole set moves: its first bite is out of reach");
    sayNext(1, me.set.points.size(), me);
    if (takeBite(me.set.points[0], me).reached) return true;
  }
  me.set = {goal.pattern, targetsOf(goal, me), 0};
  return false;
}

/// A bite of the set in hand. Where it cannot be taken at its target it is taken beside it.
bool takeNext(Operator& me) {
  if (takeBite(me.set.points[me.set.next], me).reached) return true;
  const std::optional<WallPoint> place = me.set.placeInstead(*me.seen_map);
  if (!place) return false;
  me.say("beside its target");
  me.set.points[me.set.next] = *place;
  return takeBite(*place, me).reached;
}

}  // namespace

GoalResult perform(const SutureSetGoal& goal, Operator& me) {
  if (!me.view().needle_loaded) return {false, "there is no needle"};
  bool taken = takeFirst(goal, me);
  const std::size_t planned = me.set.points.size();
  for (std::size_t k = 0;;) {
    const auto point = me.set.points.begin() + static_cast<std::ptrdiff_t>(me.set.next);
    if (taken)
      *point = me.tries.needle, ++me.set.next;
    else
      me.set.points.erase(point);
    if (++k == planned) break;
    sayNext(k + 1, planned, me);
    taken = takeNext(me);
  }
  const std::size_t bites = me.set.next;
  me.stitches.insert(me.stitches.end(), me.set.points.begin(), me.set.points.end());
  me.set = {};
  if (bites < 2) return {false, "only " + std::to_string(bites) + " bites could be taken"};
  if (goal.cinched) {
    me.say("T-tag and cinch");
    const GoalResult cinch = perform(CinchGoal{}, me);
    if (!cinch.reached) return cinch;
  }
  return {bites == planned, std::to_string(bites) + " of " + std::to_string(planned) + " bites taken"};
}

}  // namespace vibe

#include <algorithm>
#include <cmath>

#include "trainee/operator.hpp"
#include "trainee/picture.hpp"
#include "vibe_core/files/number_text.hpp"
#include "vibe_core/simulation/wall_coverage.hpp"

namespace vibe {

namespace {

constexpr double kAround = 35e-3;   // about a place, which the lens sees with it from a usual distance [m]
constexpr double kGivenUp = 15e-3;  // about a place that was looked at and not seen: of no use in this round [m]
constexpr int kCandidates = 200;    // places that are weighed against each other, at most
constexpr double kTurning = 0.5;    // what no turn at all costs, so that the next place is not always the nearest [rad]
constexpr double kPause = 0.2;      // that the lens rests on a place, after the hand [s]
constexpr double kAllButSeen = 0.995;  // of a region, of which nothing is said
constexpr double kNearer = 0.5;        // of the distance, in the second round

/// A trainee that looks everywhere.
class Survey {
 public:
  Survey(const SurveyGoal& goal, Operator& me)
      : goal_(goal),
        me_(me),
        begin_(me.view().time),
        coverage_(*me.coverage),
        triangle_(me.view().wall.size(), -1),
        given_up_(me.view().wall.size()) {
    const auto& triangles = me.model().organ.surface.triangles;
    for (std::size_t t = 0; t < triangles.size(); ++t)
      for (const int corner : triangles[t]) triangle_[corner] = static_cast<int>(t);
  }

  GoalResult pursue() {
    for (const double distance : {goal_.distance, kNearer * goal_.distance}) {
      std::fill(given_up_.begin(), given_up_.end(), 0);
      for (std::optional<int> next = choose(); next && !isOver(); next = choose()) visit(*next, distance);
    }
    const double seen = share();
    const std::string text = formatted("saw %.1f %% %sin %.0f s", 100 * seen, goal_.region ? "of the region " : "",
                                       me_.view().time - begin_);
    return {seen >= goal_.coverage, seen >= goal_.coverage ? text : text + leastSeen()};
  }

 private:
  double share() const {
    const CoverageSkill shares = coverage_.shares();
    return (goal_.region ? shares.region[static_cast<std::size_t>(*goal_.region)] : shares.whole).value_or(1);
  }

  bool isOver() const { return share() >= goal_.coverage || me_.view().time - begin_ > goal_.patience; }

  bool isUnseen(std::size_t particle) const {
    const Organ& organ = me_.model().organ;
    return organ.end[particle] == End::None && std::isnan(coverage_.firstSeen()[particle]) &&
           (!goal_.region || organ.region[particle] == *goal_.region);
  }

  /// The place about which most is unseen, for the turn that it takes; empty: none is left in this round.
  std::optional<int> choose() const {
    std::vector<int> unseen;
    for (std::size_t i = 0; i < given_up_.size(); ++i)
      if (isUnseen(i) && given_up_[i] == 0) unseen.push_back(static_cast<int>(i));
    const std::size_t stride = unseen.size() / kCandidates + 1;
    std::optional<int> best;
    double most = 0;
    for (std::size_t k = 0; k < unseen.size(); k += stride) {
      const double worth = areaAround(unseen[k], unseen) / (kTurning + viewOf(placeOf(unseen[k]), me_.view()).angle);
      if (worth > most) most = worth, best = unseen[k];
    }
    return best;
  }

  double areaAround(int particle, const std::vector<int>& unseen) const {
    double area = 0;
    for (const int i : unseen)
      if ((placeOf(i) - placeOf(particle)).squaredNorm() < kAround * kAround) area += me_.model().area[i];
    return area;
  }

  void visit(int particle, double distance) {
    const WallPoint place = pointAt(particle);
    me_.say(formatted("looks at the %s, %.0f %% seen", toString(me_.model().organ.region[particle]), 100 * share()));
    if (travel(bestView(me_.position(place), me_.outward(place), distance, me_), me_))
      me_.hand.wait(me_.skill().reaction_time + kPause);
    if (!isUnseen(static_cast<std::size_t>(particle))) return;
    for (std::size_t i = 0; i < given_up_.size(); ++i)
      if ((placeOf(static_cast<int>(i)) - placeOf(particle)).norm() < kGivenUp) given_up_[i] = 1;
  }

  Eigen::Vector3d placeOf(int particle) const { return me_.view().wall[particle]; }

  WallPoint pointAt(int particle) const {
    WallPoint point{triangle_[particle], Eigen::Vector3d::Zero()};
    const auto& corners = me_.model().organ.surface.triangles[point.triangle];
    for (int k = 0; k < 3; ++k) point.weight[k] = corners[k] == particle ? 1 : 0;
    return point;
  }

  /// Where most is missing, for people.
  std::string leastSeen() const {
    const auto& region = coverage_.shares().region;
    std::string text;
    for (int k = 0; k < kRegionCount; ++k) {
      const std::optional<double>& seen = region[static_cast<std::size_t>(k)];
      if (!seen || *seen >= goal_.coverage || *seen > kAllButSeen ||
          (goal_.region && static_cast<int>(*goal_.region) != k))
        continue;
      text += formatted("%s%s %.0f %%", text.empty() ? "; not seen: " : ", ", toString(static_cast<Region>(k)),
                        100 * (1 - *seen));
    }
    return text;
  }

  const SurveyGoal& goal_;
  Operator& me_;
  const double begin_;  // [s]
  const WallCoverage& coverage_;
  std::vector<int> triangle_;   // a triangle of each particle
  std::vector<char> given_up_;  // (particles)
};

}  // namespace

void lookAround(Operator& me) {
  const Observation& view = me.view();
  if (!me.coverage || !WallCoverage::isDue(view.step, me.model().scene.step_period)) return;
  std::vector<double> x, y, z;
  for (const Eigen::Vector3d& p : view.wall) x.push_back(p.x()), y.push_back(p.y()), z.push_back(p.z());
  const Eigen::Isometry3d tip = Eigen::Translation3d(view.tip) * view.tip_turn;
  me.coverage->look(tip, {me.model().organ.surface.triangles, x, y, z}, view.time);
}

GoalResult perform(const SurveyGoal& goal, Operator& me) {
  if (goal.region && !me.coverage->shares().region[static_cast<std::size_t>(*goal.region)])
    return {false, std::string("the organ has no ") + toString(*goal.region)};
  return Survey(goal, me).pursue();
}

}  // namespace vibe

#pragma once
#include <optional>
#include <string>

#include "trainee/bite_plan.hpp"
#include "trainee/operator.hpp"
#include "trainee/picture.hpp"

namespace vibe {

/// A way that was blocked, or on which nothing was seen, counts as missed by this; design choice [m]
constexpr double kBlocked = 15e-3;

/// Least depth over thickness that is sewn for want of a better one: it holds two strands of a tight thread, 6 of the 8
/// N of a whole wall. A shallower bite would tear out, and its set with it.
constexpr double kHolds = 0.8;

/// One attempt at a bite: the helix takes hold of the wall beside the target, draws it into the device until the needle
/// would pass through the target, the arm closes, the exchange takes the needle, and the arm takes it back.
class BiteAttempt {
 public:
  /// @param number  of tries before: with each, a place farther from the target is accepted, and in the last one a bite
  ///                that does not go through the whole wall
  BiteAttempt(const WallPoint& target, int number, Operator& me);

  GoalResult make();

 private:
  GoalResult grabAndStitch();
  void settle();
  bool approach(double into, double min);
  bool comeNear();
  bool grab();
  GoalResult drawAndClose();
  std::optional<NeedleView> look() const;
  double missOf(const NeedleView& needle) const;
  bool isGood(const NeedleView& needle) const;
  bool isDeep() const;
  bool pullsTooMuch() const;
  double acceptedMiss() const;
  void remember(const NeedleView& needle);
  bool letBackOut();
  void drawIn();
  void pushOn();
  void learn(const NeedleView& needle);
  GoalResult failedBy(double miss, const std::string& reason);
  std::optional<GoalResult> judgeView();
  std::optional<GoalResult> judgePlace();
  GoalResult closeArm();
  GoalResult exchange();
  void letGo();
  void takeNeedleBack();

  const WallPoint target_;  // of the bite, with the error of aim
  const int number_;
  const bool last_;
  Operator& me_;
  TraineeHand& hand_;
  BitePlan plan_;
  Observation before_;                                    // of the draw
  Eigen::Vector3d correction_ = Eigen::Vector3d::Zero();  // what the last motions of the helix missed [m]
  double aside_ = 1;                                      // of the helix from its aim along the wall [m]
  double nearest_miss_ = 1;                               // of a needle through the wall, during the draw [m]
  double nearest_drawn_ = 0;                              // helix_advance then [m]
};

}  // namespace vibe

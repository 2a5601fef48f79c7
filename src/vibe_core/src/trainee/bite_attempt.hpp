#pragma once
#include <optional>

#include "trainee/bite_plan.hpp"
#include "trainee/operator.hpp"
#include "trainee/picture.hpp"

namespace vibe {

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
  double gap() const;
  bool approach(double into, double min);
  bool comeNear();
  bool grab();
  GoalResult drawAndClose();
  std::optional<NeedleView> look() const;
  double missOf(const NeedleView& needle) const;
  bool isGood(const NeedleView& needle) const;
  bool isDeep() const;
  void drawIn();
  void pushOn();
  void learn(const NeedleView& needle);
  std::optional<GoalResult> judgeView();
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
};

}  // namespace vibe

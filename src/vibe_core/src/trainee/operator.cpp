#include "trainee/operator.hpp"

#include <algorithm>
#include <cmath>

#include "vibe_core/common/error.hpp"
#include "vibe_core/common/random.hpp"

namespace vibe {

double Operator::nextNormal() {
  double sum = -6;  // of twelve uniform numbers: variance 1
  for (int k = 0; k < 12; ++k) sum += nextUniform(random);
  return sum;
}

WallPoint Operator::withAimError(const WallPoint& target) {
  const double distal = skill().aim_error * nextNormal(), anterior = skill().aim_error * nextNormal();
  try {
    return map().walk(target, distal, anterior);
  } catch (const Error&) {
    return target;
  }
}

const AnatomicalMap& Operator::map() {
  if (!seen_map || view().sets == 0) seen_map = std::make_shared<AnatomicalMap>(model().organ, view().wall);
  return *seen_map;
}

Eigen::Vector3d Operator::position(const WallPoint& point) const {
  return positionOf(point, model().organ.surface.triangles, view().wall);
}

Eigen::Vector3d Operator::outward(const WallPoint& point) const {
  return outwardAt(point, model().organ.surface.triangles, view().wall);
}

WallPoint find(const Place& place, const AnatomicalMap& map) {
  const double along = place.region ? map.alongIn(*place.region, place.along) : place.along;
  return map.walk(map.at(along, place.around), place.distal, place.anterior);
}

void stepBack(Operator& me) {
  TraineeHand::Joints joints = me.hand.joints();
  joints[Insertion] = std::min(joints[Insertion], 0.05);
  joints[TipUpDown] = joints[TipLeftRight] = 0;
  joints[HelixAdvance] = 2e-3;
  joints[HelixRotation] = joints[NeedleDriver] = 0;
  me.hand.moveTo(joints, 1);
}

}  // namespace vibe

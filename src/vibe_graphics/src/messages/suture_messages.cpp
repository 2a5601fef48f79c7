#include "vibe_graphics/messages/suture_messages.hpp"

#include <vibe_msgs/TissueTopology.h>

#include <algorithm>
#include <cmath>

#include "vibe_graphics/messages/cloud_field.hpp"

namespace vibe::graphics {
namespace {

using Eigen::Vector3d;
using vibe_msgs::Suture;
using Topology = vibe_msgs::TissueTopology;

constexpr std::size_t kMaxSutures = 10'000, kMaxPoints = 1'000'000;  // more is a mistake

Vector3d vectorOf(const geometry_msgs::Point& point) {
  return {point.x, point.y, point.z};
}

bool isValidPosition(const geometry_msgs::Point& point) {
  return std::abs(point.x) < kMaxCoordinate && std::abs(point.y) < kMaxCoordinate && std::abs(point.z) < kMaxCoordinate;
}

bool isAmount(double value) {
  return std::isfinite(value) && value >= 0;
}

const std::string kInvalidPosition = " is invalid (not finite, or beyond 1000 km); the last valid message is shown.";

std::string checkSuturePositions(const Suture& suture, const std::string& which) {
  for (std::size_t k = 0; k < suture.bites.size(); ++k)
    if (!isValidPosition(suture.bites[k].position))
      return "The position of bite " + std::to_string(k) + which + kInvalidPosition;
  for (std::size_t k = 0; k < suture.thread.size(); ++k)
    if (!isValidPosition(suture.thread[k]))
      return "Point " + std::to_string(k) + " of thread" + which + kInvalidPosition;
  if (suture.has_t_tag && !isValidPosition(suture.t_tag)) return "t_tag" + which + kInvalidPosition;
  if (suture.has_cinch && !isValidPosition(suture.cinch)) return "cinch" + which + kInvalidPosition;
  return {};
}

std::string checkOffsets(const Suture& suture, const std::string& which) {
  const auto& offsets = suture.thread_offsets;
  if (offsets.size() != suture.bites.size())
    return "thread_offsets" + which + " has " + std::to_string(offsets.size()) + " entries for " +
           std::to_string(suture.bites.size()) + " bites; send one per bite.";
  if (offsets.front() != 0 || offsets.back() + std::size_t{1} != suture.thread.size() ||
      !std::is_sorted(offsets.begin(), offsets.end()))
    return "thread_offsets" + which + " does not run from 0 to the last of its " +
           std::to_string(suture.thread.size()) + " points; send the number of each bite's point, in order.";
  return {};
}

/// A thread may be empty if there is nothing to draw.
std::string checkThread(const Suture& suture, const std::string& which) {
  if (suture.thread.empty() && suture.thread_offsets.empty()) return {};
  if (suture.thread.empty() || suture.thread_offsets.empty())
    return "Only one of thread and thread_offsets" + which + " is empty; send both or neither.";
  std::string wrong = checkOffsets(suture, which);
  if (!wrong.empty()) return wrong;
  const std::size_t pieces = suture.bites.size() - 1;
  if (suture.tension.size() != pieces || suture.length.size() != pieces)
    return "tension and length" + which + " do not have one entry for each of " + std::to_string(pieces) +
           " pieces of thread; send one per piece.";
  for (const double tension : suture.tension)
    if (!isAmount(tension)) return "A tension" + which + " is negative or not finite; send newtons.";
  return {};
}

std::string checkTransitions(const Suture& suture, const std::string& which) {
  const auto last = static_cast<int>(suture.taken.size()) - 2;
  for (const int transition : suture.transitions) {
    // a list that was never set is all zero
    const bool unset = suture.technique == Suture::TECHNIQUE_OTHER && suture.taken.empty() && transition == 0;
    if (!unset && transition != -1 && (transition < 0 || transition + 1 > last))
      return "transitions" + which + " refers to bite " + std::to_string(transition) + ", but the pattern has " +
             std::to_string(suture.taken.size()) + " bites; send -1 where there is none.";
  }
  return {};
}

std::string checkSuture(const Suture& suture, std::size_t k) {
  const std::string which = " of suture " + std::to_string(k);
  if (suture.stage > Suture::BROKEN)
    return "The stage" + which + " is " + std::to_string(+suture.stage) + ", which does not exist.";
  if (suture.technique > Suture::TECHNIQUE_C)
    return "The technique" + which + " is " + std::to_string(+suture.technique) + ", which does not exist.";
  if (!(suture.technique_margin >= 0 && suture.technique_margin <= 1))
    return "technique_margin" + which + " is not between 0 and 1.";
  std::string wrong = checkSuturePositions(suture, which);
  if (wrong.empty()) wrong = checkThread(suture, which);
  return wrong.empty() ? checkTransitions(suture, which) : wrong;
}

std::string checkBleeding(const vibe_msgs::Bleeding& bleeding, const vibe_msgs::SutureArray& message, std::size_t k) {
  const std::string which = " of bleeding " + std::to_string(k);
  if (!isValidPosition(bleeding.position)) return "The position" + which + kInvalidPosition;
  if (!isAmount(bleeding.rate) || !isAmount(bleeding.amount) || !std::isfinite(bleeding.begin))
    return "rate, amount or begin" + which + " is negative or not finite; send m^3/s, m^3 and s.";
  if (bleeding.suture < 0 || static_cast<std::size_t>(bleeding.suture) >= message.sutures.size())
    return "The suture" + which + " is " + std::to_string(bleeding.suture) + ", but there are " +
           std::to_string(message.sutures.size()) + "; send a number from 0.";
  const std::size_t bites = message.sutures[static_cast<std::size_t>(bleeding.suture)].bites.size();
  if (bleeding.bite < -1 || (bleeding.bite >= 0 && static_cast<std::size_t>(bleeding.bite) >= bites))
    return "The bite" + which + " is " + std::to_string(bleeding.bite) + ", but its suture has " +
           std::to_string(bites) + "; send -1 where it tore out.";
  return {};
}

std::string check(const vibe_msgs::SutureArray& message) {
  if (message.sutures.size() > kMaxSutures || message.bleedings.size() > kMaxSutures)
    return "There are more than ten thousand sutures or bleedings, which is a mistake.";
  std::size_t points = 0;
  for (const Suture& suture : message.sutures) points += suture.thread.size() + suture.bites.size();
  if (points > kMaxPoints) return "The threads have more than a million points, which is a mistake.";
  std::string wrong;
  for (std::size_t k = 0; k < message.sutures.size() && wrong.empty(); ++k) wrong = checkSuture(message.sutures[k], k);
  for (std::size_t k = 0; k < message.bleedings.size() && wrong.empty(); ++k)
    wrong = checkBleeding(message.bleedings[k], message, k);
  return wrong;
}

/// Of the curvatures by region, cardia to pylorus: means over a stomach at rest (y to the left, z to the head).
constexpr double kGreaterInward[5][2] = {{-0.86, -0.51}, {-0.86, -0.51}, {-0.81, 0.58}, {0.59, 0.81}, {0.96, 0.28}};
constexpr double kLesserInward[5][2] = {{0.90, -0.43}, {0.63, -0.78}, {0.95, -0.31}, {-0.11, -0.99}, {-0.59, -0.81}};

Vector3d inwardOf(const vibe_msgs::Bite& bite) {
  const std::size_t region = std::min<std::size_t>(bite.region, Topology::REGION_PYLORUS);
  const auto along = [](const double(&yz)[2]) { return Vector3d(0, yz[0], yz[1]).normalized(); };
  switch (bite.wall) {
    case Topology::WALL_ANTERIOR:
      return -Vector3d::UnitX();
    case Topology::WALL_GREATER_CURVATURE:
      return along(kGreaterInward[region]);
    case Topology::WALL_POSTERIOR:
      return Vector3d::UnitX();
    case Topology::WALL_LESSER_CURVATURE:
      return along(kLesserInward[region]);
    default:
      return Vector3d::Zero();
  }
}

void takePieces(const Suture& suture, SutureSet& set) {
  for (std::size_t k = 0; k + 1 < suture.thread_offsets.size(); ++k) {
    ThreadPiece piece;
    piece.tension = suture.tension[k];
    for (std::size_t p = suture.thread_offsets[k]; p <= suture.thread_offsets[k + 1]; ++p)
      piece.line.push_back(vectorOf(suture.thread[p]));
    set.pieces.push_back(std::move(piece));
  }
}

/// Corners and links are those of the bites as they were taken; after a bite has torn out the numbers do not fit.
void takePattern(const Suture& suture, SutureSet& set) {
  const std::size_t count = suture.bites.size();
  set.technique = suture.technique_name;
  set.margin = suture.technique_margin;
  if (suture.taken.empty() || suture.taken.size() != count) return;
  // transition i is a turn between the ways from bite i to i + 1 and from i + 1 to i + 2
  for (const int transition : suture.transitions)
    if (transition >= 0) set.corners.push_back(static_cast<std::size_t>(transition) + 1);
  const bool two = set.corners.size() == 2;
  if (suture.technique == Suture::TECHNIQUE_U && two) {
    set.links = {{0, set.corners[0]}, {set.corners[1], count - 1}};
  } else if (suture.technique == Suture::TECHNIQUE_Z && two) {
    set.links = {{0, set.corners[1]}, {set.corners[0], count - 1}};
  } else if (suture.technique != Suture::TECHNIQUE_OTHER) {
    for (std::size_t k = 1; k < count; ++k) set.links.emplace_back(k - 1, k);
  }
}

SutureSet takeSuture(const Suture& suture) {
  SutureSet set;
  set.stage = static_cast<SutureStage>(suture.stage);
  for (const vibe_msgs::Bite& bite : suture.bites)
    set.bites.push_back({vectorOf(bite.position), bite.full_thickness != 0, inwardOf(bite)});
  takePieces(suture, set);
  takePattern(suture, set);
  set.has_t_tag = suture.has_t_tag;
  set.has_cinch = suture.has_cinch;
  set.t_tag = vectorOf(suture.t_tag);
  set.cinch = vectorOf(suture.cinch);
  set.loose = suture.loose;
  set.tear_outs = suture.tear_outs;
  return set;
}

Wound takeBleeding(const vibe_msgs::Bleeding& bleeding, const vibe_msgs::SutureArray& message, std::size_t k) {
  Wound wound;
  wound.place = vectorOf(bleeding.position);
  const auto& bites = message.sutures[static_cast<std::size_t>(bleeding.suture)].bites;
  wound.inward = bleeding.bite < 0 ? Vector3d::Zero() : inwardOf(bites[static_cast<std::size_t>(bleeding.bite)]);
  wound.brisk = bleeding.brisk;
  wound.rate = bleeding.rate;
  wound.amount = bleeding.amount;
  wound.age = std::max(0.0, message.header.stamp.toSec() - bleeding.begin);
  wound.number = static_cast<int>(k);
  return wound;
}

}  // namespace

std::string readSutures(const vibe_msgs::SutureArray& message, SutureDrawing& scene) {
  const std::string wrong = check(message);
  if (!wrong.empty()) return wrong;
  scene = {};
  for (const Suture& suture : message.sutures) scene.sets.push_back(takeSuture(suture));
  for (std::size_t k = 0; k < message.bleedings.size(); ++k)
    scene.wounds.push_back(takeBleeding(message.bleedings[k], message, k));
  return {};
}

}  // namespace vibe::graphics

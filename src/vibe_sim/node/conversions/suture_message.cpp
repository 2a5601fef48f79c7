#include "conversions/suture_message.hpp"

#include <algorithm>

#include <vibe_msgs/TissueTopology.h>

#include "conversions/conversions.hpp"
#include "vibe_core/suture/suture_thread.hpp"
#include "vibe_core/suture/technique.hpp"

namespace vibe::sim {

namespace {

constexpr int kSlackPieces = 12;  // straight pieces that a catenary is drawn with

// The numbers on the wire are those of the library.
using WireSuture = vibe_msgs::Suture;
static_assert(same(Suture::Stage::Open, WireSuture::OPEN) && same(Suture::Stage::Tagged, WireSuture::TAGGED) &&
              same(Suture::Stage::Cinching, WireSuture::CINCHING) &&
              same(Suture::Stage::Cinched, WireSuture::CINCHED) && same(Suture::Stage::Broken, WireSuture::BROKEN));
static_assert(same(Technique::Other, WireSuture::TECHNIQUE_OTHER) && same(Technique::U, WireSuture::TECHNIQUE_U) &&
              same(Technique::Z, WireSuture::TECHNIQUE_Z) &&
              same(Technique::Triangular, WireSuture::TECHNIQUE_TRIANGULAR) &&
              same(Technique::Square, WireSuture::TECHNIQUE_SQUARE) &&
              same(Technique::Running, WireSuture::TECHNIQUE_RUNNING) && same(Technique::C, WireSuture::TECHNIQUE_C));
static_assert(kTechniqueCount == 7);

int heaviest(const Bite& bite) {
  const auto max = std::max_element(bite.weight.begin(), bite.weight.end());
  return max == bite.weight.end() ? -1 : bite.particle[static_cast<std::size_t>(max - bite.weight.begin())];
}

vibe_msgs::Bite makeBite(const Bite& bite, const State& state) {
  vibe_msgs::Bite message;
  message.position = toMessage<geometry_msgs::Point>(bitePosition(bite, state.x, state.y, state.z));
  message.time = bite.time;
  message.depth = bite.depth;
  message.thickness = bite.thickness;
  message.full_thickness = bite.fullThickness();
  message.region = static_cast<std::uint8_t>(bite.region);
  message.wall = static_cast<std::uint8_t>(bite.wall);
  message.along = bite.along;
  message.particle = heaviest(bite);
  return message;
}

/// The points between two bites of a thread that is longer than their distance; none where it is taut.
void addSlack(const Eigen::Vector3d& first, const Eigen::Vector3d& last, double length, const Scene& scene,
              std::vector<geometry_msgs::Point>& thread) {
  const bool drawable = first.allFinite() && last.allFinite() && std::isfinite(length);
  if (!drawable || length <= (last - first).norm()) return;
  const Eigen::Vector3d gravity = scene.gravity ? scene.gravity->acceleration : Eigen::Vector3d::Zero();
  const Catenary shape = hang(first, last, length, polypropylene20().weightPerLength(gravity.norm()), gravity);
  for (int k = 1; k < kSlackPieces; ++k)
    thread.push_back(toMessage<geometry_msgs::Point>(shape.point(length * k / kSlackPieces)));
}

void addThread(const Suture& suture, const Scene& scene, vibe_msgs::Suture& message) {
  if (suture.stage == Suture::Stage::Broken || message.bites.size() < 2) return;
  for (std::size_t k = 0; k < message.bites.size(); ++k) {
    message.thread_offsets.push_back(static_cast<std::uint32_t>(message.thread.size()));
    message.thread.push_back(message.bites[k].position);
    const bool slack = k < suture.length.size() && k < suture.tension.size() && suture.tension[k] == 0;
    if (!slack || k + 1 == message.bites.size()) continue;
    addSlack(toVector(message.bites[k].position), toVector(message.bites[k + 1].position), suture.length[k], scene,
             message.thread);
  }
}

void addEnds(const Suture& suture, vibe_msgs::Suture& message) {
  if (message.bites.empty()) return;
  message.has_t_tag = suture.stage >= Suture::Stage::Tagged;
  message.has_cinch = suture.stage >= Suture::Stage::Cinching;
  if (message.has_t_tag) message.t_tag = message.bites.back().position;
  if (message.has_cinch) message.cinch = message.bites.front().position;
}

void addTechnique(const Suture& suture, vibe_msgs::Suture& message) {
  message.technique = suture.technique;
  message.corrected_technique = suture.corrected_technique;
  message.printed_technique = suture.printed_technique;
  if (suture.stage >= Suture::Stage::Tagged) {
    message.technique_name = toString(static_cast<Technique>(suture.technique));
    message.corrected_technique_name = toString(static_cast<Technique>(suture.corrected_technique));
    message.printed_technique_name = toString(static_cast<Technique>(suture.printed_technique));
  }
  message.technique_margin = suture.technique_margin;
  std::copy(suture.transitions.begin(), suture.transitions.end(), message.transitions.begin());
  for (const Eigen::Vector3d& place : suture.taken) message.taken.push_back(toMessage<geometry_msgs::Point>(place));
}

vibe_msgs::Suture makeSuture(const Suture& suture, const Scene& scene, const State& state) {
  vibe_msgs::Suture message;
  message.stage = static_cast<std::uint8_t>(suture.stage);
  for (const Bite& bite : suture.bites) message.bites.push_back(makeBite(bite, state));
  addThread(suture, scene, message);
  message.length = suture.length;
  message.tension = suture.tension;
  addTechnique(suture, message);
  addEnds(suture, message);
  message.pulled = suture.pulled;
  message.cinch_tension = suture.cinch_tension;
  message.loose =
      suture.stage == Suture::Stage::Cinched && scene.suture && suture.cinch_tension < scene.suture->loose_tension;
  message.begin = suture.begin;
  message.end = suture.end;
  message.tear_outs = static_cast<std::uint32_t>(suture.tear_outs);
  return message;
}

vibe_msgs::Bleeding makeBleeding(const Bleeding& bleeding, const State& state) {
  vibe_msgs::Bleeding message;
  message.suture = bleeding.suture;
  message.bite = bleeding.bite;
  if (bleeding.particle >= 0) {
    const auto p = static_cast<std::size_t>(bleeding.particle);
    message.position = toMessage<geometry_msgs::Point>({state.x[p], state.y[p], state.z[p]});
  }
  message.brisk = bleeding.brisk;
  message.begin = bleeding.begin;
  message.rate = bleeding.rate;
  message.amount = bleeding.amount;
  message.overdue = bleeding.overdue;
  return message;
}

}  // namespace

vibe_msgs::SutureArray makeSutures(const Model& model, const State& state, std::int64_t stamp) {
  auto message = stamped<vibe_msgs::SutureArray>(stamp, kWorldFrame);
  for (const Suture& suture : state.procedure.sutures)
    message.sutures.push_back(makeSuture(suture, model.scene, state));
  for (const Bleeding& bleeding : state.procedure.bleedings) message.bleedings.push_back(makeBleeding(bleeding, state));
  message.blood_lost = state.procedure.blood_lost;
  return message;
}

std::uint64_t kindOf(const ProcedureState& procedure) {
  std::uint64_t kind = 0xcbf29ce484222325ULL;
  const auto add = [&kind](std::uint64_t value) { kind = (kind ^ value) * 0x100000001b3ULL; };
  for (const Suture& suture : procedure.sutures) {
    add(static_cast<std::uint64_t>(suture.stage));
    add(suture.bites.size());
    add(suture.technique);
    add(static_cast<std::uint64_t>(suture.tear_outs));
  }
  add(procedure.sutures.size());
  for (const Bleeding& bleeding : procedure.bleedings) {
    add(bleeding.rate > 0 ? 1 : 0);
    add(bleeding.overdue ? 1 : 0);
  }
  add(procedure.bleedings.size());
  return kind;
}

}  // namespace vibe::sim

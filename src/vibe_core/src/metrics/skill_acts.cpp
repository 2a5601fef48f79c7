#include "vibe_core/metrics/skill_acts.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace vibe {

MarkCounter::MarkCounter(const Organ& organ)
    : organ_(organ), law_(ApcParameters()), finder_(organ), dose_(organ.surface.vertices.size(), 0) {}

MarkSkill MarkCounter::count(const std::vector<std::uint8_t>& grades, const std::vector<double>& x,
                             const std::vector<double>& y, const std::vector<double>& z) {
  MarkSkill skill;
  if (grades.size() != dose_.size()) return skill;
  for (std::size_t i = 0; i < grades.size(); ++i) {
    // the next number up, so that rounding to a float does not lose the grade
    const auto threshold = static_cast<float>(law_.threshold(static_cast<BurnGrade>(grades[i])));
    dose_[i] = grades[i] == 0 ? 0 : std::nextafter(threshold, std::numeric_limits<float>::infinity());
  }
  for (const MarkZone& zone : finder_.find(law_, dose_, {organ_.surface.triangles, x, y, z})) {
    ++skill.zones;
    skill.inside += zone.in_zone ? 1 : 0;
    ++skill.wall[static_cast<std::size_t>(zone.wall)];
    skill.burns += zone.grade >= BurnGrade::Burn ? 1 : 0;
    skill.deep_burns += zone.grade >= BurnGrade::Deep ? 1 : 0;
    skill.area += zone.area;
  }
  return skill;
}

namespace {

/// Mean and standard deviation without keeping the values (Welford 1962, Technometrics 4(3):419).
class Spread {
 public:
  void add(double value) {
    ++count_;
    const double off = value - mean_;
    mean_ += off / count_;
    squares_ += off * (value - mean_);
  }
  std::optional<double> mean() const { return count_ > 0 ? std::optional<double>(mean_) : std::nullopt; }
  std::optional<double> deviation() const {
    return count_ > 1 ? std::optional<double>(std::sqrt(squares_ / (count_ - 1))) : std::nullopt;
  }

 private:
  int count_ = 0;
  double mean_ = 0, squares_ = 0;
};

/// How many of so many.
class Share {
 public:
  void add(bool yes) {
    ++count_;
    yes_ += yes ? 1 : 0;
  }
  std::optional<double> value() const {
    return count_ > 0 ? std::optional<double>(static_cast<double>(yes_) / count_) : std::nullopt;
  }

 private:
  int count_ = 0, yes_ = 0;
};

Eigen::Vector3d placeAtRest(const Organ& organ, const Bite& bite) {
  Eigen::Vector3d place = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < bite.particle.size(); ++k)
    place += bite.weight[k] * organ.surface.vertices[bite.particle[k]];
  return place;
}

double spacing(const Organ& organ, const Suture& suture, std::size_t bite) {
  return (placeAtRest(organ, suture.bites[bite]) - placeAtRest(organ, suture.bites[bite - 1])).norm();
}

std::optional<double> meanAlong(const Suture& suture) {
  Spread along;
  for (const Bite& bite : suture.bites) along.add(bite.along);
  return along.mean();
}

void countBite(const Bite& bite, BiteSkill& skill) {
  ++skill.taken;
  skill.full_thickness += bite.fullThickness() ? 1 : 0;
  ++skill.wall[static_cast<std::size_t>(bite.wall)];
  skill.in_antrum += bite.region == Region::Antrum || bite.region == Region::Pylorus ? 1 : 0;
  skill.in_fundus += bite.region == Region::Fundus || bite.region == Region::Cardia ? 1 : 0;
}

}  // namespace

BiteSkill measureBites(const Organ& organ, const std::vector<Suture>& sutures) {
  BiteSkill skill;
  Spread distance, depth;
  Share full, bites_up, sets_up;
  std::optional<double> last;
  for (const Suture& suture : sutures) {
    skill.torn_out += suture.tear_outs;
    for (std::size_t b = 0; b < suture.bites.size(); ++b) {
      const Bite& bite = suture.bites[b];
      countBite(bite, skill);
      depth.add(bite.depth);
      full.add(bite.fullThickness());
      if (b == 0) continue;
      distance.add(spacing(organ, suture, b));
      bites_up.add(bite.along < suture.bites[b - 1].along);
    }
    const std::optional<double> along = meanAlong(suture);
    if (along && last) sets_up.add(*along < *last);
    if (along) last = along;
  }
  skill.taken += skill.torn_out;
  skill.spacing_mean = distance.mean();
  skill.spacing_sd = distance.deviation();
  skill.depth_mean = depth.mean();
  skill.depth_sd = depth.deviation();
  skill.full_thickness_share = full.value();
  skill.bites_proximal = bites_up.value();
  skill.sets_proximal = sets_up.value();
  return skill;
}

void measureSets(const Organ& organ, const SutureScene* scene, const std::vector<Suture>& sutures,
                 std::vector<SetSkill>& sets) {
  sets.assign(sutures.size(), SetSkill());
  for (std::size_t k = 0; k < sutures.size(); ++k) {
    const Suture& suture = sutures[k];
    SetSkill& set = sets[k];
    const bool cinched = suture.stage == Suture::Stage::Cinched;
    set.stage = suture.stage;
    set.loose = cinched && scene != nullptr && suture.cinch_tension < scene->loose_tension;
    set.named = suture.stage >= Suture::Stage::Tagged;
    set.technique = static_cast<Technique>(suture.technique);
    set.margin = suture.technique_margin;
    set.bites = static_cast<int>(suture.bites.size());
    set.torn_out = suture.tear_outs;
    Spread distance;
    for (std::size_t b = 1; b < suture.bites.size(); ++b) distance.add(spacing(organ, suture, b));
    set.spacing_mean = distance.mean();
    set.along = meanAlong(suture);
    if (cinched) set.cinch_tension = suture.cinch_tension;
    if (suture.end > 0) set.duration = suture.end - suture.begin;
  }
  updateSets(sutures, sets);
}

void updateSets(const std::vector<Suture>& sutures, std::vector<SetSkill>& sets) {
  for (std::size_t k = 0; k < std::min(sutures.size(), sets.size()); ++k) {
    const Suture& suture = sutures[k];
    SetSkill& set = sets[k];
    set.drawn = suture.pulled;
    set.tension = 0;
    for (double tension : suture.tension) set.tension = std::max(set.tension, tension);
    if (suture.length.empty()) {
      set.thread.reset();
      continue;
    }
    set.thread = 0;
    for (double length : suture.length) *set.thread += length;
  }
}

}  // namespace vibe

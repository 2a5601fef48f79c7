#include "vibe_operator/messages/reference_values.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "vibe_operator/messages/number_text.hpp"

namespace vibe::operating {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kPascalPerMillimetreOfMercury = 133.322;

using Session = const SessionMessages&;

/// Of the sets that take no more bites: the one at work would lower the mean until it is finished.
double bitesPerSet(Session session) {
  if (!session.sutures) return kNone;
  double bites = 0, sets = 0;
  for (const vibe_msgs::Suture& suture : session.sutures->sutures) {
    if (suture.stage == vibe_msgs::Suture::OPEN) continue;
    bites += static_cast<double>(suture.bites.size() + suture.tear_outs);
    sets += 1;
  }
  return sets > 0 ? bites / sets : kNone;
}

double offTheBody(Session session) {
  if (session.state.bites == 0) return kNone;
  return session.skill.bites_in_antrum + session.skill.bites_in_fundus;
}

double shareAbove(Session session) {
  return session.skill.time > 0 ? 100 * session.skill.time_above / session.skill.time : kNone;
}

/// 0 N also means that there never was a force. Without contact and grip there is no value.
double maxForce(Session session) {
  return session.skill.contact_time > 0 || session.skill.grip_time > 0 ? session.skill.max_force : kNone;
}

double fullThickness(Session session) {
  return 100 * session.skill.full_thickness_share;
}

double spacing(Session session) {
  return 1e3 * session.skill.bite_spacing_mean;
}

double pressure(Session session) {
  return session.state.pressure / kPascalPerMillimetreOfMercury;
}

double minutes(Session session) {
  return session.skill.time / 60;
}

double areaReduction(Session session) {
  return 100 * session.skill.area_reduction;
}

double lengthReduction(Session session) {
  return 100 * session.skill.length_reduction;
}

double bloodLost(Session session) {
  return 1e6 * session.state.blood_lost;
}

double setsProximal(Session session) {
  return 100 * session.skill.sets_proximal;
}

double sutures(Session session) {
  return session.state.sutures;
}

double jerk(Session session) {
  return session.skill.log_dimensionless_jerk;
}

const char* const kForces =
    "Trejos et al., Surg Endosc 2011;25:186: in two pigs the instrument's tip was above 5 N in 1.6 % of the samples of "
    "transgastric procedures, and at almost 8 N at most.";

std::vector<ShownMeasure> procedureMeasures() {
  return {
      {"Sutures", "", 0, sutures, "Threads with at least one bite.",
       "6 to 8: Kumbhari et al., VideoGIE 2017, 10.1016/j.vgie.2017.01.002. Other series used 5 to 6 (Turjman, BJSTR "
       "2023) and 4 to 7 (Espinet-Coll, Endosc Int Open 2020;8:E1349).",
       4, 8, 12, true},
      {"Bites per set", "", 1, bitesPerSet, "Mean over the sets whose T-tag was dropped.",
       "6 to 9 bites per suture: Kumbhari et al., VideoGIE 2017, 10.1016/j.vgie.2017.01.002.", 6, 9, 14, false},
      {"Bite spacing", "mm", 0, spacing, "Mean straight distance of neighbours of a set, on the shape at rest.", "", 0,
       0, 60, false},
      {"Full thickness", "%", 0, fullThickness, "Share of the bites that went through the whole wall.", "", 0, 0, 100,
       false},
      {"Off the body", "", 0, offTheBody, "Bites in antrum, pylorus, fundus or cardia.",
       "Antrum and fundus are spared: Updates Surg 2022, 10.1007/s13304-022-01385-4.", 0, 0, 5, false},
      {"Sets proximal", "%", 0, setsProximal, "Of the steps from set to set, the share that goes towards the fundus.",
       "Sutures go from distal to proximal: 10.1177/26345161241289134.", 100, 100, 100, false},
  };
}

std::vector<ShownMeasure> organMeasures() {
  return {
      {"Area reduction", "%", 1, areaReduction,
       "How much smaller the mean cross-section of the body is than before anything was done to it.",
       "Surg Endosc 2022;36:5167, 10.1007/s00464-021-08893-1: raters saw 34.6 % (expert) and 9.4 % (novice) in videos "
       "of "
       "a simulator, by a measure of theirs.",
       34.6, kInfinity, 60, true},
      {"Length reduction", "%", 1, lengthReduction, "How much shorter the organ's axis is than before.", "", 0, 0, 60,
       true},
      {"Gas pressure", "mmHg", 1, pressure, "In the lumen, above that of the room.",
       "Ushimaru et al., Sci Rep 2020;10:18169: 10.0 mmHg (3.0 to 17.9) during gastroscopy, 80 patients.", 3, 17.9, 25,
       true},
  };
}

std::vector<ShownMeasure> handMeasures() {
  return {
      {"Max force", "N", 1, maxForce, "Greatest force of the tissue on the tool so far.", kForces, 0, 8, 12, false},
      {"Time above 5 N", "%", 1, shareAbove, "Share of the time with a force of the tissue on the tool above 5 N.",
       kForces, 0, 1.6, 5, false},
      {"Blood lost", "mL", 1, bloodLost, "By all bites together.", "", 0, 0, 50, false},
      {"Smoothness", "", 1, jerk, "Log dimensionless jerk of the scope's tip; nearer to 0 is smoother.", "", 0, 0, 1,
       false},
      {"Time", "min", 1, minutes, "Simulated time so far.",
       "60 min: Kumbhari 2020. Others: 37 min median of 331 cases (Turjman, BJSTR 2023), 47 min (Itani). These are of "
       "the "
       "whole procedure with all that a simulator leaves out.",
       0, 60, 90, false},
  };
}

std::vector<ShownMeasure> allMeasures() {
  std::vector<ShownMeasure> all = procedureMeasures();
  for (const auto& part : {organMeasures(), handMeasures()}) all.insert(all.end(), part.begin(), part.end());
  return all;
}

}  // namespace

const std::vector<ShownMeasure>& measures() {
  static const std::vector<ShownMeasure> all = allMeasures();
  return all;
}

const ShownMeasure kPullingForce = {"Pull",  "N", 1, nullptr, "Force of the tissue on the tool now.",
                                    kForces, 0,   5, 10,      false};

Rating rate(const ShownMeasure& measure, double value, bool done) {
  if (!std::isfinite(value)) return Rating::NoValue;
  if (measure.source.empty()) return Rating::NoReference;
  if (value >= measure.low && value <= measure.high) return Rating::Within;
  return value < measure.low && measure.grows && !done ? Rating::NotYet : Rating::Outside;
}

std::string ratingText(Rating rating) {
  switch (rating) {
    case Rating::NoReference:
      return "no published reference";
    case Rating::NoValue:
      return "no value yet";
    case Rating::NotYet:
      return "not there yet";
    case Rating::Within:
      return "within the reference";
    case Rating::Outside:
      return "outside the reference";
  }
  return {};
}

std::string rangeText(const ShownMeasure& measure) {
  if (measure.source.empty()) return {};
  const std::string low = quantityText(measure.low, measure.decimals, measure.unit);
  const std::string high = quantityText(measure.high, measure.decimals, measure.unit);
  if (measure.low == measure.high) return high;
  if (!std::isfinite(measure.high)) return "at least " + low;
  if (measure.low <= 0) return "at most " + high;
  return numberText(measure.low, measure.decimals) + " to " + high;
}

std::string explain(const ShownMeasure& measure) {
  if (measure.source.empty()) return measure.meaning + "\nNo reference is published.";
  return measure.meaning + "\nReference: " + rangeText(measure) + ".\nSource: " + measure.source;
}

BarShape barShape(const ShownMeasure& measure, double value) {
  BarShape shape;
  const auto place = [&measure](double v) { return std::max(0.0, std::min(1.0, v / measure.bar_end)); };
  if (!measure.source.empty()) {
    shape.has_range = true;
    shape.range_begin = place(measure.low);
    shape.range_end = place(measure.high);
  }
  if (std::isfinite(value)) {
    shape.has_value = true;
    shape.value = place(value);
    shape.beyond = value < 0 || value > measure.bar_end;
  }
  return shape;
}

}  // namespace vibe::operating

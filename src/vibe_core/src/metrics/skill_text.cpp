#include "metrics/skill_text.hpp"

#include <optional>
#include <string>

#include "vibe_core/files/number_text.hpp"

namespace vibe {
namespace {

constexpr double kPascalPerMmHg = 133.322;
constexpr double kMm = 1e3, kMl = 1e6, kCm2 = 1e4, kPercent = 100;

/// In so many places; '-': no value.
std::string number(std::optional<double> value, double scale, int decimals, int width = 0) {
  return value ? formatted("%*.*f", width, decimals, rounded(*value * scale, decimals)) : formatted("%*s", width, "-");
}

std::string percent(std::optional<double> value) {
  return value ? number(value, kPercent, 1) + " %" : "-";
}

std::string phaseLine(const char* name, const PhaseSkill& skill) {
  const MotionMeasures& motion = skill.motion;
  std::optional<double> max_force;
  if (skill.force.loaded_time > 0) max_force = skill.force.max;
  return formatted("%-9s %9.2f %9.3f ", name, skill.time, motion.path_length) +
         number(motion.log_dimensionless_jerk, 1, 2, 8) + number(motion.spectral_arc_length, 1, 2, 8) +
         formatted("%9d", motion.submovements) + number(motion.economy, 1, 2, 9) + number(max_force, 1, 2, 8) +
         number(skill.force.mean, 1, 2, 8) + formatted("%9.2f\n", skill.force.time_above);
}

std::string phaseTable(const PhasesSkill& phases) {
  std::string text = "phase        time s    path m     LDLJ   SPARC  submov.  economy   max N  mean N  > 5 N s\n";
  for (int k = 0; k < kPhaseCount; ++k)
    if (phases.phase[k].time > 0) text += phaseLine(toString(static_cast<Phase>(k)), phases.phase[k]);
  return text + phaseLine("whole", phases.whole);
}

std::string markLine(const MarkSkill& m) {
  const auto on = [&m](Wall wall) { return m.wall[static_cast<std::size_t>(wall)]; };
  return formatted(
      "marks              %8d     in the zone %d   anterior %d   greater curvature %d   posterior %d   burns %d   deep "
      "%d\n",
      m.zones, m.inside, on(Wall::Anterior), on(Wall::GreaterCurvature), on(Wall::Posterior), m.burns, m.deep_burns);
}

std::string biteLines(const BiteSkill& b, const MistakeSkill& m) {
  return formatted("bites              %8d     missed %d   withdrawn %d   torn out %d   of full thickness %s\n",
                   b.taken, m.missed_bites, m.withdrawn_bites, b.torn_out, percent(b.full_thickness_share).c_str()) +
         "  spacing          " + number(b.spacing_mean, kMm, 1, 8) + " mm   +- " + number(b.spacing_sd, kMm, 1) +
         "   depth " + number(b.depth_mean, kMm, 1) + " mm   +- " + number(b.depth_sd, kMm, 1) + "\n" +
         formatted("  off the body     %8d     antrum %d   fundus %d   proximally %s of bites, %s of sets\n",
                   b.in_antrum + b.in_fundus, b.in_antrum, b.in_fundus, percent(b.bites_proximal).c_str(),
                   percent(b.sets_proximal).c_str());
}

std::string setLine(std::size_t row, const SetSkill& s) {
  const char* stage = s.loose ? "loose" : toString(s.stage);
  return formatted("%3zu  %-10s ", row, s.named ? toString(s.technique) : "-") +
         number(s.named ? std::optional<double>(s.margin) : std::nullopt, 1, 2, 6) +
         formatted("%7d%6d", s.bites, s.torn_out) + number(s.along, 1, 2, 7) + number(s.spacing_mean, kMm, 1, 12) +
         number(s.thread, kMm, 1, 11) + formatted("%10.1f", s.drawn * kMm) + number(s.cinch_tension, 1, 2, 9) +
         formatted("%7.2f", s.tension) + number(s.duration, 1, 1, 8) + "  " + stage + "\n";
}

std::string setTable(const std::vector<SetSkill>& sets) {
  if (sets.empty()) return "sets                      -\n";
  std::string text =
      "set  technique  margin  bites  torn  along  spacing mm  thread mm  drawn mm  cinch N  now N  time s\n";
  for (std::size_t k = 0; k < sets.size(); ++k) text += setLine(k + 1, sets[k]);
  return text;
}

std::string organLine(const char* name, const char* unit, double scale, std::optional<double> before,
                      std::optional<double> now, std::optional<double> less) {
  return formatted("  %-17s", name) + number(now, scale, 1, 8) + formatted(" %-4s", unit) + "before " +
         number(before, scale, 1) + "   reduced by " + percent(less) + "\n";
}

std::optional<double> of(const std::optional<OrganMeasures>& measures, std::optional<double> OrganMeasures::*which) {
  return measures ? (*measures).*which : std::nullopt;
}

std::optional<double> volumeOf(const std::optional<OrganMeasures>& measures) {
  return measures ? std::optional<double>(measures->volume) : std::nullopt;
}

std::string organLines(const OrganSkill& o) {
  if (!o.fault.empty()) return "organ                     -     " + o.fault + "\n";
  return formatted("organ              %8.1f mmHg now   %.1f mmHg before (%s)\n", o.pressure / kPascalPerMmHg,
                   o.reference_pressure / kPascalPerMmHg, toString(o.reference)) +
         organLine("area of the body", "cm2", kCm2, of(o.before, &OrganMeasures::mean_area),
                   of(o.now, &OrganMeasures::mean_area), o.area_reduction) +
         organLine("volume", "mL", kMl, volumeOf(o.before), volumeOf(o.now), o.volume_reduction) +
         organLine("length", "mm", kMm, of(o.before, &OrganMeasures::length), of(o.now, &OrganMeasures::length),
                   o.length_reduction);
}

}  // namespace

std::string summarise(const SkillMetrics& m) {
  std::string text =
      phaseTable(m.phases) + markLine(m.marks) + biteLines(m.bites, m.mistakes) + setTable(m.sets) +
      formatted("bleeding           %8.2f mL lost   mild %d   brisk %d   now %d   overdue %d\n", m.bleeding.lost * kMl,
                m.bleeding.mild, m.bleeding.brisk, m.bleeding.now, m.bleeding.overdue) +
      formatted("mistakes           %8d rejected   slips %d   torn out %d   threads broken %d\n", m.mistakes.rejected,
                m.mistakes.slips, m.bites.torn_out, m.mistakes.broken_threads) +
      organLines(m.organ);
  text.pop_back();
  return text;
}

}  // namespace vibe

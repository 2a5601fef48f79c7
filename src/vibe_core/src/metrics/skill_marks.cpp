#include "vibe_core/metrics/skill_marks.hpp"

#include <cmath>
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

}  // namespace vibe

#include "fem/case_reader.hpp"

#include <algorithm>
#include <set>

#include "vibe_core/common/error.hpp"
#include "vibe_core/scene/nearest_key.hpp"

namespace vibe::benchmarks {

CaseReader::CaseReader(const std::string& file)
    : source_(YamlSource::load(file, YamlLimits{})),
      folder_(file.find('/') == std::string::npos ? "" : file.substr(0, file.rfind('/') + 1)) {}

void CaseReader::readMap(const YamlField& field, const std::vector<std::string>& needed, const Readers& readers) const {
  std::vector<std::string> known;
  for (const auto& reader : readers) known.push_back(reader.first);
  std::set<std::string> seen;
  for (const YamlField& entry : source_.map(field)) {
    const auto reader = readers.find(entry.key);
    if (reader == readers.end()) source_.fail(entry, "is no key of a case; " + suggestKey(entry.key, known));
    seen.insert(entry.key);
    reader->second(entry);
  }
  for (const std::string& key : needed) {
    if (seen.count(key) == 0) source_.fail(field, "lacks the key '" + key + "'; add it");
  }
}

void CaseReader::readList(const YamlField& field, const std::function<void(const YamlField&)>& reader) const {
  for (const YamlField& item : source_.list(field)) reader(item);
}

double CaseReader::number(const YamlField& field, const std::string& unit, double low, double high) const {
  return source_.quantity(field, unit, low, high);
}

Eigen::Vector3d CaseReader::vector(const YamlField& field, const std::string& unit) const {
  const auto values = source_.quantities(field, 3, unit, -1e12, 1e12);
  return {values[0], values[1], values[2]};
}

Eigen::Vector3d CaseReader::direction(const YamlField& field) const {
  const Eigen::Vector3d given = vector(field, "1");
  if (!(given.norm() > 0)) source_.fail(field, "has length 0; give a direction");
  return given.normalized();
}

std::string CaseReader::path(const YamlField& field) const {
  const std::string given = source_.text(field);
  return given[0] == '/' ? given : folder_ + given;
}

}  // namespace vibe::benchmarks

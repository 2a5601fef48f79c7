#pragma once
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "fem/fem_case.hpp"
#include "vibe_core/scene/yaml_source.hpp"

namespace vibe::benchmarks {

/// Bound of quantities of which any size makes sense, in their unit.
constexpr double kHuge = 1e12;

/// Typed access to the maps of a case file. Every key must be known to the reader of its map.
class CaseReader {
 public:
  using Readers = std::map<std::string, std::function<void(const YamlField&)>>;

  explicit CaseReader(const std::string& file);

  /// Calls the reader of each key. Fails for an unknown key, with the nearest known one, and for a missing key of
  /// `needed`.
  void readMap(const YamlField& field, const std::vector<std::string>& needed, const Readers& readers) const;
  void readList(const YamlField& field, const std::function<void(const YamlField&)>& reader) const;

  double number(const YamlField& field, const std::string& unit, double low, double high) const;
  Eigen::Vector3d vector(const YamlField& field, const std::string& unit) const;
  Eigen::Vector3d direction(const YamlField& field) const;  ///< unit length
  std::string path(const YamlField& field) const;           ///< relative to the case file

  const YamlSource& source() const { return source_; }

 private:
  YamlSource source_;
  std::string folder_;
};

void readMesh(const CaseReader& reader, const YamlField& field, BenchMesh& mesh);
void readLoads(const CaseReader& reader, const YamlField& field, FemCase& out);
void readRuns(const CaseReader& reader, const YamlField& field, FemCase& out);
void readSamples(const CaseReader& reader, const YamlField& field, FemCase& out);

}  // namespace vibe::benchmarks

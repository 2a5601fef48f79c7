#pragma once
#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace vibe::test {

inline std::vector<std::vector<std::string>> readRows(const std::string& name) {
  std::ifstream in(std::string(VIBE_CORE_DIR) + "/test/suture/reference/" + name);
  std::vector<std::vector<std::string>> rows;
  std::string line, field;
  std::getline(in, line);
  while (std::getline(in, line)) {
    std::vector<std::string> row;
    std::istringstream fields(line);
    while (std::getline(fields, field, ',')) row.push_back(field);
    rows.push_back(row);
  }
  return rows;
}

/// One value of thread_values.csv; throws if there is none, so that a wrong name cannot pass.
inline double referenceValue(const std::string& name, const std::string& quantity) {
  std::map<std::pair<std::string, std::string>, double> values;
  for (const auto& row : readRows("thread_values.csv")) values[{row.at(0), row.at(1)}] = std::stod(row.at(2));
  return values.at({name, quantity});
}

struct ShapeRow {
  double arc_length, x, y, tension;
};

inline std::vector<ShapeRow> referenceShape(const std::string& name) {
  std::vector<ShapeRow> shape;
  for (const auto& row : readRows("catenary_shape.csv"))
    if (row.at(0) == name)
      shape.push_back({std::stod(row[1]), std::stod(row[2]), std::stod(row[3]), std::stod(row[4])});
  return shape;
}

}  // namespace vibe::test

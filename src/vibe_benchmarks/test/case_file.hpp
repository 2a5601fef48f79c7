#pragma once
#include <gtest/gtest.h>

#include <fstream>
#include <string>

namespace vibe::benchmarks {

/// A temporary case file in the folder of the test, removed with the object.
class CaseFile {
 public:
  explicit CaseFile(const std::string& text) : path_(::testing::TempDir() + "vibe_case.yaml") {
    std::ofstream(path_) << text;
  }
  ~CaseFile() { std::remove(path_.c_str()); }
  CaseFile(const CaseFile&) = delete;
  CaseFile& operator=(const CaseFile&) = delete;
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

/// A block of linear tetrahedra stretched along x with sliding ends and free sides; `lines` are appended.
inline std::string blockCase(const std::string& loads, const std::string& rest) {
  return "name: block\n"
         "mesh:\n"
         "  box: {size: [40 mm, 20 mm, 20 mm], cells: [2, 1, 1], tets_per_cell: 6}\n"
         "  named: {corner: {nearest: [0, 0, 0]}, edge: {nearest: [0, 20 mm, 0]}}\n"
         "element: linear_tet\n"
         "material: {law: neo_hookean, young_modulus: 30 kPa, poisson_ratio: 0.45}\n"
         "density: 1050 kg/m^3\n"
         "loads:\n" +
         loads + rest;
}

inline std::string stretchLoads() {
  return "  prescribed:\n"
         "    - {set: x_min, held: [x]}\n"
         "    - {set: corner, held: [y, z]}\n"
         "    - {set: edge, held: [z]}\n"
         "    - {set: x_max, held: [x], translation: [20 mm, 0, 0]}\n";
}

}  // namespace vibe::benchmarks

#include "vibe_core/geometry/mesh_file.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "geometry/surface_check.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_testing/temporary_folder.hpp"

namespace vibe::mesh_standards_test {
namespace {

using test::TemporaryFolder;

const std::string kGenerator = std::string(VIBE_CORE_DIR) + "/test/mesh_files/make_mesh_files.py";
const std::string kReports = std::string(VIBE_CORE_DIR) + "/test/reports";

/// What a file is and what is right.
struct Expectation {
  std::string name, kind;
  std::vector<std::string> rest;
};

Eigen::Vector3d centroid(const SurfaceMesh& mesh) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const auto& t : mesh.triangles) {
    const Eigen::Vector3d &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    sum += a.dot(b.cross(c)) / 24 * (a + b + c);
  }
  return sum / enclosedVolume(mesh);
}

/// Reads and checks a file.
/// @return the reason if it is refused
std::string refusal(const std::string& path, SurfaceMesh& mesh) {
  try {
    mesh = readMeshFile(path);
    checkSurface(mesh, path);
    return "";
  } catch (const Error& error) {
    return error.what();
  }
}

void expectSurface(const Expectation& right, const SurfaceMesh& mesh) {
  std::vector<double> numbers;
  for (const std::string& text : right.rest) numbers.push_back(std::stod(text));
  ASSERT_EQ(numbers.size(), 7U);
  const Eigen::Vector3d centre(numbers[2], numbers[3], numbers[4]);
  EXPECT_NEAR(enclosedVolume(mesh) / numbers[0], 1, 1e-5) << right.name;
  EXPECT_NEAR(surfaceArea(mesh) / numbers[1], 1, 1e-5) << right.name;
  EXPECT_LT((centroid(mesh) - centre).norm(), 1e-4 * std::cbrt(numbers[0])) << right.name;
  EXPECT_EQ(static_cast<double>(mesh.vertices.size()), numbers[5]) << right.name;
  EXPECT_EQ(static_cast<double>(mesh.triangles.size()), numbers[6]) << right.name;
}

std::vector<Expectation> expectations(const std::string& file) {
  std::vector<Expectation> all;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    std::istringstream cells(line);
    Expectation right;
    std::getline(cells, right.name, '\t');
    std::getline(cells, right.kind, '\t');
    for (std::string cell; std::getline(cells, cell, '\t');) right.rest.push_back(cell);
    all.push_back(right);
  }
  return all;
}

TEST(MeshStandards, FilesThatFollowThemLoadAndOthersAreRefusedWithTheReason) {
  const TemporaryFolder folder;
  const std::string command = "python3 -B '" + kGenerator + "' '" + folder.path() + "'";
  ASSERT_EQ(std::system(command.c_str()), 0) << command;
  const std::vector<Expectation> all = expectations(folder.path() + "/expected.tsv");
  ASSERT_EQ(all.size(), 500U);
  int loaded = 0;
  for (const Expectation& right : all) {
    SurfaceMesh mesh;
    const std::string reason = refusal(folder.path() + "/" + right.name, mesh);
    if (right.kind == "loads") {
      EXPECT_EQ(reason, "") << right.name;
      if (reason.empty()) expectSurface(right, mesh);
      loaded += reason.empty() ? 1 : 0;
    } else {
      EXPECT_NE(reason.find(right.rest.at(0)), std::string::npos) << right.name << "\n" << reason;
      EXPECT_FALSE(reason.empty()) << right.name;
      EXPECT_EQ(reason.find('\n'), std::string::npos) << reason;
    }
  }
  EXPECT_GT(loaded, 250);
  EXPECT_LT(loaded, 400);
}

/// The cells of the lines "| file | ... |" of the page about the reports.
std::vector<std::vector<std::string>> reports() {
  std::vector<std::vector<std::string>> rows;
  std::ifstream in(kReports + "/README.md");
  for (std::string line; std::getline(in, line);) {
    if (line.rfind("| `", 0) != 0) continue;
    std::vector<std::string> cells;
    std::istringstream parts(line.substr(1));
    for (std::string cell; std::getline(parts, cell, '|');) {
      const std::size_t begin = cell.find_first_not_of(' '), end = cell.find_last_not_of(' ');
      cells.push_back(begin == std::string::npos ? "" : cell.substr(begin, end - begin + 1));
    }
    rows.push_back(cells);
  }
  return rows;
}

TEST(MeshReports, EveryReportedFileIsReadAsThePageSays) {
  const auto rows = reports();
  ASSERT_GT(rows.size(), 15U);
  for (const auto& row : rows) {
    ASSERT_EQ(row.size(), 3U) << row[0];
    const std::string name = row[0].substr(1, row[0].size() - 2);
    ASSERT_TRUE(std::ifstream(kReports + "/" + name).good()) << name;
    SurfaceMesh mesh;
    const std::string reason = refusal(kReports + "/" + name, mesh);
    if (row[2].rfind("volume ", 0) == 0) {
      EXPECT_EQ(reason, "") << name;
      const double volume = std::stod(row[2].substr(7));
      EXPECT_NEAR(reason.empty() ? enclosedVolume(mesh) / volume : 0, 1, 1e-6) << name;
    } else {
      const std::size_t begin = row[2].find('"'), end = row[2].rfind('"');
      ASSERT_LT(begin, end) << name;
      EXPECT_NE(reason.find(row[2].substr(begin + 1, end - begin - 1)), std::string::npos) << name << "\n" << reason;
    }
  }
}

}  // namespace
}  // namespace vibe::mesh_standards_test

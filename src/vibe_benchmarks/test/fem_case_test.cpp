#include "fem/fem_case.hpp"

#include <dirent.h>

#include "case_file.hpp"
#include "vibe_core/scene/words.hpp"
#include "vibe_testing/expect_error.hpp"

namespace vibe::benchmarks::fem_case_test {
namespace {

const char kRun[] =
    "static: {levels: [1]}\n"
    "sample: [{name: force, kind: reaction, set: x_max, direction: [1, 0, 0], reference: 1}]\n";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

FemCase read(const std::string& text) {
  const CaseFile file(text);
  return readCase(file.path());
}

std::string good() {
  return blockCase(stretchLoads(), kRun);
}

// The names are those of scene files, in any order.
TEST(FemCase, lawsAreThoseOfSceneFiles) {
  for (const Choice& choice : choicesOf("tissue.law")) {
    const std::string law = "law: " + choice.word + ", stiffening: 1";
    EXPECT_EQ(nameOf(read(replaced(good(), "law: neo_hookean", law)).material.law), choice.word);
  }
  const std::string typo = replaced(good(), "law: neo_hookean", "law: yeho");
  EXPECT_ERROR(read(typo), "material.law: 'yeho' is not known here; did you mean 'yeoh'?");
  EXPECT_ERROR(read(replaced(good(), "law: neo_hookean", "law: fung")), "the stiffening is 0, but must be above 0");
}

TEST(FemCase, readsABlock) {
  const FemCase block = read(good());
  EXPECT_EQ(block.mesh.nodes.size(), 12U);
  EXPECT_EQ(block.mesh.tets.size(), 12U);
  EXPECT_EQ(block.mesh.sets.at("x_max").size(), 4U);
  EXPECT_DOUBLE_EQ(block.material.young_modulus, 30e3);
  ASSERT_EQ(block.motions.size(), 4U);
  EXPECT_TRUE(block.motions[0].held[0]);
  EXPECT_FALSE(block.motions[0].held[1]);
  EXPECT_DOUBLE_EQ(block.motions[3].translation.x(), 0.02);
}

TEST(FemCase, namesFileLineAndNearestKey) {
  EXPECT_ERROR(read(replaced(good(), "density:", "densty:")),
               "vibe_case.yaml:7: densty: is not a known key; "
               "did you mean 'density'?");
  EXPECT_ERROR(read(replaced(good(), "tets_per_cell", "tet_per_cell")), "did you mean 'tets_per_cell'?");
  EXPECT_ERROR(read(replaced(good(), "direction:", "directon:")), "did you mean 'direction'?");
}

TEST(FemCase, refusesWhatCannotBeRun) {
  EXPECT_ERROR(read(replaced(good(), "static: {levels: [1]}\n", "")), "exactly one of the keys");
  EXPECT_ERROR(read(replaced(good(), "static: {levels: [1]}", "static: {levels: []}")), "at least one level");
  EXPECT_ERROR(read(replaced(good(), "density: 1050 kg/m^3\n", "")), "lacks the key 'density'");
  EXPECT_ERROR(read(replaced(good(), "linear_tet", "shell")), "needs triangles");
  EXPECT_ERROR(read(replaced(good(), "0.45", "0.5")), "Poisson");
  EXPECT_ERROR(read(replaced(good(), "kind: reaction, set: x_max", "kind: reaction")), "needs 'set'");
  EXPECT_ERROR(read(replaced(good(), "{set: x_min,", "{set: x_mim,")), "did you mean 'x_min'?");
  EXPECT_ERROR(read(replaced(good(), "direction: [1, 0, 0]", "direction: [0, 0, 0]")), "has length 0");
  EXPECT_ERROR(read(replaced(good(), "box: {size: [40 mm", "box: {size: [40 kg")), "kg");
  EXPECT_ERROR(readCase("/nowhere/case.yaml"), "/nowhere/case.yaml");
}

TEST(FemCase, refusesBrokenMeshFiles) {
  const std::string folder = ::testing::TempDir();
  std::ofstream(folder + "vibe_nodes.txt") << "0 0 0\n1 0 0\n0 1 0\n0 0 x\n";
  EXPECT_ERROR(readNodes(folder + "vibe_nodes.txt"), "vibe_nodes.txt:4:");
  std::ofstream(folder + "vibe_tets.txt") << "0 1 2 3\n0 1 2 4\n";
  EXPECT_ERROR(readElements(folder + "vibe_tets.txt", 4, 4), "vibe_tets.txt:2: '4' is no node");
  std::ofstream(folder + "vibe_sets.txt") << "clamped: 0 1\nclamped: 2\n";
  EXPECT_ERROR(readSets(folder + "vibe_sets.txt", 4), "repeats the set 'clamped'");
}

TEST(FemCase, shippedCasesAreReadable) {
  const std::string folder = std::string(VIBE_BENCHMARKS_DIR) + "/cases";
  DIR* const listing = opendir(folder.c_str());
  ASSERT_NE(listing, nullptr);
  int count = 0;
  while (const dirent* entry = readdir(listing)) {
    const std::string name = entry->d_name;
    if (name.find(".yaml") == std::string::npos) continue;
    const FemCase shipped = readCase(folder + "/" + name);
    EXPECT_EQ(shipped.name + ".yaml", name);
    EXPECT_FALSE(shipped.source.empty()) << name;
    ++count;
  }
  closedir(listing);
  EXPECT_GE(count, 15);
}

}  // namespace
}  // namespace vibe::benchmarks::fem_case_test

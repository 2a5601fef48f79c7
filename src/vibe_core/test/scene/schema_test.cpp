#include "vibe_core/scene/schema.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <set>
#include <sstream>

#include "scene/scene_keys.hpp"
#include "scene/schema_text.hpp"
#include "vibe_core/scene/unit.hpp"
#include "vibe_testing/expect_error.hpp"

namespace vibe {

void PrintTo(const SchemaRow& row, std::ostream* out) {
  *out << row.key;
}

}  // namespace vibe

namespace vibe::schema_test {
namespace {

template <typename T>
bool holds(const SchemaRow& row) {
  return std::holds_alternative<T& (*)(Scene&)>(row.access);
}

bool isVector(const SchemaRow& row) {
  return holds<Eigen::Vector3d>(row) || holds<std::array<double, 3>>(row) || holds<std::optional<Eigen::Vector3d>>(row);
}

bool isNumber(const SchemaRow& row) {
  return isVector(row) || holds<double>(row) || holds<int>(row) || holds<std::uint64_t>(row);
}

/// Of as many numbers as the scene wants; relaxation_test has what its lists refuse.
bool isList(const SchemaRow& row) {
  return holds<std::vector<double>>(row);
}

/// One number as the row's type is written: a vector has it three times.
std::string written(const SchemaRow& row, const std::string& number) {
  return isVector(row) ? "[" + number + ", " + number + ", " + number + "]" : number;
}

std::string number(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

std::string messageFor(const SchemaRow& row, const std::string& value) {
  return errorOf([&] { parseScene(textWith(row, value).yaml, "s.yaml"); });
}

/// The message names file, line and key.
void expectRejected(const SchemaRow& row, const std::string& value, const std::string& reason) {
  const std::string message = messageFor(row, value);
  const std::string place = "s.yaml:" + std::to_string(textWith(row, value).line) + ": " + row.key;
  EXPECT_EQ(message.rfind(place, 0), 0u) << message << "\nwanted: " << place;
  EXPECT_NE(message.find(reason), std::string::npos) << message << "\nwanted: " << reason;
}

class EveryRow : public ::testing::TestWithParam<SchemaRow> {};

TEST_P(EveryRow, DefaultAppliesWhenLeftOut) {
  const SchemaRow& row = GetParam();
  if (row.required) {
    const std::string message = messageFor(row, "");
    EXPECT_NE(message.find("lacks the key '" + lastPart(row.key) + "'"), std::string::npos) << message;
    return;
  }
  if (holds<GeometryScene::Kind>(row)) return;  // leaving it out is the stomach: Schema.KindDefaultsToStomach
  Scene scene = parseScene(textWith(row, "").yaml, "s.yaml");
  Scene fresh = completeScene();
  EXPECT_EQ(valueText(row, scene), valueText(row, fresh));
}

TEST_P(EveryRow, TakesTheEndsOfItsRange) {
  const SchemaRow& row = GetParam();
  if (!isNumber(row)) return;
  for (const double end : {row.low, row.high}) {
    Scene scene = parseScene(textWith(row, written(row, number(end))).yaml, "s.yaml");
    EXPECT_EQ(std::stod(valueText(row, scene).substr(isVector(row) ? 1 : 0)), end);
  }
}

TEST_P(EveryRow, TakesItsWords) {
  const SchemaRow& row = GetParam();
  for (const std::string& word : wordsOf(row)) {
    Scene scene = parseScene(textWith(row, word).yaml, "s.yaml");
    EXPECT_EQ(valueText(row, scene), "'" + word + "'");
  }
}

TEST_P(EveryRow, RefusesWhatIsOutOfRange) {
  const SchemaRow& row = GetParam();
  if (!isNumber(row)) return;
  const double beyond = holds<double>(row) || isVector(row) ? 1e-6 * (row.high - row.low) : row.high;
  expectRejected(row, written(row, number(row.low - beyond)), "is out of range");
  expectRejected(row, written(row, number(row.high + beyond)), "is out of range");
}

TEST_P(EveryRow, RefusesTheWrongType) {
  const SchemaRow& row = GetParam();
  expectRejected(row, "{a: 1}", "is a map");
  if (isVector(row)) {
    expectRejected(row, "1", "must be a list of 3");
    expectRejected(row, "[1, 2]", "write 3 in brackets");
    expectRejected(row, "[1, 2, [3]]", "is a list");
  } else if (isList(row)) {
    expectRejected(row, "[[1]]", "is a list");
  } else {
    expectRejected(row, "[1]", "is a list");
  }
  if (isNumber(row)) expectRejected(row, written(row, "hello"), "");
  if (isNumber(row)) expectRejected(row, written(row, ".nan"), "");
  if (isNumber(row)) expectRejected(row, written(row, "-.inf"), "");
  if (holds<int>(row)) expectRejected(row, "150.5", "is not a whole number");
  if (holds<bool>(row)) expectRejected(row, "3", "neither true nor false");
  if (holds<GeometryScene::Kind>(row)) expectRejected(row, "stomac", "did you mean 'stomach'?");
  for (const std::string& word : wordsOf(row)) expectRejected(row, word + "x", "did you mean '" + word + "'?");
  expectRejected(row, "~", "is empty");
}

TEST_P(EveryRow, RefusesTheWrongUnit) {
  const SchemaRow& row = GetParam();
  if (!isNumber(row)) return;
  expectRejected(row, written(row, "5 kg"),
                 holds<double>(row) || isVector(row) ? "is a mass, but it must be" : "whole number");
  expectRejected(row, written(row, "5 smoots"), holds<double>(row) || isVector(row) ? "unknown unit" : "whole number");
}

TEST_P(EveryRow, IsDocumented) {
  const SchemaRow& row = GetParam();
  EXPECT_GT(std::string(row.help).size(), 5u);
  EXPECT_GT(std::string(row.source).size(), 3u);
  EXPECT_EQ(isNumber(row) || isList(row), row.low < row.high);
  EXPECT_TRUE(!holds<double>(row) || parseUnit(row.unit).has_value()) << row.unit;
  EXPECT_NE(findSection(sectionOf(row.key)), nullptr);
}

TEST_P(EveryRow, DefaultLiesInItsRange) {
  const SchemaRow& row = GetParam();
  if (!isNumber(row) || row.absent != nullptr) return;
  Scene fresh = completeScene();
  EXPECT_EQ(messageFor(row, valueText(row, fresh)), "no error");
}

std::string testName(const ::testing::TestParamInfo<SchemaRow>& row) {
  std::string name = row.param.key;
  for (char& c : name) c = c == '.' ? '_' : c;
  return name;
}

INSTANTIATE_TEST_SUITE_P(Schema, EveryRow, ::testing::ValuesIn(sceneSchema()), testName);

TEST(Schema, KeysAreUniqueAndMany) {
  std::set<std::string> keys;
  for (const SchemaRow& row : sceneSchema()) EXPECT_TRUE(keys.insert(row.key).second) << row.key;
  EXPECT_GE(keys.size(), 40u);
}

TEST(Schema, KindDefaultsToStomach) {
  EXPECT_EQ(parseScene("geometry: {particles: 500}", "s.yaml").geometry.kind, GeometryScene::Kind::Stomach);
}

const std::string kPage = std::string(VIBE_CORE_DIR) + "/../../docs/scenes.md";

std::string pageOfScenes() {
  std::stringstream text;
  text << std::ifstream(kPage).rdbuf();
  return text.str();
}

/// Blocks of YAML that are whole scene files: those that begin with `base`.
std::vector<std::string> examplesIn(const std::string& page) {
  const std::string begin = "\n```yaml\nbase: ", end = "\n```";
  std::vector<std::string> found;
  for (std::size_t at = page.find(begin); at != std::string::npos; at = page.find(begin, at + 1)) {
    const std::size_t from = at + begin.find("base");
    found.push_back(page.substr(from, page.find(end, from) - from) + "\n");
  }
  return found;
}

TEST(Schema, EverySectionHasAnExampleThatTheParserTakes) {
  const std::vector<std::string> examples = examplesIn(pageOfScenes());
  for (const std::string& example : examples)
    EXPECT_EQ(errorOf([&] { parseScene(example, "example.yaml"); }), "no error") << example;
  for (const SchemaSection& section : sceneSections()) {
    const std::string key = lastPart(section.name) + ":";
    EXPECT_TRUE(std::any_of(examples.begin(), examples.end(),
                            [&](const std::string& example) { return example.find(key) != std::string::npos; }))
        << "docs/scenes.md has no example of '" << section.name << "'";
  }
}

/// A table that the documentation does not show would be of no use to a reader.
TEST(Schema, CommittedDocumentationIsTheGeneratedTable) {
  const std::string begin = "<!-- schema: begin -->\n", end = "<!-- schema: end -->\n";
  std::string page = pageOfScenes();
  const std::size_t from = page.find(begin), to = page.find(end);
  ASSERT_NE(from, std::string::npos) << kPage;
  ASSERT_NE(to, std::string::npos) << kPage;
  const std::size_t start = from + begin.size();
  if (std::getenv("VIBE_UPDATE_DOCS") != nullptr) {
    page.replace(start, to - start, describeSchema());
    std::ofstream(kPage) << page;
    GTEST_SKIP() << "wrote " << kPage;
  }
  EXPECT_EQ(page.substr(start, to - start), describeSchema()) << "run with VIBE_UPDATE_DOCS=1 to write " << kPage;
}

}  // namespace
}  // namespace vibe::schema_test

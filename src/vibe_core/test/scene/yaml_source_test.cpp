#include "vibe_core/scene/yaml_source.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "vibe_testing/expect_error.hpp"
#include "vibe_testing/temporary_folder.hpp"

namespace vibe::yaml_source_test {
namespace {

YamlSource parsed(const std::string& text) {
  return YamlSource::parse(text, "f.yaml", YamlLimits{});
}

std::string repeated(const std::string& part, int count) {
  std::string text;
  for (int k = 0; k < count; ++k) text += part;
  return text;
}

TEST(YamlSource, RefusesWhatIsNoDocument) {
  EXPECT_ERROR(parsed(""), "f.yaml:1: contains nothing");
  EXPECT_ERROR(parsed("# only a comment\n"), "f.yaml:1: contains nothing");
  EXPECT_ERROR(parsed("- a\n- b\n"), "f.yaml:1: is a list at the top");
  EXPECT_ERROR(parsed("just words"), "f.yaml:1: is a single value at the top");
  EXPECT_ERROR(parsed("a: 1\n---\nb: 2\n"), "more than one YAML document");
  EXPECT_ERROR(parsed("a: 1\nb: [1, 2\nc: 3\n"), "is not valid YAML at column");
  EXPECT_ERROR(parsed("a: 1\n\tb: 2\n"), "f.yaml:2: is not valid YAML");
  EXPECT_ERROR(parsed("a: *nowhere\n"), "f.yaml:1: is not valid YAML");
  EXPECT_ERROR(parsed(std::string("a: 1\0b", 6)), "NUL bytes");
  EXPECT_ERROR(YamlSource::load("/nowhere/x.yaml", YamlLimits{}), "/nowhere/x.yaml: cannot be opened");
  EXPECT_ERROR(YamlSource::load("/", YamlLimits{}), "/: cannot be read");
}

TEST(YamlSource, NamesCharactersThatAreNotWhatTheyLookLike) {
  const auto map = [](const std::string& text) {
    const YamlSource source = parsed(text);
    for (const YamlField& field : source.map(source.root())) source.quantity(field, "m", 0, 1);
  };
  // a no-break space after the colon, before the unit and as indentation
  EXPECT_ERROR(parsed("unit:\u00a01"),
               "f.yaml:1: is a single value at the top; write 'key: value' lines: line 1, column 6 "
               "has a no-break space (U+00A0) in the place of ' '");
  EXPECT_ERROR(map("a: 1 mm\nb: 1\u00a0mm\n"), "f.yaml:2: b: '1\u00a0mm' has the unknown unit");
  EXPECT_ERROR(map("a: 1 mm\nb: 1\u00a0mm\n"), "; column 5 has a no-break space (U+00A0) in the place of ' '");
  EXPECT_ERROR(map("a: 1\n\u00a0b: 2\nc\n"), "; column 1 has a no-break space");
  EXPECT_ERROR(parsed("a: 1\nb:\u00a0[1\n\nc: 2\n"), "; line 2, column 3 has a no-break space");
  // a Cyrillic letter, a minus sign, a full-width colon, a typographic quotation mark, a tab
  EXPECT_ERROR(map("b: 1 \u0441m\n"), "; column 6 has a letter of another alphabet (U+0441) in the place of 'c'");
  EXPECT_ERROR(map("b: \u22121 m\n"), "; column 4 has a minus sign (U+2212) in the place of '-'");
  EXPECT_ERROR(parsed("a\uff1a 1\n"), "column 2 has a full-width character (U+FF1A) in the place of ':'");
  EXPECT_ERROR(map("b: \u201c1 m\u201d\n"), "column 4 has a typographic quotation mark");
  EXPECT_ERROR(parsed("a: 1\n\tb: 2\n"), "line 2, column 1 has a tab");
  // controls: in a comment or a text they are no fault, and another line is not blamed
  EXPECT_EQ(errorOf([&] { map("a: 1 mm  # one\u00a0millimetre\nb: 2 cm\n"); }), "no error");
  EXPECT_EQ(errorOf([&] { map("b: 1 \u03bcm\n"); }), "no error");
  EXPECT_EQ(errorOf([&] { map("# \u0441m\nb: 1 xm\n"); }).find("alphabet"), std::string::npos);
}

TEST(YamlSource, SaysWhatIsThereInThePlaceOfAFile) {
  const test::TemporaryFolder folder;
  const auto load = [&](const std::string& content) {
    YamlSource::load(folder.write("f.yaml", content), YamlLimits{});
  };
  EXPECT_ERROR(load("version https://git-lfs.github.com/spec/v1\noid sha256:00\nsize 1\n"), "is a Git LFS pointer");
  EXPECT_ERROR(load("<!doctype HTML>\n<html></html>\n"), "is a web page (HTML)");
  EXPECT_ERROR(load(std::string("\xff\xfe") + std::string("a\0", 2)), "is text in UTF-16");
  EXPECT_ERROR(load(""), "contains nothing");
  EXPECT_EQ(errorOf([&] { load("version: 1\n"); }), "no error");
}

TEST(YamlSource, RefusesTooMuch) {
  EXPECT_ERROR(YamlSource::parse("a: " + std::string(2000, 'x'), "f.yaml", YamlLimits{1000, 32}), "larger than 1000");
  EXPECT_ERROR(parsed("a: [[[[1]]]]\nb: " + repeated("[", 40) + repeated("]", 40)), "f.yaml:2: lists and maps");
  EXPECT_EQ(errorOf([] { parsed("a: " + repeated("[", 20) + repeated("]", 20)); }), "no error");
}

/// A recursive parser overflows its stack on these.
TEST(YamlSource, SurvivesPathologicalNesting) {
  constexpr int kDeep = 100000;
  for (const std::string& text :
       {repeated("[", kDeep), repeated("{", kDeep), repeated("{a: ", kDeep), repeated("[a: ", kDeep),
        repeated("- ", kDeep), repeated("? ", kDeep), repeated("a: [", kDeep), repeated("!x ", kDeep),
        repeated("&a ", kDeep), repeated("a:\n", kDeep), repeated("\"", kDeep), repeated("- - ? ", kDeep)}) {
    const std::string message = errorOf([&text] {
      const YamlSource source = parsed(text);
      source.map(source.root());
    });
    EXPECT_EQ(message.rfind("f.yaml:", 0), 0u) << text.substr(0, 10) << message;
  }
}

TEST(YamlSource, SurvivesStairsOfIndentation) {
  std::string text;
  for (int depth = 0; depth < 1200; ++depth) text += std::string(depth, ' ') + "a:\n";
  EXPECT_ERROR(parsed(text), "nested deeper than 32");
}

TEST(YamlSource, FindsDuplicateKeys) {
  const YamlSource source = parsed("a: 1\nb: 2\na: 3\n");
  EXPECT_ERROR(source.map(source.root()), "f.yaml:3: a: is given a second time");
}

TEST(YamlSource, AliasesAndMergesWork) {
  const YamlSource source = parsed("a: &x {p: 1, q: 2}\nb: *x\nc: {<<: *x, q: 5}\nd: {<<: [{r: 1}, *x]}\n");
  const std::vector<YamlField> fields = source.map(source.root());
  ASSERT_EQ(fields.size(), 4u);
  EXPECT_EQ(source.map(fields[1]).size(), 2u);
  const std::vector<YamlField> merged = source.map(fields[2]);
  ASSERT_EQ(merged.size(), 2u);
  EXPECT_EQ(merged[0].path, "c.q");
  EXPECT_EQ(source.integer(merged[0], 0, 9), 5);  // what the map itself says wins
  EXPECT_EQ(source.integer(merged[1], 0, 9), 1);
  EXPECT_EQ(source.map(fields[3]).size(), 3u);
}

TEST(YamlSource, MergingHasLimits) {
  const YamlSource circular = parsed("a: &x {<<: *x, p: 1}\n");
  EXPECT_ERROR(circular.map(circular.map(circular.root())[0]), "merges maps into each other too deeply");
  const YamlSource number = parsed("<<: 5\na: 1\n");
  EXPECT_ERROR(number.map(number.root()), "merges something with << that is not a map");
  const YamlSource many = parsed("a: &x {p: 1}\n<<: [" + repeated("*x, ", 1000) + "*x]\n");
  EXPECT_ERROR(many.map(many.root()), "merge at most 16");
  std::string levels = "x0: &x0 {p: 1}\n";  // 16^7 maps
  for (int k = 0; k < 7; ++k) {
    const std::string alias = "*x" + std::to_string(k), next = "x" + std::to_string(k + 1);
    levels += next + ": &" + next + " {<<: [" + repeated(alias + ", ", 15) + alias + "]}\n";
  }
  const YamlSource growing = parsed(levels + "<<: *x7\n");
  EXPECT_ERROR(growing.map(growing.root()), "merges maps into each other too deeply");
}

TEST(YamlSource, KeysMustBeWords) {
  const YamlSource source = parsed("a: 1\n[1, 2]: 3\n");
  EXPECT_ERROR(source.map(source.root()), "f.yaml:2: has a key that is not a word");
}

class YamlValues : public ::testing::Test {
 protected:
  YamlSource source_ = parsed("i: 7\nf: 1.5\nt: two words\nb: true\ne:\nl: [1, 2, 3]\nm: {x: 1}\nc: \"a\\tb\"\n");
  YamlField field(const std::string& key) const {
    for (const YamlField& field : source_.map(source_.root())) {
      if (field.key == key) return field;
    }
    throw std::logic_error("the test asks for a key that is not there");
  }
};

TEST_F(YamlValues, ReadsGoodOnes) {
  EXPECT_EQ(source_.integer(field("i"), 0, 10), 7);
  EXPECT_EQ(source_.quantity(field("f"), "m", 0, 2), 1.5);
  EXPECT_EQ(source_.text(field("t")), "two words");
  EXPECT_TRUE(source_.boolean(field("b")));
  EXPECT_TRUE(source_.map(field("e")).empty());
  EXPECT_EQ(source_.quantities(field("l"), 3, "m", 0, 5), (std::vector<double>{1, 2, 3}));
  EXPECT_EQ(source_.choice(field("b"), {"false", "true"}), "true");
}

TEST_F(YamlValues, RefusesBadOnesWithTheirPlace) {
  EXPECT_ERROR(source_.integer(field("i"), 0, 6), "f.yaml:1: i: '7' is out of range; write a whole number from 0 to 6");
  EXPECT_ERROR(source_.integer(field("f"), 0, 6), "f.yaml:2: f: '1.5' is not a whole number");
  EXPECT_ERROR(source_.quantity(field("f"), "Pa", 2, 3), "from 2 Pa to 3 Pa");
  EXPECT_ERROR(source_.quantity(field("i"), "rad", -M_PI, M_PI), "rad (-180 deg to 180 deg)");
  const YamlSource separated = parsed("{e: 60,000 Pa}");
  EXPECT_ERROR(separated.map(separated.root()), "f.yaml:1: 000 Pa: begins with a digit and has no value");
  EXPECT_ERROR(source_.quantity(field("t"), "Pa", 2, 3), "f.yaml:3: t: 'two words' is not a number");
  EXPECT_ERROR(source_.boolean(field("i")), "neither true nor false");
  EXPECT_ERROR(source_.text(field("e")), "f.yaml:5: e: is empty");
  EXPECT_ERROR(source_.text(field("c")), "control character");
  EXPECT_ERROR(source_.text(field("l")), "is a list");
  EXPECT_ERROR(source_.list(field("m")), "is a map, but a list is needed");
  EXPECT_ERROR(source_.map(field("i")), "is a single value, but a map is needed");
  EXPECT_ERROR(source_.quantities(field("l"), 2, "m", 0, 5), "has 3 values; write 2");
  EXPECT_ERROR(source_.quantities(field("l"), 3, "m", 0, 2), "l[2]: '3' is out of range");
  EXPECT_ERROR(source_.choice(field("t"), {"two_words", "one"}), "did you mean 'two_words'?");
}

TEST(YamlSource, ErrorsStayOneLineWhateverTheFileSays) {
  const YamlSource source = parsed("\"a\\nb\": |\n  3 mm\n  and\n  more\n");
  const YamlField field = source.map(source.root())[0];
  for (const std::string& message :
       {errorOf([&] { source.quantity(field, "m", 0, 1); }), errorOf([&] { source.integer(field, 0, 1); }),
        errorOf([&] { source.choice(field, {"x"}); })}) {
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    EXPECT_EQ(message.rfind("f.yaml:1: a?b: '3 mm?and?more?'", 0), 0u) << message;
  }
}

TEST(ShowQuantity, IsShortAndReadsBack) {
  EXPECT_EQ(showQuantity(0.1, "m"), "0.1 m");
  EXPECT_EQ(showQuantity(3, "1"), "3");
  EXPECT_EQ(std::stod(showQuantity(1.0 / 3, "")), 1.0 / 3);
}

}  // namespace
}  // namespace vibe::yaml_source_test

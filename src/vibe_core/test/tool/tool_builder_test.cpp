// what ToolModel::fromUrdf refuses, and that nothing makes it crash

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <regex>

#include "vibe_testing/expect_error.hpp"
#include "vibe_testing/scope_fixture.hpp"

namespace vibe::tool_builder_test {
namespace {

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  if (at == std::string::npos) throw std::runtime_error("scope.urdf has no '" + from + "'");
  return text.replace(at, from.size(), to);
}

// the text without everything from `begin` to the end of the next `end`
std::string without(std::string text, const std::string& begin, const std::string& end) {
  const std::size_t from = text.find(begin);
  const std::size_t to = text.find(end, from);
  if (from == std::string::npos || to == std::string::npos) throw std::runtime_error("scope.urdf has no " + begin);
  return text.erase(from, to + end.size() - from);
}

std::string errorOf(const std::string& text) {
  return vibe::errorOf([&] { ToolModel::fromUrdf(text, "scope.urdf"); });
}

int lineOf(const std::string& text, const std::string& what) {
  return static_cast<int>(std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(text.find(what)), '\n')) +
         1;
}

// one sentence: place, what and a remedy after the semicolon, one line, one full stop
void expectSentence(const std::string& message) {
  EXPECT_EQ(message.compare(0, 10, "scope.urdf"), 0) << message;
  EXPECT_NE(message.find("; "), std::string::npos) << message;
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  ASSERT_GT(message.size(), 20u);
  EXPECT_EQ(message.back(), '.') << message;
  EXPECT_NE(message[message.size() - 2], '.') << message;
}

TEST(ToolBuilder, AcceptsTheScope) {
  EXPECT_EQ(errorOf(scopeText()), "no error");
}

// A recording carries its URDF, and what is drawn of it, or hides the wall, must not be what lies on the disk today.
TEST(ToolBuilder, KeepsTheMeshesOfItsOwnText) {
  const std::string mesh = "<mesh filename=\"package://vibe_description/meshes/shaft.obj\"/>";
  const std::vector<LinkMesh> shipped = ToolModel::fromUrdf(scopeText(), "scope.urdf").meshes();
  const std::string other = replaced(scopeText(), mesh, "<mesh filename=\"other.stl\" scale=\"1 2 3\"/>");
  const ToolModel tool = ToolModel::fromUrdf(other, "scope.urdf");
  ASSERT_EQ(tool.meshes().size(), shipped.size());
  ASSERT_GT(shipped.size(), 20u);
  const auto changed = [&](const LinkMesh& one) { return one.file == "other.stl"; };
  const auto found = std::find_if(tool.meshes().begin(), tool.meshes().end(), changed);
  ASSERT_NE(found, tool.meshes().end());
  EXPECT_EQ(found->link, tool.linkIndex("scope_shaft"));
  EXPECT_EQ(found->scale, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(std::count_if(tool.meshes().begin(), tool.meshes().end(), changed), 1);
}

struct Bad {
  const char* name;
  std::string text;
  std::string message;  // with LINE for the number
  std::string line_of;  // text that is on that line
};

class BadUrdf : public testing::TestWithParam<int> {
 public:
  static std::vector<Bad> all() {
    const std::string good = scopeText();
    const std::string inputs =
        "insertion, rotation, tip_up_down, tip_left_right, helix_advance, helix_rotation, needle_driver";
    const std::string up_down = "<joint name=\"tip_up_down\"";
    const std::string segment = "<joint name=\"tip_up_down_3\"";
    const std::string mimic = "<mimic joint=\"tip_up_down\" multiplier=\"0.125\" offset=\"0\"/>";
    const std::string cap_bar =
        "<geometry><cylinder radius=\"0.0079\" length=\"0.0041\"/></geometry>\n    </collision>";
    return {
        {"Empty", "", "scope.urdf: this is not a valid URDF (Error); correct that element.", ""},
        {"NotXml", "insertion: 3", "scope.urdf: this is not a valid URDF (", ""},
        {"CutOff", good.substr(0, good.find("<parent link=\"ring_4\"/>")),
         "scope.urdf:LINE: the XML of this URDF is broken here (Error); close what is open and quote every value.",
         "<joint name=\"tip_left_right_4\""},
        {"Unquoted", replaced(good, "velocity=\"0.15\"", "velocity=\"0.15"),
         "scope.urdf:LINE: the XML of this URDF is broken here (Error); close what is open and quote every value.",
         "velocity=\"0.15"},
        {"WrongEndTag", replaced(good, "</collision>", "</colision>"),
         "scope.urdf:LINE: the XML of this URDF is broken here (", "<collision"},
        {"NotANumber", replaced(good, "lower=\"0\" upper=\"0.3\"", "lower=\"0\" upper=\"0,3\""),
         "scope.urdf: this is not a valid URDF (upper value (0,3) is not a valid float); correct that element.", ""},
        {"ContinuousJoint",
         replaced(good, "name=\"rotation\" type=\"revolute\"", "name=\"rotation\" type=\"continuous\""),
         "scope.urdf:LINE: joint 'rotation' is of a type that the tool cannot have; use fixed, revolute or prismatic.",
         "<joint name=\"rotation\""},
        {"NothingDrives", replaced(good, mimic, ""),
         "scope.urdf:LINE: joint 'tip_up_down_1' moves but nothing drives it; let it mimic one of " + inputs + ".",
         "<joint name=\"tip_up_down_1\""},
        {"MimicOfNoInput", replaced(good, mimic, "<mimic joint=\"tip_left_right_1\" multiplier=\"1\"/>"),
         "scope.urdf:LINE: joint 'tip_up_down_1' mimics 'tip_left_right_1', which is no input; let it mimic one of " +
             inputs + ".",
         "<joint name=\"tip_up_down_1\""},
        {"MimickingInput", replaced(good, up_down + " type=\"revolute\">", up_down + " type=\"revolute\">" + mimic),
         "scope.urdf:LINE: joint 'tip_up_down' is an input and cannot mimic another joint; remove its mimic element.",
         up_down},
        {"FixedInput", replaced(good, up_down + " type=\"revolute\">", up_down + " type=\"fixed\">"),
         "scope.urdf:LINE: joint 'tip_up_down' is an input and cannot be fixed; make it move.", up_down},
        {"MissingInput", replaced(good, up_down + " type=\"revolute\">", "<joint name=\"t\" type=\"fixed\">"),
         "scope.urdf: joint 'tip_up_down' is missing; the inputs are " + inputs + ".", ""},
        {"NoLimit", without(good, "<limit lower=\"0\" upper=\"0.3\"", "/>"),
         "scope.urdf:LINE: this is not a valid URDF (Joint [insertion] is of type PRISMATIC without limits); correct "
         "that "
         "element.",
         "<joint name=\"insertion\""},
        {"LimitsSwapped", replaced(good, "lower=\"0\" upper=\"0.3\"", "lower=\"0.3\" upper=\"0\""),
         "scope.urdf:LINE: joint 'insertion' has a lower limit that is not below its upper limit; write finite limits "
         "in "
         "order.",
         "<joint name=\"insertion\""},
        {"LimitNotFinite", replaced(good, "lower=\"0\" upper=\"0.3\"", "lower=\"0\" upper=\"inf\""), "scope.urdf", ""},
        {"NoSpeed", replaced(good, "velocity=\"0.15\"", "velocity=\"0\""),
         "scope.urdf:LINE: joint 'insertion' has a velocity limit that is not positive; write the greatest speed in SI "
         "units.",
         "<joint name=\"insertion\""},
        {"NoAxis", replaced(good, "<axis xyz=\"1 0 0\"/>", "<axis xyz=\"0 0 0\"/>"),
         "scope.urdf:LINE: joint 'insertion' has an axis without direction; write one of length 1.",
         "<joint name=\"insertion\""},
        {"MeshCollision",
         replaced(good, cap_bar, "<geometry><mesh filename=\"package://a/b.stl\"/></geometry>\n    </collision>"),
         "scope.urdf:LINE: link 'device_cap' has a mesh as collision shape; replace it by boxes, cylinders and "
         "spheres.",
         "<link name=\"device_cap\""},
        {"NegativeSide", replaced(good, cap_bar, "<geometry><box size=\"0.1 -1 1\"/></geometry>\n    </collision>"),
         "scope.urdf:LINE: link 'device_cap' has a collision shape whose side is not between 1e-6 m and 10 m; write it "
         "in metres.",
         "<link name=\"device_cap\""},
        {"ZeroRadius", replaced(good, cap_bar, "<geometry><sphere radius=\"0\"/></geometry>\n    </collision>"),
         "scope.urdf:LINE: link 'device_cap' has a collision shape whose radius is not between 1e-6 m and 10 m; write "
         "it in metres.",
         "<link name=\"device_cap\""},
        {"FarAway", replaced(good, "<origin xyz=\"-0.3025 0 0\"", "<origin xyz=\"-302.5 0 0\""),
         "scope.urdf:LINE: joint 'scope_shaft_mount' has an origin that is more than 10 m away; write it in metres.",
         "<joint name=\"scope_shaft_mount\""},
        {"TwoParents", replaced(good, "<child link=\"needle\"/>", "<child link=\"helix\"/>"), "scope.urdf", ""},
        {"Ring",
         replaced(good, "</robot>",
                  "<link name=\"a\"/><link name=\"b\"/>"
                  "<joint name=\"ab\" type=\"fixed\"><parent link=\"a\"/><child link=\"b\"/></joint>"
                  "<joint name=\"ba\" type=\"fixed\"><parent link=\"b\"/><child link=\"a\"/></joint></robot>"),
         "scope.urdf:LINE: link 'a' is not connected to the root; remove the ring of joints that it is in.",
         "</robot>"},
        {"SelfLoop", replaced(good, "<parent link=\"device_cap\"/>", "<parent link=\"needle\"/>"), "scope.urdf", ""},
        {"NoHelix", renamed(good, "helix"), "scope.urdf: link 'helix' is missing; add a link of that name.", ""},
        {"NoNeedle", renamed(good, "needle"), "scope.urdf: link 'needle' is missing; add a link of that name.", ""},
        {"NoTip", renamed(good, "scope_tip"), "scope.urdf: link 'scope_tip' is missing; add a link of that name.", ""},
        {"NoCamera", renamed(good, "scope_camera_optical"),
         "scope.urdf: link 'scope_camera_optical' is missing; add a link of that name.", ""},
    };
  }

 private:
  static std::string renamed(const std::string& text, const std::string& link) {
    std::string result = text;
    const std::string from = "link=\"" + link + "\"";
    for (std::size_t at = result.find(from); at != std::string::npos; at = result.find(from))
      result.replace(at, from.size(), "link=\"other\"");
    return replaced(result, "<link name=\"" + link + "\"", "<link name=\"other\"");
  }
};

TEST_P(BadUrdf, IsRefusedInOneSentence) {
  const Bad bad = all()[GetParam()];
  testing::internal::CaptureStderr();
  testing::internal::CaptureStdout();
  std::string message = errorOf(bad.text);
  EXPECT_EQ(testing::internal::GetCapturedStdout() + testing::internal::GetCapturedStderr(), "") << "prints nothing";
  expectSentence(message);
  // what an XML library says is that of its version
  message = std::regex_replace(message, std::regex("\\(Error.*\\);"), "(Error);");
  std::string expected = bad.message;
  if (!bad.line_of.empty()) expected = replaced(expected, "LINE", std::to_string(lineOf(bad.text, bad.line_of)));
  EXPECT_EQ(message.substr(0, expected.size()), expected) << message;
}

INSTANTIATE_TEST_SUITE_P(ToolBuilder, BadUrdf, testing::Range(0, static_cast<int>(BadUrdf::all().size())),
                         [](const auto& test) { return std::string(BadUrdf::all()[test.param].name); });

std::string corrupted(std::string text, std::mt19937& random) {
  const auto pick = [&](std::size_t n) { return std::uniform_int_distribution<std::size_t>(0, n - 1)(random); };
  const std::size_t edits = 1 + pick(4);
  const std::vector<std::string> shreds = {"<",
                                           ">",
                                           "\"",
                                           "/>",
                                           "nan",
                                           "-1",
                                           "1e999",
                                           "<joint name=\"x\" type=\"",
                                           "\n",
                                           "&#0;",
                                           "link",
                                           "0x1",
                                           "",
                                           "<!--",
                                           std::string(1, '\0'),
                                           "\xff"};
  for (std::size_t i = 0; i < edits; ++i) {
    const std::size_t at = pick(text.size());
    const std::size_t length = std::min(pick(60) + 1, text.size() - at);
    switch (pick(4)) {
      case 0:
        text.erase(at, length);
        break;
      case 1:
        text.insert(at, shreds[pick(shreds.size())]);
        break;
      case 2:
        text.replace(at, length, text.substr(pick(text.size()), pick(200)));
        break;
      default:
        text[at] = static_cast<char>(pick(256));
    }
  }
  return text;
}

TEST(ToolBuilder, CorruptedTextIsReadOrRefusedButNeverCrashes) {
  std::mt19937 random(2026);
  const std::string good = scopeText();
  int refused = 0;
  int read = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const std::string bad = corrupted(good, random);
    try {
      const ToolModel tool = ToolModel::fromUrdf(bad, "scope.urdf");
      std::vector<Eigen::Isometry3d> poses;
      tool.forwardKinematics({}, poses);
      for (const Eigen::Isometry3d& pose : poses) EXPECT_TRUE(pose.matrix().allFinite());
      ++read;
    } catch (const Error& error) {
      expectSentence(error.what());
      ++refused;
    }
  }
  EXPECT_GT(refused, 50);
  EXPECT_GT(read, 10) << "some edits fall into comments and colours";
}

// the XML stays well-formed, so that what is read behind the parser gets its share
TEST(ToolBuilder, CorruptedValuesAreReadOrRefusedButNeverCrash) {
  std::mt19937 random(7);
  const auto pick = [&](std::size_t n) { return std::uniform_int_distribution<std::size_t>(0, n - 1)(random); };
  const std::string good = scopeText();
  std::vector<std::size_t> quotes;
  for (std::size_t at = good.find("=\""); at != std::string::npos; at = good.find("=\"", at + 1))
    quotes.push_back(at + 2);
  const std::vector<std::string> values = {"",      "0",     "-1",         "1e308",       "1e-320",
                                           "nan",   "1 2",   "0 0 0",      "x y z",       "revolute",
                                           "fixed", "helix", "scope_base", "tip_up_down", "1e300 1e300 1e300"};
  int refused = 0;
  for (int trial = 0; trial < 300; ++trial) {
    std::string bad = good;
    const std::size_t at = quotes[pick(quotes.size())];
    bad.replace(at, good.find('"', at) - at, values[pick(values.size())]);
    try {
      const ToolModel tool = ToolModel::fromUrdf(bad, "scope.urdf");
      for (const JointLimits& limit : tool.limits()) EXPECT_LT(limit.lower, limit.upper);
      for (const ToolJoint& joint : tool.joints()) EXPECT_NEAR(joint.axis.norm(), 1, 1e-12);
      std::vector<Eigen::Isometry3d> poses;
      tool.forwardKinematics({}, poses);
      for (const Eigen::Isometry3d& pose : poses) EXPECT_TRUE(pose.translation().allFinite());
    } catch (const Error& error) {
      expectSentence(error.what());
      ++refused;
    }
  }
  EXPECT_GT(refused, 50);
  EXPECT_LT(refused, 290) << "colours may change";
}

TEST(ToolBuilder, NumbersThatAreNoneAreNeverRead) {
  const std::string good = scopeText();
  for (const char* bad : {"nan", "inf", "1e999", "1,5", "abc"}) {
    const std::string message =
        errorOf(replaced(good, "<parent link=\"scope_slide\"/>\n    <child link=\"scope_shaft\"/>\n    <origin xyz=\"",
                         "<parent link=\"scope_slide\"/>\n    <child link=\"scope_shaft\"/>\n    <origin xyz=\"" +
                             std::string(bad) + " 0 0\" ignored=\""));
    expectSentence(message);
  }
}

TEST(ToolBuilder, TwoEndSpheresMakeACapsuleAndOneDoesNot) {
  const std::string good = scopeText();
  const ToolModel tool = ToolModel::fromUrdf(good, "scope.urdf");
  const std::size_t begin = good.find("<collision>", good.find("<link name=\"segment_4\""));
  const std::size_t sphere = good.find("<collision>", begin + 1);
  const std::size_t end = good.find("</collision>", sphere) + 12;
  const ToolModel one_sphere_less = ToolModel::fromUrdf(std::string(good).erase(sphere, end - sphere), "scope.urdf");
  EXPECT_EQ(one_sphere_less.shapes().size(), tool.shapes().size() + 1) << "cylinder and sphere instead of a capsule";
}

}  // namespace
}  // namespace vibe::tool_builder_test

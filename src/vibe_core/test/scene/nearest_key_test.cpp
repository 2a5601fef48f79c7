#include "vibe_core/scene/words.hpp"

#include <gtest/gtest.h>

namespace vibe::nearest_key_test {
namespace {

const std::vector<std::string> kKeys{"stiffness", "density", "thickness", "model", "flow_limit"};

TEST(EditDistance, CountsSlips) {
  EXPECT_EQ(editDistance("", ""), 0);
  EXPECT_EQ(editDistance("abc", ""), 3);
  EXPECT_EQ(editDistance("", "abc"), 3);
  EXPECT_EQ(editDistance("kitten", "sitting"), 3);
  EXPECT_EQ(editDistance("form", "from"), 1);  // neighbours swapped count once
  EXPECT_EQ(editDistance("density", "density"), 0);
}

TEST(EditDistance, IsSymmetric) {
  for (const std::string& a : kKeys) {
    for (const std::string& b : kKeys) EXPECT_EQ(editDistance(a, b), editDistance(b, a)) << a << " " << b;
  }
}

TEST(NearestKey, FindsWhatWasMeant) {
  EXPECT_EQ(nearestKey("stifness", kKeys), "stiffness");
  EXPECT_EQ(nearestKey("Flow-Limit", kKeys), "flow_limit");
  EXPECT_EQ(nearestKey("dnesity", kKeys), "density");
}

TEST(NearestKey, IsSilentWhenNothingIsNear) {
  EXPECT_EQ(nearestKey("colour", kKeys), "");
  EXPECT_EQ(nearestKey("x", {"ab"}), "");
  EXPECT_EQ(nearestKey("anything", {}), "");
  EXPECT_NE(suggestKey("colour", kKeys).find("known are stiffness, density"), std::string::npos);
}

TEST(NearestKey, IsFastForAbsurdWords) {
  EXPECT_EQ(nearestKey(std::string(1 << 20, 'x'), kKeys), "");
}

}  // namespace
}  // namespace vibe::nearest_key_test

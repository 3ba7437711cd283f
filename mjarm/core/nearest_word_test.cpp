#include "mjarm/core/nearest_word.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "mjarm/core/rng.hpp"

namespace mjarm {
namespace {

TEST(EditDistance, CountsSingleChanges) {
  EXPECT_EQ(edit_distance("", ""), 0);
  EXPECT_EQ(edit_distance("", "abc"), 3);
  EXPECT_EQ(edit_distance("abc", ""), 3);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3);
  EXPECT_EQ(edit_distance("form", "from"), 1);
  EXPECT_EQ(edit_distance("UR5e", "ur5e"), 0);
  EXPECT_EQ(edit_distance("ca", "abc"), 3);  // of optimal string alignment
}

TEST(EditDistance, IsSymmetricAndBounded) {
  Rng rng(1);
  auto word = [&rng] {
    std::string w(rng.below(9), 'a');
    for (char& c : w) c = static_cast<char>('a' + rng.below(3));
    return w;
  };
  for (int i = 0; i < 5000; ++i) {
    const std::string a = word(), b = word();
    const int distance = edit_distance(a, b);
    ASSERT_EQ(distance, edit_distance(b, a));
    ASSERT_EQ(distance == 0, a == b);
    ASSERT_GE(distance, std::abs(static_cast<int>(a.size()) - static_cast<int>(b.size())));
    ASSERT_LE(distance, static_cast<int>(std::max(a.size(), b.size())));
  }
}

TEST(NearestWord, FindsTheSlipOfTheFinger) {
  const std::vector<std::string> known = {"fk", "ik", "plan", "path", "doctor", "model"};
  EXPECT_EQ(nearest_word("docter", known), "doctor");
  EXPECT_EQ(nearest_word("modle", known), "model");
  EXPECT_EQ(nearest_word("PLAN", known), "plan");
  EXPECT_EQ(nearest_word("f", known), "fk");
  EXPECT_EQ(nearest_word("xylophone", known), std::nullopt);
  EXPECT_EQ(nearest_word("", known), std::nullopt);
  EXPECT_EQ(nearest_word("zz", known), std::nullopt);
  EXPECT_EQ(nearest_word(std::string(100000, 'a'), known), std::nullopt);
  EXPECT_EQ(nearest_word("a", {}), std::nullopt);
}

TEST(NearestWord, KnowsWhatOthersCallIt) {
  const std::vector<std::string> options = {"--quat", "--euler", "--pos", "--out", "--quiet"};
  EXPECT_EQ(nearest_word("--rpy", options), "--euler");
  EXPECT_EQ(nearest_word("--quaternion", options), "--quat");
  EXPECT_EQ(nearest_word("--output", options), "--out");
  const std::vector<std::string> languages = {"en", "zh-CN"};
  EXPECT_EQ(nearest_word("cn", languages), "zh-CN");
  EXPECT_EQ(nearest_word("Chinese", languages), "zh-CN");
  EXPECT_EQ(nearest_word("english", languages), "en");
  // Only where it is known here.
  EXPECT_EQ(nearest_word("rpy", std::vector<std::string>{"movel", "movej"}), std::nullopt);
}

TEST(NearestWord, IsNeverTheWordItself) {
  EXPECT_EQ(nearest_word("--q", std::vector<std::string>{"--q"}), std::nullopt);
  EXPECT_EQ(nearest_word("FK", std::vector<std::string>{"fk"}), "fk");
}

TEST(NearestWord, SpeaksOnlyWhenItKnows) {
  const std::vector<std::string> known = {"hand_tcp"};
  EXPECT_EQ(did_you_mean("hand_tpc", known), " (did you mean \"hand_tcp\"?)");
  EXPECT_EQ(did_you_mean("elbow", known), "");
}

}  // namespace
}  // namespace mjarm

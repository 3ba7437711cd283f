// mjarm clone, as a user calls it.
#include <gmock/gmock.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "apps/mjarm/commands/program_test.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm::app {
namespace {

using ::testing::HasSubstr;

TEST(CloneCommand, LearnsAndTriesWhatItLearned) {
  const support::TempFolder folder;
  const auto path = [&](const char* name) { return (folder.path() / name).string(); };
  ASSERT_EQ(mjarm({"record", "reach", "--out", path("data"), "--episodes", "1", "--size", "16",
                   "--fps", "5"})
                .exit_code,
            0);
  const auto made = mjarm({"clone", path("data"), "--out", path("out"), "--epochs", "2", "--scenes",
                           "1", "--threads", "2"});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  EXPECT_THAT(made.out, HasSubstr("of 1 unseen scenes succeeded"));
  EXPECT_THAT(folder.read("out/progress.csv"), ::testing::StartsWith("epoch,loss\n1,"));
  const auto report = support::load_json(folder.path() / "out" / "report.json");
  ASSERT_EQ(report.at("trials").size(), 1);

  // The same again, where too few succeed.
  const auto again =
      mjarm({"clone", "--policy", path("out/policy.safetensors"), "--scenes", "1", "--threads", "1",
             "--out", path("again"), "--json", "--least-success", "1"});
  EXPECT_EQ(again.exit_code, 1);
  EXPECT_THAT(again.err, HasSubstr("100 % were wanted"));
  EXPECT_EQ(nlohmann::json::parse(again.out), report) << "learning and trying have no hidden state";
}

TEST(CloneCommand, RefusesWhatItCannotDoInOneLine) {
  const support::TempFolder folder;
  const std::string here = folder.path().string();
  const std::string out = (folder.path() / "out").string();
  const std::pair<std::vector<std::string>, const char*> cases[] = {
      {{"clone"}, "which demonstrations?"},
      {{"clone", here, "--policy", here}, "give one of both"},
      {{"clone", here, "--out", out}, "holds no episodes"},
      {{"clone", here, "--epochs", "0"}, "--epochs"},
      {{"clone", here, "--threads", "0"}, "--threads"},
      {{"clone", here, "--least-success", "2"}, "between 0 and 1"},
      {{"clone", "--policy", folder.write("x.safetensors", "x").string(), "--out", out},
       "x.safetensors"}};
  for (const auto& [words, what] : cases) {
    const auto refused = mjarm(words);
    EXPECT_EQ(refused.exit_code, 2) << refused.err;
    EXPECT_THAT(refused.err, HasSubstr(what));
    EXPECT_EQ(std::ranges::count(refused.err, '\n'), 1) << refused.err;
  }
}

}  // namespace
}  // namespace mjarm::app

// mjarm record and mjarm replay, as a user calls them.
#include <gmock/gmock.h>

#include <filesystem>
#include <string>
#include <vector>

#include "apps/mjarm/commands/program_test.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm::app {
namespace {

using ::testing::HasSubstr;

class RecordCommand : public ::testing::Test {
 protected:
  /// Records small pictures into the folder `data`.
  auto record(const std::vector<std::string>& more) {
    std::vector<std::string> words = {"record", "reach", "--out", data_, "--episodes", "2",
                                      "--size", "16",    "--fps", "1",   "--json"};
    words.insert(words.end(), more.begin(), more.end());
    return mjarm(words);
  }
  support::TempFolder folder_;
  std::string data_ = (folder_.path() / "data").string();
};

TEST_F(RecordCommand, MakesEpisodesThatReplay) {
  const auto made = record({});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const auto summary = nlohmann::json::parse(made.out);
  EXPECT_EQ(summary.at("made"), 2);
  EXPECT_EQ(summary.at("succeeded").get<int>() + summary.at("failed").get<int>(), 2);
  EXPECT_EQ(nlohmann::json::parse(record({}).out).at("found"), 2);
  const auto same = mjarm({"replay", data_, "--all"});
  EXPECT_EQ(same.exit_code, 0) << same.err;
  EXPECT_THAT(same.out, HasSubstr("2 of 2 episodes are the same"));

  EXPECT_THAT(mjarm({"replay", data_}).out, HasSubstr("1 of 2 episodes in " + data_));

  std::string changed = folder_.read("data/episode_000000.zip");
  const std::string name = "qvel.npy";
  changed[changed.find(name) + name.size() + 200] ^= 1;
  folder_.write("data/episode_000000.zip", changed);
  const auto differs = mjarm({"replay", data_});
  EXPECT_EQ(differs.exit_code, 1);
  EXPECT_THAT(differs.err, HasSubstr("episode_000000.zip, qvel.npy, byte 201"));
}

TEST_F(RecordCommand, RefusesWhatItCannotDoInOneLine) {
  ASSERT_EQ(record({}).exit_code, 0);
  const auto other = record({"--seed", "9"});
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_THAT(other.err, HasSubstr("--seed 1, not 9"));
  EXPECT_THAT(mjarm({"record"}).err, HasSubstr("which task?"));
  EXPECT_EQ(mjarm({"record", "juggle", "--out", data_}).exit_code, 2);
  const auto misspelt = mjarm({"record", "pik", "--out", data_});
  EXPECT_EQ(misspelt.exit_code, 2);
  EXPECT_THAT(misspelt.err, HasSubstr("did you mean \"pick_place\"?"));
  EXPECT_EQ(record({"--fps", "51"}).exit_code, 2);
  EXPECT_EQ(mjarm({"replay"}).exit_code, 2);
  EXPECT_EQ(mjarm({"replay", folder_.path().string()}).exit_code, 2);
  EXPECT_EQ(mjarm({"replay", folder_.write("x.zip", "PK").string()}).exit_code, 2);
}

}  // namespace
}  // namespace mjarm::app

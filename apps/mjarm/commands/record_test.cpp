// mjarm record and mjarm replay, as a user calls them.
#include <gmock/gmock.h>

#include <filesystem>
#include <string>
#include <vector>

#include "apps/mjarm/commands/processes_test.hpp"
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
  const auto same = mjarm({"replay", data_, "--all", "--processes", "2"});
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

TEST_F(RecordCommand, CountsTheSameInAFolderThatIsGivenWithASlash) {
  const auto before = nlohmann::json::parse(record({}).out);
  ASSERT_GT(before.at("succeeded"), 0);
  data_ += '/';
  const auto again = record({});
  ASSERT_EQ(again.exit_code, 0) << again.err;
  const auto now = nlohmann::json::parse(again.out);
  EXPECT_EQ(now.at("found"), 2);
  EXPECT_EQ(now.at("succeeded"), before.at("succeeded"));
  EXPECT_EQ(now.at("failed"), before.at("failed"));
}

TEST_F(RecordCommand, TakesSharesOfASet) {
  ASSERT_EQ(record({}).exit_code, 0);
  const std::string second = folder_.read("data/episode_000001.zip");
  const std::string share = (folder_.path() / "share").string();
  const auto made = mjarm({"record", "reach", "--out", share, "--first", "1", "--episodes", "1",
                           "--size", "16", "--fps", "1", "--json"});
  ASSERT_EQ(made.exit_code, 0) << made.err;
  EXPECT_EQ(nlohmann::json::parse(made.out).at("made"), 1);
  EXPECT_EQ(folder_.read("share/episode_000001.zip"), second);
  EXPECT_FALSE(folder_.exists("share/episode_000000.zip"));
  const auto beyond = record({"--first", "999999"});
  EXPECT_EQ(beyond.exit_code, 2);
  EXPECT_THAT(beyond.err, HasSubstr("0 to 999998"));
}

#ifdef MJARM_MPIRUN
TEST_F(RecordCommand, SeveralProcessesFillOneFolder) {
  ASSERT_EQ(record({}).exit_code, 0);
  const std::string both = (folder_.path() / "both").string();
  const std::vector<std::string> words = {"record", "reach", "--out", both, "--episodes", "2",
                                          "--size", "16",    "--fps", "1",  "--json"};
  const auto made = in_processes(2, words);
  ASSERT_EQ(made.exit_code, 0) << made.err;
  const auto summary = nlohmann::json::parse(made.out);  // of the first process alone
  EXPECT_EQ(summary.at("made"), 2);
  EXPECT_EQ(summary.at("succeeded").get<int>() + summary.at("failed").get<int>(), 2);
  for (const char* const file : {"episode_000000.zip", "episode_000001.zip", "dataset.json"}) {
    EXPECT_EQ(folder_.read(std::string("both/") + file), folder_.read(std::string("data/") + file))
        << file;
  }
  EXPECT_EQ(nlohmann::json::parse(in_processes(2, words).out).at("found"), 2);
  // What the first refuses ends all of them.
  std::vector<std::string> other = words;
  other.insert(other.end(), {"--seed", "8"});
  const auto refused = in_processes(2, other);
  EXPECT_NE(refused.exit_code, 0);
  EXPECT_THAT(refused.err, HasSubstr("--seed 1, not 8"));
}
#endif

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

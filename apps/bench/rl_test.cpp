// `mjarm bench rl`, as a user calls it.
#include <gmock/gmock.h>

#include "apps/bench/runs_test.hpp"
#include "tests/support/rounds.hpp"

namespace mjarm::app {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

std::vector<std::string> one_iteration(const support::TempFolder& folder,
                                       const std::vector<std::string>& more) {
  std::vector<std::string> arguments = {
      "bench",   "rl",   "--set", "tutorial",
      "--steps", "1024", "--out", (folder.path() / "out").string()};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

/// The answer of a peer whose policy comes so near to every goal.
std::string learned(const std::string& distances) {
  return "{\"who\":\"peer\",\"version\":\"1\",\"set\":\"tutorial\",\"timed\":\"python\",\"us\":["
         "1e6],"
         "\"curve\":[{\"steps\":512,\"seconds\":9,\"distances\":" +
         distances + "},{\"steps\":1024,\"seconds\":11,\"distances\":" + distances + "}]}\n";
}
std::string everywhere(const std::string& distance, int goals = 200) {
  std::string list = "[" + distance;
  for (int i = 1; i < goals; ++i) list += "," + distance;
  return list + "]";
}

TEST(BenchRl, EverySeedIsTrainedAndJudged) {
  if (!testing::is_long()) GTEST_SKIP() << testing::kLongOnly;
  const support::TempFolder folder;
  const json bench = bench_json(one_iteration(folder, {"--seeds", "2", "--no-timing"}));
  const json& run = run_of(bench, "mjarm", "tutorial");
  EXPECT_EQ(run.at("seeds"), 2);
  EXPECT_FALSE(run.contains("rate"));
  ASSERT_EQ(run.at("runs").size(), 2U);
  for (const json& seed : run.at("runs")) {
    ASSERT_EQ(seed.at("curve").size(), 1U);
    EXPECT_EQ(seed.at("curve")[0].at("steps"), 1024);
    EXPECT_GT(seed.at("curve")[0].at("median"), 0.01);  // nothing is learned so soon
  }
  EXPECT_NE(run.at("runs")[0].at("curve"), run.at("runs")[1].at("curve"));
  EXPECT_EQ(run.at("reached").at("2cm").at("seeds"), 0);
  EXPECT_EQ(json::parse(folder.read("out/bench.json")), bench);
  EXPECT_TRUE(folder.exists("out/tutorial-2/last.safetensors"));
}

TEST(BenchRl, PeersAreToldTheTaskAndJudgedAlike) {
  const support::TempFolder folder;
  const std::string peers = write_peers(
      folder, "\n" + learned(everywhere("0.008")),
      "for word in '\"seed\":1' '\"total_steps\":1024' '\"episode_steps\":50' '\"unseen\":[[' "
      "'\"observations\":[[' '\"qpos\":['; do grep -qF \"$word\" \"$2\" || exit 3; done");
  const json bench = bench_json(one_iteration(folder, {"--seeds", "1", "--peers", peers}));
  const json& peer = run_of(bench, "peer", "tutorial");
  EXPECT_EQ(peer.at("reached").at("1cm").at("seeds"), 1);
  EXPECT_EQ(peer.at("reached").at("1cm").at("steps"), json({512.0}));
  EXPECT_EQ(peer.at("reached").at("1cm").at("seconds"), json({9.0}));
  EXPECT_EQ(peer.at("reached").at("5mm").at("seeds"), 0);
  EXPECT_EQ(peer.at("in_the_end").at("2cm"), 1.0);
  EXPECT_GT(peer.at("ratio"), 1.0);  // it takes a second a step
  EXPECT_TRUE(folder.exists("out/curves.png"));
  EXPECT_TRUE(folder.exists("out/curves.svg"));
}

TEST(BenchRl, APeerThatFailsSaysWhy) {
  const support::TempFolder folder;
  const std::string peers = write_peers(
      folder, "\n{\"who\":\"peer\",\"version\":\"1\",\"error\":\"its environment differs\"}\n");
  const auto result = mjarm(one_iteration(folder, {"--seeds", "1", "--peers", peers}));
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("its environment differs"));
}

TEST(BenchRl, BrokenAnswersAndArgumentsAreOneLine) {
  const support::TempFolder folder;
  const std::string peers = write_peers(folder, "\n" + learned(everywhere("0.008", 7)));
  const auto broken = mjarm(one_iteration(folder, {"--seeds", "1", "--peers", peers, "--quiet"}));
  EXPECT_EQ(broken.exit_code, 1);
  EXPECT_THAT(only_line(broken), HasSubstr("distances"));
  for (const auto& [words, reason] :
       {std::pair{std::vector<std::string>{"--set", "tutoral"}, "did you mean \"tutorial\""},
        {{"--seeds", "0"}, "--seeds"},
        {{"--steps", "many"}, "--steps"}}) {
    std::vector<std::string> arguments = {"bench", "rl"};
    arguments.insert(arguments.end(), words.begin(), words.end());
    const auto refused = mjarm(arguments);
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_THAT(only_line(refused), HasSubstr(reason));
  }
}

}  // namespace
}  // namespace mjarm::app

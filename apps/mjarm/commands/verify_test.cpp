#include <gtest/gtest.h>

#include "apps/mjarm/commands/program_test.hpp"
#include "mjarm/planning/crane_problems_test.hpp"

namespace mjarm::app {
namespace {

using nlohmann::json;

using testing::crane_problems;
using testing::kCraneRound;
using testing::kCraneStraight;

class Verify : public ::testing::Test {
 protected:
  support::ProgramResult verify(const std::string& paths, const std::vector<std::string>& more = {},
                                const support::RunOptions& run = {}) {
    std::vector<std::string> all = {"verify", folder_.write("paths.json", paths).string(), "--in",
                                    problems_};
    all.insert(all.end(), more.begin(), more.end());
    return mjarm(all, run);
  }
  support::ProgramResult verify(const json& paths, const std::vector<std::string>& more = {}) {
    return verify(paths.dump(), more);
  }

  /// Kinds of the faults of the one path that is given.
  std::vector<std::string> faults(const std::string& id, const json& path,
                                  const std::vector<std::string>& more = {}) {
    std::vector<std::string> all = more;
    all.push_back("--json");
    const auto result = verify(json{{id, path}}, all);
    std::vector<std::string> kinds;
    if (result.exit_code == 2) return {result.err};
    const json report = json::parse(result.out);
    for (const json& fault : report.at("paths").at(id).at("faults")) kinds.push_back(fault["kind"]);
    EXPECT_EQ(result.exit_code, kinds.empty() ? 0 : 1) << result.err;
    EXPECT_EQ(report.at("ok"), kinds.empty());
    EXPECT_EQ(report.at("paths").at(id).at("ok"), kinds.empty());
    return kinds;
  }

  support::TempFolder folder_;
  std::string problems_ = folder_.write("problems.json", crane_problems().dump()).string();
};

using Kinds = std::vector<std::string>;

TEST_F(Verify, GoodPathsAreValid) {
  const json paths = {{"crane/open/0", kCraneStraight},
                      {"crane/plate/0", {{"ok", true}, {"path", kCraneRound}}},
                      {"crane/pillar/0", {{"ok", false}, {"reason", "none was found"}}}};
  const auto result = verify(paths);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err, "");
  EXPECT_NE(result.out.find("| plate  | 1        | 1     | 1     |"), std::string::npos)
      << result.out;
  EXPECT_NE(result.out.find("| pillar | 1        | 0     | 0     | -"), std::string::npos);
  EXPECT_NE(result.out.find("| all    | 3        | 2     | 2     |"), std::string::npos);
}

TEST_F(Verify, APlateThinnerThanTheSpacingIsFound) {
  // The ball meets the plate over 40.1 mm of its way of 2 m.
  EXPECT_EQ(faults("crane/plate/0", kCraneStraight), (Kinds{"hit", "contact"}));
  EXPECT_EQ(faults("crane/plate/0", kCraneStraight, {"--step", "0.3"}), Kinds{"hit"});
  const auto result = verify(json{{"crane/plate/0", kCraneStraight}});
  EXPECT_EQ(result.exit_code, 1);
  const std::string line = only_line(result);
  EXPECT_NE(line.find("paths.json"), std::string::npos) << line;
  EXPECT_NE(line.find("crane/plate/0"), std::string::npos) << line;
  EXPECT_NE(result.out.find("crane/plate/0: edge 0 at t = 0.63"), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("\"hand\" overlaps \"plate\""), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("MuJoCo"), std::string::npos) << result.out;
  // The table tells the deepest overlap, which is of the whole ball.
  EXPECT_NE(result.out.find("| plate  | 1        | 1     | 0     | -20.0000 mm"), std::string::npos)
      << result.out;
}

TEST_F(Verify, TheSameBytesForAnyNumberOfThreads) {
  json paths;
  for (const char* id : {"crane/open/0", "crane/plate/0", "crane/pillar/0"})
    paths[id] = kCraneStraight;
  for (const std::vector<std::string>& more : {Kinds{}, Kinds{"--json"}}) {
    std::vector<std::string> threads = more;
    threads.insert(threads.end(), {"--threads", "3"});
    const auto one = verify(paths, more), three = verify(paths, threads);
    EXPECT_EQ(one.out, three.out);
    EXPECT_EQ(one.err, three.err);
    EXPECT_EQ(one.exit_code, 1);
  }
}

TEST_F(Verify, NoPathAtAllIsAFailure) {
  EXPECT_EQ(verify(json::object()).exit_code, 1);
  const auto result = verify(json{{"crane/open/0", json::array()}});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(only_line(result).find("paths.json"), std::string::npos) << result.err;
}

TEST_F(Verify, BadFilesAreRefusedInOneLine) {
  const auto says = [&](const std::string& content, const std::string& word) {
    const auto result = verify(content);
    EXPECT_EQ(result.exit_code, 2) << content;
    EXPECT_EQ(result.out, "");
    const std::string line = only_line(result);
    EXPECT_NE(line.find("paths.json"), std::string::npos) << line;
    EXPECT_NE(line.find(word), std::string::npos) << line;
  };
  says("", "JSON");
  says("{\"crane/open/0\":[[-1,0],[1,0,0]]}", "path[1]");
  says("{\"crane/opne/0\":[[-1,0]]}", "did you mean \"crane/open/0\"");
  problems_ = folder_.write("problems.json", "{}").string();
  const auto result = verify(json::object());
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(only_line(result).find("problems.json"), std::string::npos) << result.err;
}

TEST_F(Verify, UsageErrorsNameTheOption) {
  const auto says = [&](const std::vector<std::string>& more, const std::string& word) {
    const auto result = verify(json{{"crane/open/0", kCraneStraight}}, more);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_NE(only_line(result).find(word), std::string::npos) << result.err;
  };
  says({"--step", "0"}, "--step");
  says({"--step", "wide"}, "--step");
  says({"--tol", "-1"}, "--tol");
  says({"--cylinders", "round"}, "as-given");
  says({"--threads", "0"}, "--threads");
  EXPECT_EQ(mjarm({"verify"}).exit_code, 2);
  const auto no_problems = mjarm({"verify", problems_});
  EXPECT_EQ(no_problems.exit_code, 2);
  EXPECT_NE(only_line(no_problems).find("--in"), std::string::npos);
  EXPECT_NE(only_line(mjarm({"verify", "/no/such.json", "--in", problems_})).find("/no/such.json"),
            std::string::npos);
}

TEST_F(Verify, SpeaksChinese) {
  const auto result = verify(json{{"crane/plate/0", kCraneStraight}}, {"--lang", "zh-CN"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.out.find("重叠"), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("最小间隙"), std::string::npos) << result.out;
  EXPECT_NE(result.err.find("路径无效"), std::string::npos) << result.err;
}

}  // namespace
}  // namespace mjarm::app

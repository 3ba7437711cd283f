#include <gtest/gtest.h>
#include <zlib.h>

#include "apps/mjarm/commands/two_problems_test.hpp"
#include "mjarm/planning/ompl_planners.hpp"

namespace mjarm::app {
namespace {

using nlohmann::json;
using Plan = PlanFile;

TEST_F(Plan, AnswersEveryProblemWithAProvedPath) {
  const support::ProgramResult result = plan(two_problems());
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json out = json::parse(result.out);
  ASSERT_EQ(out.size(), 2u);
  const json& round = out.at("round");
  EXPECT_EQ(round.at("ok"), true);
  EXPECT_GT(round.at("path").size(), 2u);
  EXPECT_EQ(round.at("path").front(), json({0.8, 0.0}));
  EXPECT_EQ(round.at("path").back(), json({-0.8, 0.0}));
  EXPECT_GT(round.at("cost"), 1.6);
  EXPECT_GT(round.at("us"), 0);
  EXPECT_GT(round.at("simplify_us"), 0);
  ASSERT_EQ(round.at("certificate").size() + 1, round.at("path").size());
  for (const json& edge : round.at("certificate")) {
    EXPECT_GT(edge.at("clearance"), 0);
    EXPECT_GT(edge.at("step"), 0);
    EXPECT_EQ(edge.at("pair").at(1), "post");
  }
  EXPECT_EQ(out.at("straight").at("path").size(), 2u);
}

TEST_F(Plan, SameBytesForAnyNumberOfThreads) {
  json file = two_problems();
  for (int k = 0; k < 6; ++k) {
    json more = file["problems"][0];
    more["id"] = "more" + std::to_string(k);
    more["goals"][0][1] = 0.05 * k;
    file["problems"].push_back(more);
  }
  for (const char* planner : {"rrtc", "rrtstar"}) {
    const auto one = plan(file, {"--no-timing", "--samples", "300", "--planner", planner});
    ASSERT_EQ(one.exit_code, 0) << one.err;
    EXPECT_EQ(one.out.find("us\""), std::string::npos);
    for (const char* threads : {"2", "4"}) {
      const auto many = plan(
          file, {"--no-timing", "--samples", "300", "--planner", planner, "--threads", threads});
      EXPECT_EQ(many.out, one.out);
    }
  }
}

TEST_F(Plan, ReadsGzippedFilesAndWritesAFile) {
  const std::string packed = (folder_.path() / "problems.json.gz").string();
  const std::string content = two_problems().dump();
  const gzFile file = gzopen(packed.c_str(), "wb");
  ASSERT_EQ(gzwrite(file, content.data(), static_cast<unsigned>(content.size())),
            static_cast<int>(content.size()));
  gzclose(file);
  const std::string out = (folder_.path() / "paths.json").string();
  const auto result = mjarm({"plan", "--in", packed, "--out", out, "--no-timing"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(folder_.read("paths.json"), plan(two_problems(), {"--no-timing"}).out);
}

TEST_F(Plan, OneProblemAlone) {
  const auto result = plan(two_problems(), {"--problem", "straight"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(json::parse(result.out).size(), 1u);
  const auto other = plan(two_problems(), {"--problem", "strait"});
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_NE(only_line(other).find("straight"), std::string::npos);
}

TEST_F(Plan, ProblemsWithoutAPathSayWhyAndExitWith1) {
  json file = two_problems();
  file["problems"][0]["start"] = {0, 0};
  file["problems"][1]["goals"] = json::array();
  const auto result = plan(file);
  EXPECT_EQ(result.exit_code, 1);
  const json out = json::parse(result.out);
  EXPECT_EQ(out.at("round").at("ok"), false);
  EXPECT_NE(out.at("round").at("reason").get<std::string>().find("\"post\""), std::string::npos);
  EXPECT_EQ(out.at("straight").at("ok"), false);
  EXPECT_NE(only_line(result).find("2 of 2"), std::string::npos);
}

TEST_F(Plan, ASmallBudgetIsSpentAndSaysSo) {
  json file = two_problems();
  file["problems"].erase(1);
  const auto result = plan(file, {"--samples", "1"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(only_line(result).find("within 1 samples"), std::string::npos);
}

TEST_F(Plan, ATimeBudgetGivesAPathNoLonger) {
  const auto fast = json::parse(plan(two_problems()).out);
  const auto result = plan(two_problems(), {"--time-budget", "5ms"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_LE(json::parse(result.out).at("round").at("cost").get<double>(),
            fast.at("round").at("cost").get<double>() + 1e-9);
}

TEST_F(Plan, PlannersOfOmplSolveWhatOursSolve) {
  if (ompl_version().empty()) GTEST_SKIP() << "built without OMPL (libompl-dev)";
  for (const char* planner : {"ompl", "ompl:RRTConnect", "ompl:BITstar"}) {
    const auto one =
        plan(two_problems(), {"--no-timing", "--samples", "500", "--planner", planner});
    ASSERT_EQ(one.exit_code, 0) << one.err;
    EXPECT_TRUE(one.err.empty()) << one.err;  // OMPL itself says nothing
    EXPECT_GT(json::parse(one.out).at("round").at("path").size(), 2u);
    EXPECT_EQ(json::parse(one.out).at("straight").at("path").size(), 2u);
    const auto two = plan(two_problems(), {"--no-timing", "--samples", "500", "--planner", planner,
                                           "--threads", "2"});
    EXPECT_EQ(two.out, one.out);
  }
}

TEST_F(Plan, PlannersOfOmplThatAreNotBuiltInSayHowToGetThem) {
  if (!ompl_version().empty()) GTEST_SKIP() << "OMPL is built in";
  const auto result = plan(two_problems(), {"--planner", "ompl"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(only_line(result).find("libompl-dev"), std::string::npos);
}

TEST_F(Plan, MisspeltPlannersGetTheNearestWord) {
  for (const auto& [given, meant] : std::vector<std::pair<std::string, std::string>>{
           {"rrtcc", "\"rrtc\""}, {"ompl:BITstra", "\"ompl:BITstar\""}, {"omlp", "\"ompl\""}}) {
    const auto result = plan(two_problems(), {"--planner", given});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_NE(only_line(result).find("did you mean " + meant), std::string::npos) << result.err;
  }
}

TEST_F(Plan, OneLineNamesWhatIsWrongWithAFile) {
  json file = two_problems();
  file["problems"][0]["obstacles"][0]["type"] = "cylindre";
  const auto result = plan(file);
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_TRUE(result.out.empty());
  const std::string line = only_line(result);
  for (const char* part : {"problems.json", "problems[0]", "obstacles[0]", "cylindre"}) {
    EXPECT_NE(line.find(part), std::string::npos) << line;
  }
}

TEST_F(Plan, FilesThatAreNoneAreOneLine) {
  EXPECT_EQ(mjarm({"plan"}).exit_code, 2);
  const auto missing = mjarm({"plan", "--in", "no/such/file.json"});
  EXPECT_EQ(missing.exit_code, 2);
  EXPECT_NE(only_line(missing).find("no/such/file.json"), std::string::npos);
  const std::string broken = folder_.write("broken.json", "{\"robot\":").string();
  const auto half = mjarm({"plan", "--in", broken});
  EXPECT_EQ(half.exit_code, 2);
  EXPECT_NE(only_line(half).find("broken.json"), std::string::npos);
  // The first bytes of a gzipped file, and then something else.
  const std::string damaged = folder_.write("damaged.gz", "\x1f\x8b\x08 no packed data").string();
  const auto packed = mjarm({"plan", "--in", damaged});
  EXPECT_EQ(packed.exit_code, 2);
  EXPECT_NE(only_line(packed).find("damaged.gz"), std::string::npos);
}

TEST_F(Plan, WrongOptionsAreNamed) {
  const std::string in = write(two_problems());
  const std::vector<std::pair<std::string, std::string>> wrong{{"--planner", "rrt"},
                                                               {"--seed", "-1"},
                                                               {"--samples", "0"},
                                                               {"--time-budget", "-1s"},
                                                               {"--time-limit", "-1s"},
                                                               {"--time-limit", "2h"},
                                                               {"--threads", "none"},
                                                               {"--time-budget",
                                                                "3"
                                                                "h"}};
  for (const auto& [option, value] : wrong) {
    const auto result = mjarm({"plan", "--in", in, option, value});
    EXPECT_EQ(result.exit_code, 2) << option;
    EXPECT_NE(only_line(result).find(option), std::string::npos) << result.err;
  }
}

}  // namespace
}  // namespace mjarm::app

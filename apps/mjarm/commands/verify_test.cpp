#include <gtest/gtest.h>

#include <cmath>

#include "apps/mjarm/view/program_test.hpp"

namespace mjarm::app {
namespace {

using nlohmann::json;

/// A slide along x and a hinge about z that carry one ball of 20 mm, half a metre off; and a post
/// that stands still.
json two_joint_robot() {
  const json straight = {1, 0, 0, 0};
  return {{"name", "crane"},
          {"base", "world"},
          {"joint_names", {"rail", "arm"}},
          {"lower", {-2, -3}},
          {"upper", {2, 3}},
          {"joints",
           {{{"name", "rail"},
             {"type", "prismatic"},
             {"parent", "world"},
             {"child", "carriage"},
             {"xyz", {0, 0, 0.5}},
             {"quat", straight},
             {"axis", {1, 0, 0}},
             {"limits", {-2, 2}}},
            {{"name", "arm"},
             {"type", "revolute"},
             {"parent", "carriage"},
             {"child", "hand"},
             {"xyz", {0, 0, 0}},
             {"quat", straight},
             {"axis", {0, 0, 1}},
             {"limits", {-3, 3}}}}},
          {"spheres",
           {{{"link", "world"}, {"center", {0, 1.5, 0.5}}, {"radius", 0.1}},
            {{"link", "hand"}, {"center", {0, 0.5, 0}}, {"radius", 0.02}}}},
          {"self_collision_link_pairs", json::array({json::array({"world", "hand"})})}};
}

json problem(const std::string& id, const std::string& scene, const json& obstacles) {
  return {{"id", id},
          {"scene", scene},
          {"index", 0},
          {"start", {-1, 0}},
          {"goals", {{5, 5}, {1, 0}}},
          {"obstacles", obstacles},
          {"valid", true},
          {"start_free", true},
          {"goals_free", {false, true}}};
}

json box(const std::string& name, const json& pos, const json& half) {
  return {{"name", name}, {"type", "box"}, {"pos", pos}, {"quat", {1, 0, 0, 0}}, {"half", half}};
}

/// Nothing in the way; a plate of 0.1 mm across the straight way; a pillar beside it, whose
/// replacement by a box has corners that its own round shape has not.
json three_problems() {
  json pillar = {
      {"name", "pillar"},      {"type", "cylinder"},
      {"pos", {0, 0.67, 0.5}}, {"quat", {0.92387953, 0, 0, 0.38268343}},  // an eighth of a turn
      {"radius", 0.12},        {"length", 1},
      {"vamp_as", "box"}};
  return {{"format", "test"},
          {"robot", two_joint_robot()},
          {"problems",
           {problem("crane/open/0", "open", json::array()),
            problem("crane/plate/0", "plate",
                    json::array({box("plate", {0.3, 0.5, 0.5}, {5e-5, 0.2, 0.2})})),
            problem("crane/pillar/0", "pillar", json::array({pillar}))}}};
}

const json kStraight = {{-1, 0}, {1, 0}};
/// The hand turns away, passes on the other side, and turns back.
const json kRound = {{-1, 0}, {-1, 3}, {1, 3}, {1, 0}};

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
  std::string problems_ = folder_.write("problems.json", three_problems().dump()).string();
};

using Kinds = std::vector<std::string>;

TEST_F(Verify, GoodPathsAreValid) {
  const json paths = {{"crane/open/0", kStraight},
                      {"crane/plate/0", {{"ok", true}, {"path", kRound}}},
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
  EXPECT_EQ(faults("crane/plate/0", kStraight), (Kinds{"hit", "contact"}));
  EXPECT_EQ(faults("crane/plate/0", kStraight, {"--step", "0.3"}), Kinds{"hit"});
  const auto result = verify(json{{"crane/plate/0", kStraight}});
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

TEST_F(Verify, EndsMustBeStartAndGoal) {
  const std::string id = "crane/open/0";
  EXPECT_EQ(faults(id, {{-0.9, 0}, {1, 0}}), Kinds{"start"});
  EXPECT_EQ(faults(id, {{-1, 0}, {1, 0.001}}), Kinds{"goal"});
  EXPECT_EQ(faults(id, {{-1, 5e-5}, {1, 5e-5}}), Kinds{});
  EXPECT_EQ(faults(id, json::array({json::array({-1, 0})})), Kinds{"goal"});
}

TEST_F(Verify, LimitsMustBeKept) {
  const std::string id = "crane/open/0";
  EXPECT_EQ(faults(id, {{-1, 0}, {0, 3.01}, {1, 0}}), Kinds{"limits"});
  EXPECT_EQ(faults(id, {{-1, 0}, {0, 3.00005}, {1, 0}}), Kinds{});
  const auto result = verify(json{{id, {{-1, 0}, {0, 3.01}, {1, 0}}}});
  EXPECT_NE(result.out.find("row 1: joint \"arm\""), std::string::npos) << result.out;
}

TEST_F(Verify, LinksMustNotOverlapEachOther) {
  json problems = three_problems();
  problems["robot"]["spheres"][0]["center"] = {0, 0.6, 0.5};
  problems_ = folder_.write("problems.json", problems.dump()).string();
  EXPECT_EQ(faults("crane/open/0", kStraight), (Kinds{"hit", "contact"}));
  problems["robot"]["self_collision_link_pairs"] = json::array();
  problems_ = folder_.write("problems.json", problems.dump()).string();
  EXPECT_EQ(faults("crane/open/0", kStraight), Kinds{});
}

TEST_F(Verify, CostAndCertificatesMustAgree) {
  const std::string id = "crane/pillar/0";
  const auto with = [](const json& patch) {
    json path = {{"ok", true}, {"path", kRound}, {"cost", 8.0}};
    path.merge_patch(patch);
    return path;
  };
  EXPECT_EQ(faults(id, with(json::object())), Kinds{});
  EXPECT_EQ(faults(id, with({{"cost", 7.9}})), Kinds{"cost"});
  const json bare = {{"step", 0.5}, {"clearance", 1}, {"t", 0.5}};
  EXPECT_EQ(faults(id, with({{"certificate", {bare, bare, bare}}})), Kinds{});
  EXPECT_EQ(faults(id, with({{"certificate", {bare, bare}}})), Kinds{"certificate"});
  const auto second = [&](const json& patch) {
    json changed = bare;
    changed.merge_patch(patch);
    return with({{"certificate", {bare, changed, bare}}});
  };
  EXPECT_EQ(faults(id, second({{"step", 2.1}})), Kinds{"certificate"});
  EXPECT_EQ(faults(id, second({{"t", 1.5}})), Kinds{"certificate"});
  // Half-way the ball is below the middle of the pillar's box, whose corner looks down.
  const double y = 0.5 * std::cos(3), x = -0.5 * std::sin(3);
  const double truth = 0.67 - 0.12 * std::sqrt(2) - y - 0.02;
  ASSERT_LT(std::abs(x), 0.1);
  const auto stated = [&](double clearance, const std::string& other = "pillar") {
    return second({{"clearance", clearance}, {"t", 0.5 - x / 2}, {"pair", {"hand", other}}});
  };
  EXPECT_EQ(faults(id, stated(truth - 1e-5)), Kinds{});
  EXPECT_EQ(faults(id, stated(truth + 1e-4)), Kinds{"certificate"});
  EXPECT_EQ(faults(id, stated(truth - 1e-2)), Kinds{"certificate"});
  EXPECT_EQ(faults(id, stated(truth, "pilar")), Kinds{"certificate"});
}

TEST_F(Verify, CylindersAsGivenOrReplaced) {
  // The corner of the box that replaces the pillar is in the way, the pillar itself is not.
  const json past = {{-1, 0}, {-1, 0.1}, {1, 0.1}, {1, 0}};
  EXPECT_EQ(faults("crane/pillar/0", past), (Kinds{"hit", "contact"}));
  EXPECT_EQ(faults("crane/pillar/0", past, {"--cylinders", "as-given"}), Kinds{});
  // The overlap is of 17 mm.
  EXPECT_EQ(faults("crane/pillar/0", past, {"--tol", "1mm"}), (Kinds{"hit", "contact"}));
  EXPECT_EQ(faults("crane/pillar/0", past, {"--tol", "18mm"}), Kinds{});
}

TEST_F(Verify, TheSameBytesForAnyNumberOfThreads) {
  json paths;
  for (const char* id : {"crane/open/0", "crane/plate/0", "crane/pillar/0"}) paths[id] = kStraight;
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
  const auto entry = [](const std::string& value) { return "{\"crane/open/0\":" + value + "}"; };
  says("", "JSON");
  says("[]", "object");
  says(entry("[[-1,0],[NaN,0]]"), "JSON");
  says(entry("[[-1,0],[1e999,0]]"), "range");
  says(entry("[[-1,0],[null,0]]"), "path[1]");
  says(entry("[[-1,0],[1,0,0]]"), "path[1]");
  says(entry("[[-1,0],7]"), "path[1]");
  says(entry("7"), "crane/open/0");
  says(entry("{\"ok\":true}"), "\"path\"");
  says(entry("{\"ok\":1}"), "\"ok\"");
  says(entry("{\"path\":3}"), "crane/open/0");
  says(entry("{\"path\":[[-1,0]],\"cost\":\"much\"}"), "\"cost\"");
  says(entry("{\"path\":[[-1,0]],\"certificate\":4}"), "\"certificate\"");
  says(entry("{\"path\":[[-1,0]],\"certificate\":[{}]}"), "certificate[0]");
  says(entry("{\"path\":[[-1,0]],\"certificate\":[{\"step\":1,\"clearance\":1,\"t\":0,"
             "\"pair\":[1,2]}]}"),
       "\"pair\"");
  says("{\"crane/opne/0\":[[-1,0]]}", "did you mean \"crane/open/0\"");
  problems_ = folder_.write("problems.json", "{}").string();
  const auto result = verify(json::object());
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(only_line(result).find("problems.json"), std::string::npos) << result.err;
}

TEST_F(Verify, UsageErrorsNameTheOption) {
  const auto says = [&](const std::vector<std::string>& more, const std::string& word) {
    const auto result = verify(json{{"crane/open/0", kStraight}}, more);
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
  const auto result = verify(json{{"crane/plate/0", kStraight}}, {"--lang", "zh-CN"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.out.find("重叠"), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("最小间隙"), std::string::npos) << result.out;
  EXPECT_NE(result.err.find("路径无效"), std::string::npos) << result.err;
}

}  // namespace
}  // namespace mjarm::app

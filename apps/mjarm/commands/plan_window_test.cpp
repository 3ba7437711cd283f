// mjarm plan --picture and --view, as a user calls them.
#include <gtest/gtest.h>

#include <cstdlib>
#include <thread>

#include "apps/mjarm/commands/program_test.hpp"
#include "mjarm/view/turn_test.hpp"

namespace mjarm::app {
namespace {

using nlohmann::json;

/// An arm of one link and a post on the short way, or nothing.
constexpr const char* kTurner = R"({"robot": {"name": "turner", "base": "base",
  "joints": [{"name": "j", "type": "revolute", "parent": "base", "child": "link", "xyz": [0, 0, 0],
              "quat": [1, 0, 0, 0], "axis": [0, 0, 1], "limits": [-2.9, 2.9]},
             {"name": "k", "type": "revolute", "parent": "link", "child": "end", "xyz": [0.4, 0, 0],
              "quat": [1, 0, 0, 0], "axis": [0, 1, 0], "limits": [-2, 2]}],
  "spheres": [{"link": "link", "center": [0.2, 0, 0], "radius": 0.08},
              {"link": "end", "center": [0.1, 0, 0], "radius": 0.06},
              {"link": "end", "center": [0.3, 0, 0], "radius": 0.06}],
  "self_collision_link_pairs": []},
 "problems": [{"id": "round", "start": [-0.8, 0], "goals": [[0.8, 0]],
   "obstacles": [{"name": "post", "type": "box", "pos": [0.6, 0, -0.1], "quat": [1, 0, 0, 0],
                  "half": [0.05, 0.05, 0.3]}]},
  {"id": "inside", "start": [0, 0], "goals": [[0.8, 0]],
   "obstacles": [{"name": "post", "type": "box", "pos": [0.6, 0, 0], "quat": [1, 0, 0, 0],
                  "half": [0.05, 0.05, 0.3]}]}]})";

class PlanShown : public ::testing::Test {
 protected:
  support::ProgramResult plan(std::vector<std::string> more,
                              const support::RunOptions& options = {}) {
    more.insert(more.begin(), {"plan", "--in", in_});
    return support::run_program(MJARM_PROGRAM, more, options);
  }
  [[nodiscard]] std::string file(const char* name) const {
    return (folder_.path() / name).string();
  }
  static bool draws() {
    const json doctor = json::parse(mjarm({"doctor", "--json"}).out);
    return std::ranges::any_of(doctor.at("gl"),
                               [](const json& way) { return way.at("works").get<bool>(); });
  }
  support::TempFolder folder_;
  std::string in_ = folder_.write("problems.json", kTurner).string();
};

TEST_F(PlanShown, APictureBesideTheSameAnswer) {
  if (!draws()) GTEST_SKIP() << "no OpenGL on this machine";
  const auto plain = plan({"--problem", "round", "--no-timing"});
  const auto drawn =
      plan({"--problem", "round", "--no-timing", "--picture", file("a.png"), "--size", "320x200"});
  ASSERT_EQ(drawn.exit_code, 0) << drawn.err;
  EXPECT_EQ(drawn.out, plain.out);
  EXPECT_NE(drawn.err.find("post"), std::string::npos) << drawn.err;
  EXPECT_NE(drawn.err.find("320 x 200"), std::string::npos) << drawn.err;
  const std::string bytes = folder_.read("a.png");
  ASSERT_GT(bytes.size(), 5000U);
  EXPECT_EQ(bytes.substr(1, 3), "PNG");
  EXPECT_EQ(bytes.substr(16, 8), std::string("\0\0\1\x40\0\0\0\xc8", 8));
  // Quiet, and another camera: another picture.
  const auto other = plan({"--problem", "round", "--picture", file("b.png"), "--size", "320x200",
                           "--camera", "10deg,-20deg,2", "--quiet"});
  ASSERT_EQ(other.exit_code, 0) << other.err;
  EXPECT_EQ(other.err, "");
  EXPECT_NE(folder_.read("b.png"), folder_.read("a.png"));
}

TEST_F(PlanShown, WhatMakesNoSenseIsOneLine) {
  const auto refused = [&](const std::vector<std::string>& more, const char* part, int code = 2) {
    const auto result = plan(more);
    EXPECT_EQ(result.exit_code, code) << part;
    EXPECT_NE(only_line(result).find(part), std::string::npos) << result.err;
  };
  refused({"--picture", file("a.png")}, "--problem ID, \"round\"");
  refused({"--view"}, "--problem ID");
  refused({"--problem", "round", "--picture", "a.jpg"}, "a.jpg");
  refused({"--problem", "round", "--picture", file("a.png"), "--view"}, "--view");
  refused({"--problem", "round", "--size", "30x30"}, "--size");
  refused({"--problem", "round", "--picture", file("a.png"), "--size", "0x9"}, "--size");
  refused({"--problem", "round", "--picture", file("a.png"), "--seconds", "3"}, "--view");
  refused({"--problem", "round", "--picture", file("a.png"), "--quality", "best"}, "low");
  refused({"--problem", "round", "--picture", file("a.png"), "--camera", "nose"}, "nose");
  refused({"--problem", "round", "--view", "--seconds", "-1"}, "--seconds");
  // No path, no picture.
  refused({"--problem", "inside", "--picture", file("a.png")}, "post", 1);
  EXPECT_FALSE(std::filesystem::exists(file("a.png")));
}

TEST_F(PlanShown, WithoutADisplayPointsAtPictures) {
  const auto result = plan({"--problem", "round", "--view"},
                           {.environment = {{"DISPLAY", ""}, {"WAYLAND_DISPLAY", ""}}});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(only_line(result).find("--picture"), std::string::npos) << result.err;
}

TEST_F(PlanShown, AWindowOpensAndCloses) {
  if (std::getenv("DISPLAY") == nullptr) GTEST_SKIP() << "DISPLAY is not set";
  const testing::Turn turn;
  const auto result = plan({"--problem", "round", "--view", "--seconds", "1", "--size", "500x400"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
}

}  // namespace
}  // namespace mjarm::app

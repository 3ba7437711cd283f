#include "mjarm/execution/report.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace mjarm {
namespace {

Report full_report() {
  Report report;
  report.name = "ellipse";
  report.ok = true;
  report.control = "computed_torque";
  report.duration = 1.0 / 3.0;
  report.steps = 167;
  report.done = 1;
  report.max_joint_step = 0.1;
  report.path_error = PathError{.max = 1e-5, .rms = 3e-6, .at = 0.4, .coverage = 1};
  report.rtf = 100;
  return report;
}

TEST(Report, HoldsWhatTheFileFormatPromises) {
  const auto json = nlohmann::json::parse(to_json(full_report()));
  EXPECT_TRUE(json["ok"].get<bool>());
  EXPECT_EQ(json["path_error_max"].get<double>(), 1e-5);
  EXPECT_EQ(json["path_error_rms"].get<double>(), 3e-6);
  EXPECT_EQ(json["coverage"].get<double>(), 1.0);
  EXPECT_EQ(json["max_joint_step"].get<double>(), 0.1);
  EXPECT_TRUE(json.contains("limits_used"));
  EXPECT_TRUE(json["first_contact"].is_null());
}

TEST(Report, TellsWhatWasHeldAndHow) {
  Report report = full_report();
  EXPECT_FALSE(nlohmann::json::parse(to_json(report)).contains("held"));
  report.held.resize(2);
  report.held[0].joint.name = "base";
  report.held[0].moved = 1e-9;
  report.held[1].joint.name = "neck";
  report.held[1].joint.actuator = ArmActuator{.name = "pan"};
  report.held[1].moved = 0.25;
  EXPECT_EQ(nlohmann::json::parse(to_json(report))["held"],
            nlohmann::json::parse(R"([{"joint": "base", "by": "lock", "moved": 1e-9},
                {"joint": "neck", "by": "actuator", "actuator": "pan", "moved": 0.25}])"));
}

TEST(Report, TellsWhereTheToolIsSlowerThanAsked) {
  Report report = full_report();
  EXPECT_FALSE(nlohmann::json::parse(to_json(report)).contains("speed_dips"));
  report.speed_dips.push_back({{.s_from = 0.1,
                                .s_to = 0.2,
                                .t_from = 1,
                                .t_to = 2,
                                .least = 0.05,
                                .s_least = 0.15,
                                .joint = 5,
                                .limit = SpeedLimit::jerk,
                                .kind = SingularKind::wrist},
                               "wrist_3_joint"});
  report.min_singular_value = 0.01;
  const auto json = nlohmann::json::parse(to_json(report));
  ASSERT_EQ(json["speed_dips"].size(), 1U);
  const auto& dip = json["speed_dips"][0];
  EXPECT_EQ(dip["s"], nlohmann::json({0.1, 0.2}));
  EXPECT_EQ(dip["t"], nlohmann::json({1.0, 2.0}));
  EXPECT_EQ(dip["least"], 0.05);
  EXPECT_EQ(dip["joint"], "wrist_3_joint");
  EXPECT_EQ(dip["limit"], "jerk");
  EXPECT_EQ(dip["singularity"], "wrist");
  EXPECT_EQ(json["min_singular_value"], 0.01);
}

TEST(Report, NumbersKeepEveryBit) {
  const auto json = nlohmann::json::parse(to_json(full_report()));
  EXPECT_EQ(json["duration"].get<double>(), 1.0 / 3.0);
}

TEST(Report, TellsTheFactsOfADemo) {
  Report report = full_report();
  report.facts = {{"peak_joint_speed", 3.1}, {"naive_peak_joint", "wrist_1_joint"}};
  const auto json = nlohmann::json::parse(to_json(report));
  EXPECT_EQ(json["peak_joint_speed"].get<double>(), 3.1);
  EXPECT_EQ(json["naive_peak_joint"], "wrist_1_joint");
}

TEST(Report, WallClockOnlyInRtf) {
  Report report = full_report();
  report.rtf.reset();
  EXPECT_FALSE(nlohmann::json::parse(to_json(report)).contains("rtf"));
}

TEST(Report, FailureSaysWhyAndHowToMendIt) {
  Report report;
  report.reason = "inner_void";
  report.detail = "inside the cylinder";
  report.unreachable = {37, 38};
  report.shift = Eigen::Vector3d(0, -0.05, 0);
  const auto json = nlohmann::json::parse(to_json(report));
  EXPECT_FALSE(json["ok"].get<bool>());
  EXPECT_EQ(json["reason"], "inner_void");
  EXPECT_EQ(json["unreachable"].size(), 2U);
  EXPECT_EQ(json["fix"]["shift"][1].get<double>(), -0.05);
}

TEST(Report, BytesThatAreNotUtf8DoNotBreakTheFile) {
  Report report = full_report();
  report.model = "\xff\xfe";
  EXPECT_TRUE(nlohmann::json::accept(to_json(report)));
}

}  // namespace
}  // namespace mjarm

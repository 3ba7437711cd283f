#include "mjarm/model/check.hpp"

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <set>

#include "mjarm/model/find_arm.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm {
namespace {

const Finding* find(const CheckReport& report, CheckCode code) {
  const auto found = std::find_if(report.findings.begin(), report.findings.end(),
                                  [&](const Finding& f) { return f.code == code; });
  return found != report.findings.end() ? &*found : nullptr;
}

TEST(CheckModel, NamesOfCodesAreWordsAndDiffer) {
  std::set<std::string_view> names;
  for (int i = 0; i <= static_cast<int>(CheckCode::overlap_by_design); ++i) {
    const std::string_view word = name(static_cast<CheckCode>(i));
    EXPECT_FALSE(word.empty());
    EXPECT_TRUE(names.insert(word).second) << word;
    EXPECT_EQ(word.find_first_not_of("abcdefghijklmnopqrstuvwxyz_"), std::string_view::npos);
  }
}

/// Where the tool comes to rest under its servos, simulated: how far from where they are told [m].
double simulated_sag(const Model& model, const Arm& arm) {
  const mjModel* m = model.raw();
  const std::unique_ptr<mjData, void (*)(mjData*)> d(mj_makeData(m), mj_deleteData);
  mj_resetDataKeyframe(m, d.get(), mj_name2id(m, mjOBJ_KEY, "home"));
  const int site = mj_name2id(m, mjOBJ_SITE, arm.tip.c_str());
  mj_forward(m, d.get());
  const Eigen::Vector3d told(d->site_xpos + 3 * site);
  for (int i = 0; i < 5000; ++i) mj_step(m, d.get());
  return (Eigen::Vector3d(d->site_xpos + 3 * site) - told).norm();
}

TEST(CheckModel, SagIsThatOfASimulation) {
  for (const char* robot : {"ur5e", "panda"}) {
    const auto file = find_model_file(robot);
    ASSERT_TRUE(file) << file.error().what;
    const auto model = Model::load(*file);
    ASSERT_TRUE(model) << model.error().what;
    const auto arm = find_arm(*model);
    ASSERT_TRUE(arm) << arm.error().what;
    const auto report = check_model(*file);
    ASSERT_TRUE(report) << report.error().what;
    const Finding* sag = find(*report, CheckCode::servo_sag);
    ASSERT_NE(sag, nullptr);
    double home = 0;
    double stretched = 0;
    ASSERT_EQ(std::sscanf(sag->what.c_str(),
                          "at rest the tool hangs %lf mm low at home, %lf mm stretched out", &home,
                          &stretched),
              2)
        << sag->what;
    // Linear against exact: the sag turns the links by 0.01 rad.
    EXPECT_NEAR(1e-3 * home, simulated_sag(*model, *arm), 0.03e-3 * home) << robot;
    EXPECT_GT(stretched, home);
  }
}

TEST(CheckModel, WorstComesFirst) {
  const support::TempFolder folder;
  const auto file = folder.write("bad.xml", R"(<mujoco>
  <compiler angle="radian"/>
  <option timestep="0.1"/>
  <asset><material name="ghost"/></asset>
  <worldbody>
    <body name="one">
      <joint name="turn" axis="0 0 1" range="-90 90"/>
      <geom size="0.1"/>
    </body>
  </worldbody>
</mujoco>)");
  const auto report = check_model(file);
  ASSERT_TRUE(report) << report.error().what;
  EXPECT_TRUE(report->loads);
  ASSERT_GE(report->findings.size(), 3u);
  EXPECT_EQ(report->findings[0].code, CheckCode::degrees_for_radians);
  EXPECT_EQ(report->findings[0].line, 7);
  EXPECT_TRUE(std::is_sorted(report->findings.begin(), report->findings.end(),
                             [](const auto& a, const auto& b) { return a.grade < b.grade; }));
  EXPECT_EQ(report->count(Grade::error), 1);
}

TEST(CheckModel, FilesThatCannotBeReadAreRefused) {
  const support::TempFolder folder;
  EXPECT_FALSE(check_model(folder.path() / "missing.xml"));
  EXPECT_FALSE(check_model(folder.write("empty.xml", "")));
  EXPECT_FALSE(check_model(folder.write("broken.xml", "<mujoco><worldbody></mujoco>")));
}

TEST(CheckModel, WhatDoesNotLoadIsSearchedAllTheSame) {
  const support::TempFolder folder;
  folder.write("part.xml", "<mujocoinclude>\n  <body name=\"one\"/>\n</mujocoinclude>");
  const auto report = check_model(folder.write("main.xml", R"(<mujoco>
  <worldbody>
    <body name="one"/>
    <include file="part.xml"/>
  </worldbody>
</mujoco>)"));
  ASSERT_TRUE(report) << report.error().what;
  EXPECT_FALSE(report->loads);
  const Finding* doubled = find(*report, CheckCode::name_doubled);
  ASSERT_NE(doubled, nullptr);
  EXPECT_EQ(std::filesystem::path(doubled->file).filename(), "part.xml");
  EXPECT_EQ(doubled->line, 2);
  EXPECT_NE(find(*report, CheckCode::not_loadable), nullptr);
}

TEST(CheckModel, AnUnknownTipIsRefused) {
  const auto file = find_model_file("ur5e");
  ASSERT_TRUE(file) << file.error().what;
  EXPECT_FALSE(check_model(*file, {.tip = "nose"}));
  const auto report = check_model(*file, {.tip = "ee_link"});
  ASSERT_TRUE(report) << report.error().what;
  EXPECT_NE(find(*report, CheckCode::arm_found)->what.find("ee_link"), std::string::npos);
}

}  // namespace
}  // namespace mjarm

#include "mjarm/collision/contact_rules.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "mjarm/collision/cover.hpp"
#include "mjarm/collision/exact.hpp"
#include "mjarm/collision/fast_check.hpp"
#include "mjarm/collision/verify_edge.hpp"
#include "mjarm/core/language_scope.hpp"
#include "mjarm/core/rng.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/model/find_arm.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm {
namespace {

/// Three links, a hand of two fingers, a table, and the XML of a bar, in the hand or in the world.
/// Neighbours collide as well: else a bar that is a part of the hand could not hit the forearm.
std::string crane(const std::string& in_hand, const std::string& in_world) {
  return R"(<mujoco><compiler angle="radian"/><option>
    <flag filterparent="disable"/></option><worldbody>
    <geom name="table" type="box" size="0.5 0.5 0.02" pos="0.6 0 -0.3"/>
    <geom name="post" type="capsule" size="0.03 0.3" pos="0.5 0.5 0.1"/>
    <body name="upper"><joint name="j1" axis="0 0 1" range="-3 3" limited="true"/>
      <geom name="upper" type="capsule" fromto="0.05 0 0 0.3 0 0" size="0.03"/>
      <body name="fore" pos="0.35 0 0"><joint name="j2" axis="0 1 0" range="-2.5 2.5" limited="true"/>
        <geom name="fore" type="capsule" fromto="0.05 0 0 0.25 0 0" size="0.03"/>
        <body name="hand" pos="0.3 0 0"><joint name="j3" axis="0 1 0" range="-2.5 2.5" limited="true"/>
          <geom name="palm" type="box" size="0.02 0.06 0.03" pos="0.03 0 0"/>
          <geom name="finger1" type="box" size="0.04 0.01 0.02" pos="0.09 0.05 0"/>
          <geom name="finger2" type="box" size="0.04 0.01 0.02" pos="0.09 -0.05 0"/>
          <site name="tcp" pos="0.1 0 0"/>)" +
         in_hand + "</body></body></body>" + in_world +
         R"(</worldbody><actuator><position joint="j1"/><position joint="j2"/><position joint="j3"/>
  </actuator></mujoco>)";
}

constexpr const char* kBar = R"(<geom name="bar" type="box" size="0.02 0.045 0.15"/>)";

struct Crane {
  Model model;
  Arm arm;
};

Crane load(const std::string& xml) {
  const support::TempFolder folder;
  Model model = Model::load(folder.write("crane.xml", xml)).value();
  Arm arm = find_arm(model, {.tip = "tcp"}).value();
  return {std::move(model), std::move(arm)};
}

/// The bar stands on the table, and can be taken.
const Crane& free_bar() {
  static const Crane kCrane = load(crane(
      "", std::string(R"(<body name="bar" pos="0.6 0.2 -0.13"><freejoint/>)") + kBar + "</body>"));
  return kCrane;
}

/// The bar is a part of the hand, as MuJoCo itself would have it.
const Crane& grown_bar() {
  static const Crane kCrane = load(crane(
      std::string(R"(<body name="bar" pos="0.1 0 0.03" euler="0.2 0 0.1">)") + kBar + "</body>",
      ""));
  return kCrane;
}

/// As in grown_bar(); MuJoCo turns about x, then y, then z of the moved frame.
ContactRules attached_bar() {
  const Eigen::Matrix3d R = rotation_exp({0.2, 0, 0}) * rotation_exp(Eigen::Vector3d(0, 0, 0.1));
  return {.attached = {{"bar", {{0, 0, 0.03}, R}}}};
}

JointVec draw(const Arm& arm, Rng& rng) {
  JointVec q(arm.dof());
  for (int k = 0; k < arm.dof(); ++k) q[k] = rng.uniform(arm.limits.lower[k], arm.limits.upper[k]);
  return q;
}

TEST(ContactRules, AnAttachedBodyCollidesAsAPartOfTheHandDoes) {
  const Crane &free = free_bar(), &grown = grown_bar();
  ExactChecker attached(free.model, free.arm, {.rules = attached_bar()});
  ExactChecker part(grown.model, grown.arm);
  ExactChecker empty(free.model, free.arm);
  Rng rng(3);
  int hits = 0, by_bar = 0;
  for (int k = 0; k < 2000; ++k) {
    const JointVec q = draw(free.arm, rng);
    const auto a = attached.check(as_span(q)), b = part.check(as_span(q));
    ASSERT_TRUE(a && b);
    ASSERT_EQ(a->free, b->free);
    ASSERT_EQ(attached.is_free(as_span(q)), b->free);
    hits += !b->free;
    by_bar += !b->free && empty.is_free(as_span(q));
    ASSERT_EQ(a->contacts.size(), b->contacts.size());
    for (std::size_t i = 0; i < a->contacts.size(); ++i) {
      EXPECT_NEAR(a->contacts[i].depth, b->contacts[i].depth, 1e-6);
    }
    ASSERT_EQ(a->nearest.has_value(), b->nearest.has_value());
    if (!b->nearest) continue;
    EXPECT_NEAR(a->nearest->distance, b->nearest->distance, 1e-5);
  }
  EXPECT_GT(hits, 200);
  EXPECT_GT(by_bar, 5);
}

TEST(ContactRules, TheCoverHoldsTheBodyToo) {
  const Crane& crane = free_bar();
  const ModelCover cover = cover_model(crane.model, crane.arm, {.rules = attached_bar()}).value();
  const ModelCover without = cover_model(crane.model, crane.arm).value();
  const auto stands = [](const ModelCover& made) {
    return std::ranges::count(made.scene.solids, "bar", &Obstacle::name);
  };
  EXPECT_EQ(stands(without), 1);
  EXPECT_EQ(stands(cover), 0);
  EXPECT_GT(cover.spheres.size(), without.spheres.size());
  const FastChecker fast =
      FastChecker::create(FastRobot::create(crane.arm, cover.spheres).value(), cover.scene).value();
  ExactChecker exact(crane.model, crane.arm, {.rules = attached_bar()});
  Rng rng(5);
  int free = 0;
  for (int k = 0; k < 20000; ++k) {
    const JointVec q = draw(crane.arm, rng);
    if (!fast.is_free(as_span(q))) continue;
    ++free;
    ASSERT_TRUE(exact.is_free(as_span(q)));
  }
  EXPECT_GT(free, 2000);
}

TEST(ContactRules, PairsThatMayTouchDoNotCount) {
  const Crane& crane = free_bar();
  // The bar held so that it cuts into the forearm, wherever the arm is.
  ContactRules rules{.attached = {{"bar", {{-0.25, 0, 0.05}, Eigen::Matrix3d::Identity()}}}};
  const std::vector<double> q{0, 0, 0.1};
  const auto names = [&] {
    std::vector<std::string> out;
    const auto report = ExactChecker(crane.model, crane.arm, {.rules = rules}).check(q);
    for (const ContactPoint& contact : report.value().contacts) {
      out.push_back(contact.pair.geom1 + "-" + contact.pair.geom2);
    }
    return out;
  };
  const auto fast_free = [&] {
    const ModelCover cover = cover_model(crane.model, crane.arm, {.rules = rules}).value();
    return FastChecker::create(FastRobot::create(crane.arm, cover.spheres).value(), cover.scene)
        .value()
        .is_free(q);
  };
  ASSERT_EQ(names(), std::vector<std::string>{"fore-bar"});
  EXPECT_FALSE(fast_free());
  rules.allowed = {{"bar", "upper"}};
  EXPECT_EQ(names().size(), 1u);
  rules.allowed = {{"bar", "fore"}};
  EXPECT_TRUE(names().empty());
  EXPECT_TRUE(fast_free());
  rules.allowed = {{"fore", "bar"}};  // in either order
  EXPECT_TRUE(names().empty());
}

/// A foot that the first link is sunk in, as if the user had said that the two may touch.
TEST(ContactRules, WhatOverlapsByDesignDoesNotCount) {
  const Crane crane = load(::mjarm::crane(
      "", R"(<geom name="foot" type="cylinder" size="0.15 0.02" pos="0 0 -0.04"/>)"));
  ASSERT_EQ(crane.arm.overlapping.size(), 1U);
  Arm bare = crane.arm;
  bare.overlapping.clear();
  const ContactRules said{.allowed = {{{"upper", "foot"}}}};
  ExactChecker exact(crane.model, crane.arm), allowed(crane.model, bare, {.rules = said});
  ExactChecker strict(crane.model, bare);
  ModelMarch march = ModelMarch::create(crane.model, crane.arm).value();
  const ModelCover cover = cover_model(crane.model, crane.arm).value();
  const FastChecker fast =
      FastChecker::create(FastRobot::create(crane.arm, cover.spheres).value(), cover.scene)
          .value()
          .looking_closer(cover.solids);
  Rng rng(8);
  int free = 0, proved = 0, on_foot = 0;
  for (int k = 0; k < 2000; ++k) {
    const JointVec q = draw(crane.arm, rng);
    const bool is_free = exact.is_free(as_span(q));
    ASSERT_EQ(is_free, allowed.is_free(as_span(q)));
    ASSERT_FALSE(strict.is_free(as_span(q)));
    ASSERT_TRUE(is_free || !fast.is_free(as_span(q)));
    const auto edge = march.verify_edge(as_span(q), as_span(q)).value();
    ASSERT_TRUE(is_free ? edge.verdict != EdgeVerdict::hit : edge.verdict != EdgeVerdict::free);
    proved += edge.verdict == EdgeVerdict::free;
    free += is_free && fast.is_free(as_span(q));
    const auto report = exact.check(as_span(q)).value();
    on_foot += std::ranges::any_of(report.contacts, [](const ContactPoint& contact) {
      return contact.pair.geom1 == "foot" || contact.pair.geom2 == "foot";
    });
  }
  EXPECT_GT(free, 500);
  EXPECT_GT(proved, free);
  EXPECT_GT(on_foot, 2) << "other links are still held against the foot";
}

TEST(ContactRules, HeldWhereItIsItStaysThere) {
  const Crane& crane = free_bar();
  const std::vector<double> q{0.2, 0.3, 0.1};
  const auto attached = attach_in_place(crane.model, crane.arm, "bar", q);
  ASSERT_TRUE(attached);
  const Pose X_WB = fk(crane.arm, q) * attached->X_TB;
  EXPECT_LT((X_WB.p - Eigen::Vector3d(0.6, 0.2, -0.13)).norm(), 1e-9);
  EXPECT_LT((X_WB.R - Eigen::Matrix3d::Identity()).norm(), 1e-9);
}

TEST(ContactRules, PosturesOfAnotherSizeAreRefused) {
  const Crane& crane = free_bar();
  EXPECT_FALSE(attach_in_place(crane.model, crane.arm, "bar", {}));
  const std::vector<double> nan(3, std::numeric_limits<double>::quiet_NaN());
  EXPECT_FALSE(attach_in_place(crane.model, crane.arm, "bar", nan));
}

TEST(ContactRules, WordsAndPosesThatAreNoneAreNamed) {
  const LanguageScope english(Language::english);
  const Crane& crane = free_bar();
  const auto why = [&](const ContactRules& rules) {
    const Result<void> fine = check_contact_rules(crane.model, crane.arm, rules);
    const std::string what = fine ? std::string() : fine.error().what;
    // The checkers say the same.
    const std::vector<double> q{0, 0, 0};
    ExactChecker exact(crane.model, crane.arm, {.rules = rules});
    const auto report = exact.check(q);
    EXPECT_EQ(report ? std::string() : report.error().what, what);
    EXPECT_TRUE(fine || !exact.is_free(q));
    const auto cover = cover_model(crane.model, crane.arm, {.rules = rules});
    EXPECT_EQ(cover ? std::string() : cover.error().what, what);
    return what;
  };
  const Pose here;
  EXPECT_EQ(why({}), "");
  EXPECT_EQ(why({.attached = {{"baar", here}}}),
            "there is no body \"baar\" to be held (did you mean \"bar\"?)");
  EXPECT_EQ(why({.attached = {{"fore", here}}}),
            "the body \"fore\" has no free joint: it cannot be held");
  EXPECT_EQ(why({.attached = {{"bar", here}, {"bar", here}}}),
            "the body \"bar\" carries the arm, or is held twice");
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(why({.attached = {{"bar", {{nan, 0, 0}, here.R}}}}).find("pose"), std::string::npos);
  EXPECT_NE(why({.attached = {{"bar", {here.p, 2 * here.R}}}}).find("pose"), std::string::npos);
  EXPECT_EQ(why({.allowed = {{"tabel", "bar"}}}),
            "there is no body or geom \"tabel\" that may touch (did you mean \"table\"?)");
}

}  // namespace
}  // namespace mjarm

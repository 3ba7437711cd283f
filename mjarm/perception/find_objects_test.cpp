#include "mjarm/perception/find_objects.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "mjarm/perception/look_test.hpp"
#include "tests/support/rounds.hpp"

namespace mjarm::perception {
namespace {

using mjarm::testing::rounds;
using namespace mjarm::perception::testing;

constexpr double kDegree = std::numbers::pi / 180;

/// One look for all tests: what costs is the model and OpenGL.
Look& look() {
  static Look one;
  return one;
}

#define SKIP_WITHOUT_OPENGL() \
  if (!look().works()) GTEST_SKIP() << "no OpenGL"

// The oracle is where the simulation has the bodies; `mjarm bench pick --set seen` measures more.
void every_placement_is_found(bool with_tag, double max_mm, double max_deg) {
  Result<ObjectFinder> finder = ObjectFinder::create(objects_of(look().model(), with_tag));
  ASSERT_TRUE(finder) << finder.error().what;
  Rng rng(11), noise(12);
  const std::size_t bodies = with_tag ? 1 : 3;
  for (int i = 0; i < rounds(2, 100, 1); ++i) {
    const Places places = random_places(rng, with_tag ? kBox : static_cast<Body>(i % 3));
    const Result<FoundScene> found = finder->find(look()(places, noise));
    ASSERT_TRUE(found) << found.error().what;
    ASSERT_TRUE(found->table);
    EXPECT_NEAR(found->table->offset, 0, 1e-3);
    for (std::size_t k = 0; k < bodies; ++k) {
      const auto& [name, pose] = found->objects[k];
      if (!places.bodies[k]) {
        EXPECT_FALSE(pose) << "look " << i << ": " << name << " is not there";
        continue;
      }
      ASSERT_TRUE(pose) << "look " << i << ": " << name << ": " << describe(pose.error().code);
      EXPECT_EQ(pose->by_tag, with_tag && k == 0);
      EXPECT_LT(pose->residual, 0.004);
      const Pose& X_WO = *places.bodies[k];
      EXPECT_LT(1000 * (pose->X_WO.p - X_WO.p).norm(), max_mm) << "look " << i << ": " << name;
      EXPECT_LT(turn_between(k, with_tag, pose->X_WO.R, X_WO.R) / kDegree, max_deg)
          << "look " << i << ": " << name;
    }
  }
}

TEST(FindObjects, EveryPlacementIsFoundByItsTag) {
  SKIP_WITHOUT_OPENGL();
  if (!has_tags()) GTEST_SKIP() << "built without AprilTag (libapriltag-dev)";
  every_placement_is_found(true, 2, 1);
}

TEST(FindObjects, EveryPlacementIsFoundByItsShape) {
  SKIP_WITHOUT_OPENGL();
  every_placement_is_found(false, 3, 2);
}

ObjectFinder finder_of(bool with_tag, const FindOptions& options = {}) {
  return std::move(*ObjectFinder::create(objects_of(look().model(), with_tag), options));
}

/// Three objects, seen from above.
Places all_in_sight(Rng& rng) {
  Places out = random_places(rng, kBox);
  while (!out.bodies[kCan]) out = random_places(rng, kBox);
  return out;
}

TEST(FindObjects, TheSameFrameGivesTheSameAnswer) {
  SKIP_WITHOUT_OPENGL();
  Rng rng(3), noise(4);
  const render::RgbdFrame frame = look()(all_in_sight(rng), noise);
  ObjectFinder first = finder_of(false);
  const FoundScene once = *first.find(frame);
  const FoundScene again = *first.find(frame);
  const FoundScene other = *finder_of(false).find(frame);
  for (std::size_t k = 0; k < 3; ++k) {
    ASSERT_TRUE(once.objects[k].pose);
    EXPECT_EQ(once.objects[k].pose->X_WO.p, again.objects[k].pose->X_WO.p);
    EXPECT_EQ(once.objects[k].pose->X_WO.R, other.objects[k].pose->X_WO.R);
  }
}

// What is not there is not found, and what nobody knows is measured.
TEST(FindObjects, AStrangerIsMeasuredAndNothingElseIsFound) {
  SKIP_WITHOUT_OPENGL();
  Places places{.eye = eye_at({0, 0, 0}, 0.6, 0.4, 1)};
  places.bodies[3] = standing(0.02, 0.01, 0.02, 0.5);
  Rng noise(4);
  const FoundScene found = *finder_of(false).find(look()(places, noise));
  for (const FoundObject& object : found.objects) {
    ASSERT_FALSE(object.pose) << object.name;
    EXPECT_EQ(object.pose.error().code, FindErrc::not_seen);
  }
  ASSERT_EQ(found.unknown.size(), 1U);
  const UnknownObject& stranger = found.unknown[0];
  EXPECT_EQ(stranger.kind, UnknownObject::Kind::box);
  EXPECT_LT((stranger.X_WO.p - places.bodies[3]->p).norm(), 0.002);
  const auto [small, large] = std::minmax(stranger.size.x(), stranger.size.y());
  EXPECT_NEAR(small, 0.06, 0.002);
  EXPECT_NEAR(large, 0.12, 0.002);
  EXPECT_NEAR(stranger.size.z(), 0.04, 0.002);
}

TEST(FindObjects, WhatIsKnownToBeThereIsNoObject) {
  SKIP_WITHOUT_OPENGL();
  Result<ObjectFinder> finder = ObjectFinder::create(objects_of(look().model(), false));
  ASSERT_TRUE(finder) << finder.error().what;
  Rng noise(21);
  Places places{.eye = eye_at({0, 0, 0.03}, 0.7, 0.4, 0.9)};
  places.bodies[3] = standing(0.12, 0, 0.02, 0.3);  // the stranger
  const render::RgbdFrame without_can = look()(places, noise);
  places.bodies[1] = standing(0, 0, 0.05, 0);
  const render::RgbdFrame frame = look()(places, noise);
  const auto unknown = finder->find(frame);
  ASSERT_TRUE(unknown) << unknown.error().what;
  EXPECT_EQ(unknown->unknown.size(), 1u);
  const auto known = finder->find(frame, without_can.depth);
  ASSERT_TRUE(known) << known.error().what;
  ASSERT_TRUE(known->objects[1].pose);
  EXPECT_LT((known->objects[1].pose->X_WO.p - places.bodies[1]->p).norm(), 2e-3);
  EXPECT_TRUE(known->unknown.empty());
  EXPECT_FALSE(finder->find(frame, std::vector<float>(3, 1.0F)));
}

TEST(FindObjects, AnUnknownCanIsACylinder) {
  SKIP_WITHOUT_OPENGL();
  Places places{.eye = eye_at({0, 0, 0}, 0.6, 2, 0.8)};
  places.bodies[1] = standing(0.02, 0.01, 0.05, 0);
  Rng noise(4);
  ObjectFinder nobody = std::move(*ObjectFinder::create({}));
  const FoundScene found = *nobody.find(look()(places, noise));
  ASSERT_EQ(found.unknown.size(), 1U);
  EXPECT_EQ(found.unknown[0].kind, UnknownObject::Kind::cylinder);
  EXPECT_NEAR(found.unknown[0].size.x(), 0.066, 0.001);
  EXPECT_NEAR(found.unknown[0].size.z(), 0.1, 0.001);
  EXPECT_LT((found.unknown[0].X_WO.p - places.bodies[1]->p).norm(), 0.001);
}

/// No pose, or the right one.
void never_wrong(const FoundScene& found, const Places& places, bool with_tag, int look_number) {
  for (std::size_t k = 0; k < 3; ++k) {
    const auto& [name, pose] = found.objects[k];
    if (!pose) continue;
    ASSERT_TRUE(places.bodies[k]) << "look " << look_number << ": " << name << " is not there";
    EXPECT_LT((pose->X_WO.p - places.bodies[k]->p).norm(), 0.003) << look_number << ": " << name;
    EXPECT_LT(turn_between(k, with_tag, pose->X_WO.R, places.bodies[k]->R), 2 * kDegree)
        << look_number << ": " << name;
  }
}

// Something between camera and object hides a part of it: its pose or a reason, never a wrong pose.
TEST(FindObjects, WhatIsHiddenInPartHasItsPoseOrAReason) {
  SKIP_WITHOUT_OPENGL();
  ObjectFinder finder = finder_of(false);
  Rng rng(21), noise(22);
  int found_ones = 0, refused = 0;
  for (int i = 0; i < rounds(2, 100, 1); ++i) {
    Places places{.eye = eye_at({0, 0, 0.03}, rng.uniform(0.5, 0.8), rng.uniform(-3, 3),
                                rng.uniform(0.6, 1.4))};
    const std::size_t k = rng.below(3);
    places.bodies[k] = standing(0, 0, std::array{0.03, 0.05, 0.0}[k], rng.uniform(-3, 3));
    const Eigen::Vector3d beside(rng.uniform(-0.06, 0.06), rng.uniform(-0.06, 0.06), 0);
    places.bodies[3] =
        Pose{.p = 0.25 * places.eye.p + beside, .R = from_euler({rng.uniform(-3, 3), 0, 1})};
    const FoundScene found = *finder.find(look()(places, noise));
    never_wrong(found, places, false, i);
    ++(found.objects[k].pose ? found_ones : refused);
  }
  EXPECT_GT(found_ones + refused, 0);
}

// Two known objects side by side, often in touch: depth alone has them in one piece.
TEST(FindObjects, ObjectsInTouchAreToldApartByTheirHue) {
  SKIP_WITHOUT_OPENGL();
  ObjectFinder finder = finder_of(false);
  Rng rng(31), noise(32);
  std::size_t found_ones = 0;
  const int looks = rounds(4, 100, 2);
  for (int i = 0; i < looks; ++i) {
    Places places{.eye = eye_at({0, 0, 0.03}, rng.uniform(0.5, 0.8), rng.uniform(-3, 3), 1)};
    const double angle = rng.uniform(-3, 3);
    const double apart = rng.uniform(0.065, 0.1);
    places.bodies[0] = standing(0, 0, 0.03, rng.uniform(-3, 3));
    places.bodies[1] = standing(apart * std::cos(angle), apart * std::sin(angle), 0.05, 0);
    const FoundScene found = *finder.find(look()(places, noise));
    never_wrong(found, places, false, i);
    for (std::size_t k = 0; k < 2; ++k) found_ones += found.objects[k].pose ? 1 : 0;
  }
  EXPECT_GE(found_ones, static_cast<std::size_t>(1.8 * looks));
}

TEST(FindObjects, ATagOnAnotherFaceOrOfAnotherSizeOrSeenTwiceGivesNoPose) {
  SKIP_WITHOUT_OPENGL();
  if (!has_tags()) GTEST_SKIP() << "built without AprilTag (libapriltag-dev)";
  Places places{.eye = eye_at({0, 0, 0.03}, 0.5, 0.4, 1)};
  places.bodies[0] = standing(0, 0, 0.03, 0.3);
  Rng noise(4);
  render::RgbdFrame frame = look()(places, noise);
  const auto code = [&](const ObjectTag& tag, const render::RgbdFrame& seen) {
    std::vector<KnownObject> objects{*known_object(look().model(), "box")};
    objects[0].tag = tag;
    ObjectFinder finder = std::move(*ObjectFinder::create(objects));
    const FoundScene found = *finder.find(seen);
    return found.objects[0].pose ? std::string() : describe(found.objects[0].pose.error().code);
  };
  const ObjectTag right{.id = kTag, .size = kTagSize, .X_OT = kTagOnBox};
  EXPECT_EQ(code(right, frame), "");
  ObjectTag side = right;
  side.X_OT = {.p = {0.0502, 0, 0}, .R = from_euler({0, std::numbers::pi / 2, 0})};
  EXPECT_EQ(code(side, frame), describe(FindErrc::disagrees));
  ObjectTag small = right;
  small.size = 0.05;
  EXPECT_EQ(code(small, frame), describe(FindErrc::wrong_size));
  ObjectTag other = right;
  other.id = kTag + 1;
  EXPECT_EQ(code(other, frame), describe(FindErrc::not_seen));
  render::RgbdFrame blind = frame;
  std::fill(blind.depth.begin(), blind.depth.end(), std::numeric_limits<float>::quiet_NaN());
  EXPECT_EQ(code(right, blind), describe(FindErrc::no_depth));
  // The same tag once more, painted into a corner of the picture.
  const render::Image tag = *tag_picture(kTag, 8);
  for (int y = 0; y < tag.height; ++y) {
    std::copy_n(tag.rgb.begin() + 3 * y * tag.width, 3 * tag.width,
                frame.color.rgb.begin() + 3 * ((y + 20) * frame.color.width + 20));
  }
  EXPECT_EQ(code(right, frame), describe(FindErrc::tag_twice));
}

TEST(FindObjects, FramesWithoutDepthFindNothingAndUnfitOnesAreRefused) {
  SKIP_WITHOUT_OPENGL();
  Rng rng(3), noise(4);
  const render::RgbdFrame frame = look()(all_in_sight(rng), noise);
  ObjectFinder finder = finder_of(false);
  for (const float nothing : {0.0F, std::numeric_limits<float>::quiet_NaN(), -1.0F,
                              std::numeric_limits<float>::infinity()}) {
    render::RgbdFrame blind = frame;
    std::fill(blind.depth.begin(), blind.depth.end(), nothing);
    const FoundScene found = *finder.find(blind);
    EXPECT_FALSE(found.table);
    EXPECT_TRUE(found.unknown.empty());
    for (const FoundObject& object : found.objects) EXPECT_FALSE(object.pose);
  }
  // A pixel here and there that has none does no harm.
  render::RgbdFrame holes = frame;
  for (float& z : holes.depth)
    z = rng.uniform() < 0.2 ? std::numeric_limits<float>::quiet_NaN() : z;
  const FoundScene through_holes = *finder.find(holes);
  for (const FoundObject& object : through_holes.objects) EXPECT_TRUE(object.pose) << object.name;
  const auto refused = [&](auto change) {
    render::RgbdFrame bad = frame;
    change(bad);
    const Result<FoundScene> found = finder.find(bad);
    return !found && found.error().code == Errc::bad_input;
  };
  EXPECT_TRUE(refused([](auto& f) { f.depth.pop_back(); }));
  EXPECT_TRUE(refused([](auto& f) { f.color.width = 640; }));
  EXPECT_TRUE(refused([](auto& f) { f.color.rgb.clear(); }));
  EXPECT_TRUE(refused([](auto& f) { f.intrinsics.fx = 0; }));
  EXPECT_TRUE(refused([](auto& f) { f.X_WC.p.x() = std::numeric_limits<double>::quiet_NaN(); }));
  EXPECT_TRUE(refused([](auto& f) { f = {}; }));
}

/// The can and its twin, as good as each other.
ObjectFinder twins_finder() {
  KnownObject can = *known_object(look().model(), "can");
  can.kind = "can";
  KnownObject twin = can;
  twin.name = "twin";
  return std::move(*ObjectFinder::create({can, twin}));
}

// Objects of one kind are each found, and names follow where they were believed to be.
TEST(FindObjects, EachOfAKindIsFoundAndKeepsItsName) {
  SKIP_WITHOUT_OPENGL();
  Places places{.eye = eye_at({0, 0, 0.03}, 0.6, 0.4, 1)};
  const Pose here = standing(-0.06, 0.02, 0.05, 0), there = standing(0.07, 0, 0.05, 0);
  places.bodies[1] = here;
  places.bodies[kTwin] = there;
  Rng noise(4);
  const render::RgbdFrame frame = look()(places, noise);
  ObjectFinder finder = twins_finder();
  const auto is_at = [](const FoundObject& object, const Pose& X_WO) {
    return object.pose && (object.pose->X_WO.p - X_WO.p).norm() < 0.001;
  };
  using Believed = std::vector<std::optional<Pose>>;
  for (const auto& [believed, first_is_here] : {std::pair<Believed, bool>{{here, there}, true},
                                                {{there, here}, false},
                                                {{{}, here}, false}}) {
    const FoundScene found = *finder.find(frame, {}, believed);
    EXPECT_EQ(found.objects[0].name, "can");
    EXPECT_TRUE(is_at(found.objects[0], first_is_here ? here : there));
    EXPECT_TRUE(is_at(found.objects[1], first_is_here ? there : here));
    EXPECT_TRUE(found.unknown.empty());
  }
  const FoundScene unnamed = *finder.find(frame);
  EXPECT_NE(is_at(unnamed.objects[0], here), is_at(unnamed.objects[1], here));
  EXPECT_NE(is_at(unnamed.objects[0], there), is_at(unnamed.objects[1], there));
  const auto refused = finder.find(frame, {}, Believed(3));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Errc::bad_input);
}

// One piece has one name, whatever is believed.
TEST(FindObjects, OfAKindTheOneThatIsHiddenHasAReason) {
  SKIP_WITHOUT_OPENGL();
  Places places{.eye = eye_at({0, 0, 0.03}, 0.6, 0, 0.3)};
  places.bodies[1] = standing(0.05, 0, 0.05, 0);
  places.bodies[kTwin] = standing(-0.05, 0, 0.05, 0);  // behind it
  Rng noise(4);
  const Pose front = *places.bodies[1], back = *places.bodies[kTwin];
  const render::RgbdFrame both = look()(places, noise);
  places.bodies[kTwin].reset();
  const render::RgbdFrame one = look()(places, noise);
  ObjectFinder finder = twins_finder();
  for (const auto& [frame, why] :
       {std::pair(&both, FindErrc::occluded), {&one, FindErrc::not_seen}}) {
    for (const std::size_t seen : {0, 1}) {
      const std::vector<std::optional<Pose>> believed{seen == 0 ? front : back,
                                                      seen == 0 ? back : front};
      const FoundScene found = *finder.find(*frame, {}, believed);
      ASSERT_TRUE(found.objects[seen].pose);
      EXPECT_LT((found.objects[seen].pose->X_WO.p - front.p).norm(), 0.001);
      ASSERT_FALSE(found.objects[1 - seen].pose);
      EXPECT_EQ(found.objects[1 - seen].pose.error().code, why);
    }
  }
}

// Where more is seen than there is, nobody knows which is which.
TEST(FindObjects, MoreOfAKindThanThereAreAreAmbiguous) {
  SKIP_WITHOUT_OPENGL();
  Places places{.eye = eye_at({0, 0, 0.03}, 0.6, 0.4, 1)};
  places.bodies[1] = standing(-0.06, 0.02, 0.05, 0);
  places.bodies[kTwin] = standing(0.07, 0, 0.05, 0);
  Rng noise(4);
  KnownObject can = *known_object(look().model(), "can");
  can.kind = "can";
  ObjectFinder finder = std::move(*ObjectFinder::create({can}));
  const FoundScene found = *finder.find(look()(places, noise));
  ASSERT_FALSE(found.objects[0].pose);
  EXPECT_EQ(found.objects[0].pose.error().code, FindErrc::ambiguous);
}

// Two objects of one shape of which nobody says that they are one kind cannot be told apart, and
// say so.
TEST(FindObjects, TwinsAreAmbiguous) {
  SKIP_WITHOUT_OPENGL();
  Places places{.eye = eye_at({0, 0, 0.03}, 0.6, 0.4, 1)};
  places.bodies[1] = standing(0, 0, 0.05, 0);
  Rng noise(4);
  KnownObject can = *known_object(look().model(), "can");
  KnownObject twin = can;
  twin.name = "twin";
  ObjectFinder finder = std::move(*ObjectFinder::create({can, twin}));
  const FoundScene found = *finder.find(look()(places, noise));
  for (const FoundObject& object : found.objects) {
    ASSERT_FALSE(object.pose);
    EXPECT_EQ(object.pose.error().code, FindErrc::ambiguous);
    ASSERT_TRUE(object.pose.error().best);
    EXPECT_LT((object.pose.error().best->X_WO.p - places.bodies[1]->p).norm(), 0.001);
  }
}

TEST(FindObjects, ObjectsAndOptionsThatCannotBeAreNamed) {
  const KnownObject good{.name = "cube", .surface = box_surface({0.02, 0.02, 0.02})};
  const auto why = [](std::vector<KnownObject> objects, const FindOptions& options = {}) {
    const Result<ObjectFinder> made = ObjectFinder::create(std::move(objects), options);
    return made ? std::string() : made.error().what;
  };
  EXPECT_EQ(why({good}), "");
  EXPECT_NE(why({good, good}).find("cube"), std::string::npos);
  EXPECT_NE(why({{.name = "none", .surface = {}}}).find("none"), std::string::npos);
  KnownObject bad = good;
  bad.surface.triangles[0][1] = 99;
  EXPECT_NE(why({bad}), "");
  bad = good;
  bad.surface.vertices[3].x() = std::numeric_limits<double>::infinity();
  EXPECT_NE(why({bad}), "");
  EXPECT_NE(why({{.name = "dust", .surface = box_surface({1e-4, 1e-4, 1e-4})}}).find("dust"),
            std::string::npos);
  bad = good;
  bad.tag = ObjectTag{.id = 587, .size = 0.05};
  EXPECT_NE(why({bad}).find("587"), std::string::npos);
  KnownObject one = good, other{.name = "brick", .surface = box_surface({0.02, 0.02, 0.03})};
  one.kind = other.kind = "block";
  EXPECT_NE(why({one, other}).find("\"brick\""), std::string::npos);
  other.surface = good.surface;
  EXPECT_EQ(why({one, other}), "");
  other.tag = ObjectTag{.id = 1, .size = 0.02};
  EXPECT_NE(why({one, other}).find("tag"), std::string::npos);
  EXPECT_NE(why({good}, {.depth_sigma = -1}).find("depth_sigma"), std::string::npos);
  EXPECT_NE(why({good}, {.table = Plane{.normal_W = {0, 0, 2}}}).find("table"), std::string::npos);
}

}  // namespace
}  // namespace mjarm::perception

// The tasks push_button, open_drawer, sort and draw: what an archive shows, and what is judged.
#include <gmock/gmock.h>

#include <algorithm>
#include <cstring>
#include <nlohmann/json.hpp>
#include <set>

#include "mjarm/core/stored_zip.hpp"
#include "mjarm/episode/demonstrate_internal.hpp"
#include "mjarm/episode/plan_chain_internal.hpp"
#include "mjarm/episode/record.hpp"
#include "mjarm/episode/task_internal.hpp"
#include "mjarm/model/find_arm.hpp"

namespace mjarm::episode {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

EpisodeOptions small(const std::string& task, const std::string& robot = "panda") {
  return {.task = task, .robot = robot, .seed = 7, .size = 32, .fps = 2};
}

/// What an archive holds.
struct Opened {
  json about;
  std::string bytes;

  explicit Opened(std::string archive) : bytes(std::move(archive)) {
    about = json::parse(entry("episode.json"));
  }
  [[nodiscard]] std::string entry(const std::string& name) const {
    return std::string(StoredZip::open(bytes, "test").value().read_checked(name).value());
  }
  /// Rows of a column; its header takes 128 bytes.
  [[nodiscard]] std::vector<std::vector<double>> rows(const std::string& column) const {
    const std::string file = entry(column + ".npy");
    std::vector<double> all((file.size() - 128) / sizeof(double));
    std::memcpy(all.data(), file.data() + 128, all.size() * sizeof(double));
    const std::size_t width = all.size() / about.at("rows").get<std::size_t>();
    std::vector<std::vector<double>> out;
    for (std::size_t i = 0; i < all.size(); i += width) {
      out.emplace_back(all.begin() + static_cast<std::ptrdiff_t>(i),
                       all.begin() + static_cast<std::ptrdiff_t>(i + width));
    }
    return out;
  }
};

/// A task of an episode, with the robot in its scene and a simulation of its own.
struct Drawn {
  Robot robot;
  std::unique_ptr<Task> task;
  std::unique_ptr<Sim> sim;

  Drawn(const EpisodeOptions& options, std::uint64_t number)
      : robot(load_task_robot(options).value()), task(draw_task(robot, options, number)) {
    robot.model = with_bodies_at(robot.model, task->scene().places).value();
    sim = std::make_unique<Sim>(robot.model);
    sim->reset_home();
    sim->place(robot.arm, task->scene().q);
  }
  void put(const std::string& joint, double value) {
    std::vector<double> qpos(sim->qpos().begin(), sim->qpos().end());
    qpos[qpos_of(robot.model, joint)] = value;
    sim->set_state(qpos, std::vector<double>(sim->qvel().size(), 0.0));
    task->look(*sim);
  }
  [[nodiscard]] Verdict judge() const {
    return task->judge({*sim, sim->tool(robot.arm), {}, Pose{}});
  }
  [[nodiscard]] const std::string& object(std::size_t i) const {
    return task->scene().objects[i].name;
  }
  [[nodiscard]] const std::string& target() const { return object(task->scene().target); }
  [[nodiscard]] const std::string& other() const {
    return object((task->scene().target + 1) % task->scene().objects.size());
  }
};

TEST(Tasks, TellTheirOwnRangesAndDrawBothRobots) {
  for (const TaskKind& kind : task_kinds()) {
    std::set<std::string> names;
    for (const DrawRange& range : draw_ranges(kind.name)) {
      EXPECT_TRUE(names.insert(range.name).second) << kind.name << ' ' << range.name;
      EXPECT_LT(range.lower, range.upper) << kind.name << ' ' << range.name;
    }
    EXPECT_TRUE(names.contains("light_azimuth"));
    EXPECT_EQ(names.contains("place_x"), std::string(kind.name) == "pick_place");
    for (const std::string& robot_name : robot_names()) {
      const EpisodeOptions options = small(kind.name, robot_name);
      const Robot robot = load_task_robot(options).value();
      const DrawnScene one = draw_scene(robot, options, 0), two = draw_scene(robot, options, 1);
      EXPECT_NE(one.q, two.q);
      EXPECT_EQ(one.views.size(), 2U);
      EXPECT_FALSE(one.english.empty() || one.chinese.empty());
      EXPECT_THAT(one.english, Not(HasSubstr("{}")));
    }
  }
  EXPECT_TRUE(draw_ranges("juggle").empty());
}

TEST(Tasks, OfANearbyNameAreMeant) {
  EXPECT_THAT(check(small("opne_drawer")).error().what, HasSubstr("did you mean \"open_drawer\"?"));
  EXPECT_THAT(check(small("pik")).error().what, HasSubstr("did you mean \"pick_place\"?"));
}

TEST(PushButton, IsPushedToItsStopAndComesBack) {
  for (const char* robot : {"panda", "ur5e"}) {
    EpisodeOptions options = small("push_button", robot);
    options.fps = 20;
    options.size = 16;
    Studio studio = Studio::open(options).value();
    const Opened done(studio.make(1).value().bytes);
    ASSERT_TRUE(done.about.at("success")) << done.about.at("reason");
    EXPECT_TRUE(done.about.at("certificate").at("proved"));
    const std::size_t at = qpos_of(load_task_robot(options)->model,
                                   done.about.at("goal").at("joint").get<std::string>());
    double most = 0;
    for (const auto& row : done.rows("qpos")) most = std::max(most, row.at(at));
    EXPECT_GT(most, 6e-3);
    EXPECT_LT(std::abs(done.rows("qpos").back().at(at)), 1e-3);
    EXPECT_NE(done.entry("frames/front/000000.png"),
              done.entry("frames/front/00000" + std::to_string(1) + ".png"));
  }
}

TEST(PushButton, IsJudgedByTheCapAlone) {
  Drawn drawn(small("push_button"), 3);
  drawn.put(drawn.target(), 5e-3);
  EXPECT_EQ(drawn.judge().reason, "not_pushed");
  EXPECT_EQ(drawn.task->marks(), 0U);
  drawn.put(drawn.target(), 7e-3);
  EXPECT_EQ(drawn.judge().reason, "not_released");
  EXPECT_EQ(drawn.task->marks(), 1U);
  drawn.put(drawn.target(), 2e-4);
  EXPECT_TRUE(drawn.judge().success());
  EXPECT_EQ(drawn.task->marks(), 1U) << "the lamp went out";
  drawn.put(drawn.other(), 1e-3);
  EXPECT_EQ(drawn.judge().reason, "others_moved");
}

/// Neither planner nor execution take the contact for granted where it is not allowed.
TEST(PushButton, OnlyThePushMayTouch) {
  const EpisodeOptions options = small("push_button");
  const Drawn drawn(options, 2);
  const auto jaws = std::optional(find_jaws(drawn.robot.model, drawn.robot.arm).value());
  const SceneState before{.qpos = {drawn.sim->qpos().begin(), drawn.sim->qpos().end()}};
  const StopCheck never;
  TaskPlan planned = drawn.task->plan({drawn.robot, jaws, before, never});
  ASSERT_EQ(planned.reason, "");
  const auto touches = [&] {
    Sim sim(drawn.robot.model);
    EXPECT_TRUE(sim.restore(drawn.sim->snapshot()));
    Execution execution = Execution::create(drawn.robot.model, planned.plan).value();
    return execution.run_to_end(sim).value().first_contact.has_value();
  };
  EXPECT_FALSE(touches());
  // From before the button, as things stand then.
  const PlanInput input{drawn.robot, jaws, planned.plan.scene_end, never};
  const JointVec q = planned.plan.q_end();
  PlanChain bare(input, as_span(q)), fingers(input, as_span(q));
  EXPECT_FALSE(bare.add({line_to(planned.goal, 0.05)}));
  EXPECT_EQ(std::move(bare).finish({}).reason, "collision");
  EXPECT_TRUE(fingers.add({line_to(planned.goal, 0.05)},
                          {{"left_finger", drawn.target()}, {"right_finger", drawn.target()}}));
  for (PlannedMove& move : planned.plan.moves) move.allowed.clear();
  EXPECT_TRUE(touches());
}

TEST(OpenDrawer, IsPulledAsFarAsAsked) {
  for (const char* robot : {"panda", "ur5e"}) {
    const EpisodeOptions options = small("open_drawer", robot);
    Studio studio = Studio::open(options).value();
    const Opened done(studio.make(0).value().bytes);
    ASSERT_TRUE(done.about.at("success")) << done.about.at("reason");
    const json& goal = done.about.at("goal");
    const std::size_t at =
        qpos_of(load_task_robot(options)->model, goal.at("joint").get<std::string>());
    EXPECT_EQ(done.rows("qpos").front().at(at), 0);
    EXPECT_GE(done.rows("qpos").back().at(at), goal.at("opening").get<double>());
    const std::string cm = std::to_string(std::lround(100 * goal.at("opening").get<double>()));
    EXPECT_THAT(done.about.at("language").at("en"), HasSubstr(cm + " cm"));
    EXPECT_EQ(done.rows("gripper").back().at(0), 0) << "it was not let go";
  }
}

TEST(OpenDrawer, IsJudgedByTheJointAlone) {
  Drawn drawn(small("open_drawer", "ur5e"), 5);
  EXPECT_EQ(drawn.judge().reason, "not_opened");
  drawn.put(drawn.target(), 0.079);
  EXPECT_EQ(drawn.judge().reason, "not_opened");
  drawn.put(drawn.target(), 0.17);
  EXPECT_TRUE(drawn.judge().success());
  drawn.put(drawn.other(), 0.002);
  EXPECT_EQ(drawn.judge().reason, "others_moved");
}

/// By MuJoCo's own account, the last row: each kind is over the floor of its bin.
TEST(Sort, PutsEveryThingIntoTheBinOfItsKind) {
  const EpisodeOptions options = small("sort");
  Studio studio = Studio::open(options).value();
  const Opened done(studio.make(0).value().bytes);
  ASSERT_TRUE(done.about.at("success")) << done.about.at("reason");
  EXPECT_EQ(done.about.at("goal").at("places").size(), 3U);
  const json& objects = done.about.at("scene").at("objects");
  const std::vector<double> first = done.rows("object_poses").front(),
                            last = done.rows("object_poses").back();
  std::size_t moved = 0;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const bool cube = objects.at(i).at("name").get<std::string>().starts_with("cube");
    const double side = (cube ? -1 : 1) * last.at(7 * i + 1);
    EXPECT_TRUE(side > 0.225 && side < 0.375) << objects.at(i).at("name") << ' ' << side;
    EXPECT_TRUE(last.at(7 * i) > 0.275 && last.at(7 * i) < 0.645);
    if (std::abs(first.at(7 * i + 1) - last.at(7 * i + 1)) > 0.01) ++moved;
  }
  EXPECT_EQ(moved, 3U);
}

TEST(Sort, IsJudgedByWhereThingsLie) {
  const Drawn drawn(small("sort"), 4);
  std::vector<Pose> at;
  for (const DrawnObject& object : drawn.task->scene().objects) at.push_back(object.X_WB);
  const auto judged = [&] { return drawn.task->judge({*drawn.sim, {}, at, {}}).reason; };
  EXPECT_EQ(judged(), "off_goal");
  const json goal = json::parse(drawn.task->goal_json({}).line());
  for (const json& place : goal.at("places")) {
    for (std::size_t i = 0; i < at.size(); ++i) {
      if (drawn.object(i) != place.at("name").get<std::string>()) continue;
      for (int k = 0; k < 3; ++k) at[i].p[k] = place.at("pos").at(static_cast<std::size_t>(k));
    }
  }
  EXPECT_EQ(judged(), "");
  const std::vector<Pose> right = at;
  const std::size_t target = drawn.task->scene().target;
  at[target].R = Eigen::AngleAxisd(1.5, Eigen::Vector3d::UnitX()).toRotationMatrix();
  EXPECT_EQ(judged(), "off_goal") << "it lies on its side";
  at = right;
  std::set<std::string> sorted;
  for (const json& place : goal.at("places")) sorted.insert(place.at("name"));
  for (std::size_t i = 0; i < at.size(); ++i) {
    if (!sorted.contains(drawn.object(i))) at[i].p.x() += 2e-3;
  }
  EXPECT_EQ(judged(), "others_moved");
}

TEST(Draw, LeavesInkThatIsTheFigure) {
  const EpisodeOptions options = small("draw", "panda");
  Studio studio = Studio::open(options).value();
  const Opened done(studio.make(0).value().bytes);
  ASSERT_TRUE(done.about.at("success")) << done.about.at("reason");
  EXPECT_LT(done.about.at("executed").at("ink_off_figure_max"), 1e-3);
  Studio again = Studio::open(options).value();
  ASSERT_TRUE(again.make(1));
  EXPECT_EQ(again.make(0).value().bytes, done.bytes) << "ink of another episode";
}

/// What one episode writes is not what another one asks for.
TEST(Draw, OtherInkThanTheFigureIsNone) {
  const EpisodeOptions options = small("draw", "ur5e");
  const Drawn one(options, 0), other(options, 1);
  EXPECT_EQ(one.judge().reason, "incomplete") << "nothing was written yet";
  EXPECT_TRUE(std::isinf(one.judge().facts.at(1).second));
  const SceneState before{.qpos = {one.sim->qpos().begin(), one.sim->qpos().end()}};
  const TaskPlan planned = one.task->plan({one.robot, {}, before, {}});
  ASSERT_EQ(planned.reason, "");
  Execution execution =
      Execution::create(one.robot.model, planned.plan, one.task->execution()).value();
  ASSERT_TRUE(execution.run_to_end(*one.sim, [&](const Sim& sim) {
    one.task->look(sim);
    other.task->look(sim);
    return true;
  }));
  EXPECT_EQ(one.judge().reason, "");
  EXPECT_EQ(other.judge().reason, "off_figure");
  EXPECT_GT(other.task->marks(), 50U);
}

}  // namespace
}  // namespace mjarm::episode

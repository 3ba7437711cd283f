#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "mjarm/core/messages/episode.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/episode/draw_looks_internal.hpp"
#include "mjarm/episode/plan_chain_internal.hpp"

namespace mjarm::episode {
namespace {

constexpr std::size_t kButtons = 3;  // in scenes/buttons.xml, whose lengths [m] the next ones are
constexpr double kButtonTable = 0.2, kBallHeight = 0.06, kCapHeight = 0.049, kStroke = 8e-3,
                 kLampHeight = 0.038, kLampRadius = 0.037;
constexpr double kSwitch = 6e-3;          // [m] that a cap is pushed to switch
constexpr double kReleased = 1e-3;        // [m] at most, of a cap that came back
constexpr double kTouchedCap = 5e-4;      // [m] of one that was not asked for
constexpr double kButtonsApart = 0.19;    // [m] between their feet
constexpr int kMaxButtonDraws = 10000;    // of a place beside the others
constexpr double kBeforeButton = 0.08;    // [m] of the fingertips, where the straight push begins
constexpr double kPushSpeed = 0.05;       // [m/s]
constexpr std::size_t kButtonTurns = 12;  // of the hand about the push that are tried

constexpr DrawRange kButtonX{"button_x", "m", 0.38, 0.56};
constexpr DrawRange kButtonY{"button_y", "m", -0.28, 0.28};
constexpr DrawRange kButtonTilt{"button_tilt", "rad", 0, 0.45};
constexpr DrawRange kTiltAzimuth{"button_tilt_azimuth", "rad", -std::numbers::pi, std::numbers::pi};
constexpr DrawRange kHandTurn{"hand_turn", "rad", -std::numbers::pi, std::numbers::pi};

std::string button_name(std::size_t i) { return "button" + std::to_string(i + 1); }

/// What is drawn of a table with buttons.
struct ButtonTable {
  DrawnScene scene;
  std::vector<std::size_t> qpos;  ///< of the caps' joints
  Pose X_WH;                      ///< the head that is asked for; z out of its cap
  std::vector<double> turns;      ///< [rad] of the hand
};

/// Closed fingers push a button to its stop, and let it come back.
class PushButtonTask final : public Task {
 public:
  explicit PushButtonTask(ButtonTable table)
      : Task(std::move(table.scene)),
        qpos_(std::move(table.qpos)),
        X_WH_(table.X_WH),
        turns_(std::move(table.turns)),
        most_(qpos_.size(), 0.0) {}

  [[nodiscard]] TaskPlan plan(const PlanInput& input) const override {
    Pose X_JT = jaws_pose(*input.jaws).inverse();
    X_JT.p.z() -= input.jaws->tips;  // what touches are the fingertips
    const std::string& cap = scene().objects[scene().target].name;
    TaskPlan out;
    for (const double turn : turns_) {
      const auto tool_at = [&](double height) {
        const Pose X_HJ{.p = {0, 0, height}, .R = from_euler({std::numbers::pi, 0, turn})};
        return X_WH_ * X_HJ * X_JT;
      };
      const Pose goal = tool_at(kCapHeight - kStroke), before = tool_at(kCapHeight + kBeforeButton);
      PlanChain chain(input, scene().q);
      chain.add({grip(true), plan_to(before)});
      chain.add({line_to(goal, kPushSpeed), line_to(before, 2 * kPushSpeed)},
                {{"left_finger", cap}, {"right_finger", cap}});
      out = std::move(chain).finish(goal);
      if (out.reason.empty()) break;
    }
    return out;
  }

  void look(const Sim& sim) override {
    for (std::size_t i = 0; i < most_.size(); ++i) {
      most_[i] = std::max(most_[i], sim.qpos()[qpos_[i]]);
    }
  }

  /// Its lamp is on once it has switched.
  [[nodiscard]] std::size_t marks() const override {
    return most_[scene().target] >= kSwitch ? 1 : 0;
  }

  [[nodiscard]] render::Overlay overlay(std::size_t marks) const override {
    if (marks == 0) return {};
    return {.ellipsoids = {{.X_WE = X_WH_ * Pose{.p = {0, 0, kLampHeight}},
                            .semi_axes = {kLampRadius, kLampRadius, 1e-3},
                            .color = {1.0F, 0.85F, 0.25F, 1}}}};
  }

  [[nodiscard]] Verdict judge(const SceneEnd& end) const override {
    const std::size_t target = scene().target;
    const double now = end.sim.qpos()[qpos_[target]];
    Verdict out{.position = std::max(0.0, kSwitch - most_[target])};
    for (std::size_t i = 0; i < most_.size(); ++i) {
      if (i != target) out.others = std::max(out.others, most_[i]);
    }
    out.facts = {{"button_pushed_max", most_[target]}, {"button_pushed_end", now}};
    if (marks() == 0) {
      out.reason = "not_pushed";
    } else if (!(std::abs(now) <= kReleased)) {
      out.reason = "not_released";
    } else if (!(out.others <= kTouchedCap)) {
      out.reason = "others_moved";
    }
    return out;
  }

  [[nodiscard]] JsonDoc goal_json(const Pose& goal) const override {
    JsonDoc out = pose_json(goal);
    out.set("joint", scene().objects[scene().target].name);
    out.set("switch", kSwitch);
    out.set("stroke", kStroke);
    return out;
  }

 private:
  std::vector<std::size_t> qpos_;
  Pose X_WH_;
  std::vector<double> turns_;
  std::vector<double> most_;  ///< [m] that each cap was pushed
};

/// Feet on the table apart from each other, and their heads tilted.
std::vector<Pose> draw_buttons(Rng& rng, DrawnScene& out) {
  std::vector<Pose> heads;
  for (std::size_t i = 0; i < kButtons; ++i) {
    Eigen::Vector3d p;
    const auto is_apart = [&](const Pose& X_WH) {
      return (X_WH.p - p).head<2>().norm() >= kButtonsApart;
    };
    for (int k = 0; k < kMaxButtonDraws; ++k) {
      const double x = drawn(rng, kButtonX);
      p = {x, drawn(rng, kButtonY), kButtonTable};
      if (std::ranges::all_of(heads, is_apart)) break;
    }
    const double tilt = drawn(rng, kButtonTilt), azimuth = drawn(rng, kTiltAzimuth);
    const Eigen::Vector3d axis(std::cos(azimuth), std::sin(azimuth), 0);
    const Pose X_FH{.p = {0, 0, kBallHeight},
                    .R = Eigen::AngleAxisd(tilt, axis).toRotationMatrix()};
    heads.push_back(Pose{.p = p} * X_FH);
    out.places.push_back({button_name(i) + "_foot", {.p = p}});
    out.places.push_back({button_name(i) + "_head", X_FH});
  }
  return heads;
}

std::unique_ptr<Task> draw_push_button(const Robot& robot, EpisodeRng& rng) {
  ButtonTable table;
  DrawnScene& scene = table.scene;
  const std::vector<Pose> heads = draw_buttons(rng.scene, scene);
  for (std::size_t i = 0; i < kButtons; ++i) {
    constexpr double kCapFrame = 0.037;  // [m] above the ball
    scene.objects.push_back({button_name(i), heads[i] * Pose{.p = {0, 0, kCapFrame}}, {}, {}});
    table.qpos.push_back(qpos_of(robot.model, button_name(i)));
  }
  scene.target = rng.scene.below(kButtons);
  table.X_WH = heads[scene.target];
  for (std::size_t i = 0; i < kButtonTurns; ++i) {
    table.turns.push_back(drawn(rng.scene, kHandTurn));
  }
  draw_start(rng.scene, robot.arm, scene);

  const NamedColor& color = paint_all(rng.looks, scene);
  constexpr const char* kFurniture[] = {"table_top"};
  draw_grays(rng.looks, kFurniture, scene);
  draw_light(rng.looks, scene);
  constexpr double kFromFront = std::numbers::pi;
  const DrawnView nominal[] = {
      {"front",
       {.lookat_W = {0.48, 0, 0.3}, .distance = 1.0, .azimuth = kFromFront, .elevation = -0.7}},
      {"side",
       {.lookat_W = {0.48, 0, 0.28}, .distance = 1.05, .azimuth = -1.9, .elevation = -0.7}}};
  draw_views(rng.looks, nominal, scene);
  tell_task(
      msg::episode_push,
      [&](Language language) {
        return std::vector<std::string>{std::string(color.name.in(language))};
      },
      scene);
  return std::make_unique<PushButtonTask>(std::move(table));
}

}  // namespace

TaskKind push_button_task() {
  return {"push_button", "buttons.xml",
          with_looks_ranges({kButtonX, kButtonY, kButtonTilt, kTiltAzimuth, kHandTurn}),
          draw_push_button};
}

}  // namespace mjarm::episode

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "mjarm/collision/exact.hpp"
#include "mjarm/core/messages/episode.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/episode/draw_looks_internal.hpp"
#include "mjarm/episode/plan_chain_internal.hpp"
#include "mjarm/kinematics/fk.hpp"

namespace mjarm::episode {
namespace {

/// Heights [m] of the drawers in scenes/cabinet.xml, and how far their handles stand off.
constexpr double kDrawerHeights[] = {0.087, 0.22, 0.353};
constexpr double kHandleOff = 0.036;
constexpr double kPulledOn = 0.01;                        // [m] that is pulled beyond what is asked
constexpr double kBeforeHandle = 0.1;                     // [m] where the straight way to it begins
constexpr double kToHandle = 0.15, kPullSpeed = 0.1;      // [m/s]
constexpr double kPitches[] = {0, 0.2, -0.2, 0.4, -0.4};  // [rad] of the hand about the handle

constexpr DrawRange kCabinetX{"cabinet_x", "m", 0.64, 0.7};
constexpr DrawRange kCabinetY{"cabinet_y", "m", -0.15, 0.15};
constexpr DrawRange kCabinetZ{"cabinet_z", "m", 0.14, 0.24};
constexpr DrawRange kCabinetYaw{"cabinet_yaw", "rad", -0.3, 0.3};
constexpr DrawRange kOpening{"opening", "m", 0.08, 0.16};

std::string drawer_name(std::size_t i) { return "drawer" + std::to_string(i + 1); }

/// What is drawn of a cabinet.
struct Cabinet {
  DrawnScene scene;
  std::vector<std::size_t> qpos;  ///< of the drawers' joints
  Pose X_WH;                      ///< the handle that is asked for; x into the cabinet, z up
  double opening = 0;             ///< [m] that its drawer is to be pulled, at least
};

/// Whether nothing else comes near while a drawer goes with the hand. Looked at so often that
/// nothing can move farther from one look to the middle of the next than the distance that is kept.
bool is_pull_free(const PlanInput& input, const PlannedMove& pull, const SceneState& scene,
                  std::size_t qpos, const Eigen::Vector3d& way_W) {
  constexpr double kLook = 0.01;  // [s]
  constexpr double kReach = 1.3;  // [m] of any point of an arm from any of its joints
  const Robot& robot = input.robot;
  const double duration = pull.trajectory.duration();
  const int count = std::max(1, static_cast<int>(std::ceil(duration / kLook)));
  const Eigen::Vector3d first = fk(robot.arm, as_span(pull.trajectory.at(0).q)).p;
  JointVec q_before = pull.trajectory.at(0).q;
  double s_before = 0;
  for (int k = 0; k <= count; ++k) {
    const JointVec q = pull.trajectory.at(duration * k / count).q;
    const double s = (fk(robot.arm, as_span(q)).p - first).dot(way_W);
    const double moved = kReach * (q - q_before).lpNorm<1>() + std::abs(s - s_before);
    ExactOptions options{.margin = 0.05, .rules = {.allowed = pull.allowed}, .qpos = scene.qpos};
    options.skip_neighbours = true;
    options.qpos[qpos] = s;
    const auto report = ExactChecker(robot.model, robot.arm, options).check(as_span(q));
    if (!report || !report->free) return false;
    if (report->nearest && report->nearest->distance <= 0.5 * moved) return false;
    q_before = q;
    s_before = s;
  }
  return true;
}

/// A drawer is pulled open by its handle, which the fingers hold by friction.
class OpenDrawerTask final : public Task {
 public:
  explicit OpenDrawerTask(Cabinet cabinet)
      : Task(std::move(cabinet.scene)),
        qpos_(std::move(cabinet.qpos)),
        X_WH_(cabinet.X_WH),
        opening_(cabinet.opening) {}

  [[nodiscard]] TaskPlan plan(const PlanInput& input) const override {
    TaskPlan out;
    for (const double pitch : kPitches) {
      for (const double roll : {0.5, -0.5}) {
        out = plan_grasp(input, pitch, roll * std::numbers::pi);
        if (out.reason.empty()) return out;
      }
    }
    return out;
  }

  [[nodiscard]] Verdict judge(const SceneEnd& end) const override {
    const std::size_t target = scene().target;
    const double now = end.sim.qpos()[qpos_[target]];
    Verdict out{.position = std::max(0.0, opening_ - now)};
    for (std::size_t i = 0; i < qpos_.size(); ++i) {
      if (i != target) out.others = std::max(out.others, std::abs(end.sim.qpos()[qpos_[i]]));
    }
    out.facts = {{"drawer_opened", now}};
    if (!(now >= opening_)) {
      out.reason = "not_opened";
    } else if (!(out.others <= kOthersMoved)) {
      out.reason = "others_moved";
    }
    return out;
  }

  [[nodiscard]] JsonDoc goal_json(const Pose& goal) const override {
    JsonDoc out = pose_json(goal);
    out.set("joint", scene().objects[scene().target].name);
    out.set("opening", opening_);
    return out;
  }

 private:
  /// By the handle with the hand turned about it by `pitch`, and about its approach by `roll`.
  [[nodiscard]] TaskPlan plan_grasp(const PlanInput& input, double pitch, double roll) const {
    const Pose X_JT = jaws_pose(*input.jaws).inverse();
    // Of the jaws, whose z goes into the cabinet and whose y is upright.
    Pose X_WJ = X_WH_;
    X_WJ.R *= from_euler({0, pitch, 0}) * from_euler({0, 0.5 * std::numbers::pi, 0}) *
              from_euler({0, 0, roll});
    const Eigen::Vector3d out_W = -X_WH_.R.col(0);
    const auto at = [&](double pulled, double back) {
      Pose X = X_WJ;
      X.p += pulled * out_W - back * X_WJ.R.col(2);
      return X * X_JT;
    };
    const std::string& drawer = scene().objects[scene().target].name;
    const PlanChain::Allowed holds{{"left_finger", drawer + "_handle"},
                                   {"right_finger", drawer + "_handle"}};
    const double pulled = opening_ + kPulledOn;
    const Pose goal = at(pulled, 0);
    PlanChain chain(input, scene().q);
    chain.add({plan_to(at(0, kBeforeHandle)), line_to(at(0, 0), kToHandle)});
    chain.add({grip(true)}, holds);
    const bool pulls = chain.add({line_to(goal, kPullSpeed)}, holds);
    const std::size_t qpos = qpos_[scene().target];
    if (pulls && !is_pull_free(input, chain.plan().moves.back(), chain.scene(), qpos, out_W)) {
      chain.refuse("collision");
    }
    if (pulls) chain.scene().qpos[qpos] = pulled;
    chain.add({grip(false)}, holds);
    chain.add({line_to(at(pulled, kBeforeHandle), kToHandle)});
    return std::move(chain).finish(goal);
  }

  std::vector<std::size_t> qpos_;
  Pose X_WH_;
  double opening_;
};

/// All parts of the cabinet in one gray.
void color_cabinet(Rng& rng, DrawnScene& out) {
  constexpr const char* kOne[] = {"cabinet_top"};
  draw_grays(rng, kOne, out);
  LooksChange::Geom look = out.looks.geoms.back();
  for (const char* part : {"plinth", "bottom", "left", "right", "back", "board1", "board2"}) {
    look.name = std::string("cabinet_") + part;
    out.looks.geoms.push_back(look);
  }
}

std::unique_ptr<Task> draw_open_drawer(const Robot& robot, EpisodeRng& rng) {
  Cabinet cabinet;
  DrawnScene& scene = cabinet.scene;
  const double x = drawn(rng.scene, kCabinetX), y = drawn(rng.scene, kCabinetY);
  const double z = drawn(rng.scene, kCabinetZ), yaw = drawn(rng.scene, kCabinetYaw);
  const Pose X_WC{.p = {x, y, z}, .R = from_euler({0, 0, yaw})};
  scene.places.push_back({"cabinet", X_WC});
  for (std::size_t i = 0; i < std::size(kDrawerHeights); ++i) {
    scene.objects.push_back({drawer_name(i), X_WC * Pose{.p = {0, 0, kDrawerHeights[i]}}, {}, {}});
    cabinet.qpos.push_back(qpos_of(robot.model, drawer_name(i)));
  }
  scene.target = rng.scene.below(scene.objects.size());
  cabinet.X_WH = scene.objects[scene.target].X_WB * Pose{.p = {-kHandleOff, 0, 0}};
  // Whole centimetres, as the task says them.
  cabinet.opening = 0.01 * std::round(100 * drawn(rng.scene, kOpening));
  draw_start(rng.scene, robot.arm, scene);

  const NamedColor& color = paint_all(rng.looks, scene, "_front");
  color_cabinet(rng.looks, scene);
  draw_light(rng.looks, scene);
  const DrawnView nominal[] = {
      {"front", {.lookat_W = {0.5, 0, 0.42}, .distance = 1.35, .azimuth = 0.85, .elevation = -0.4}},
      {"side",
       {.lookat_W = {0.5, 0, 0.42}, .distance = 1.35, .azimuth = -0.95, .elevation = -0.45}}};
  draw_views(rng.looks, nominal, scene);
  const std::string centimetres = std::to_string(std::lround(100 * cabinet.opening));
  tell_task(
      msg::episode_open,
      [&](Language language) {
        return std::vector<std::string>{std::string(color.name.in(language)), centimetres};
      },
      scene);
  return std::make_unique<OpenDrawerTask>(std::move(cabinet));
}

}  // namespace

TaskKind open_drawer_task() {
  return {"open_drawer", "cabinet.xml",
          with_looks_ranges({kCabinetX, kCabinetY, kCabinetZ, kCabinetYaw, kOpening}),
          draw_open_drawer};
}

}  // namespace mjarm::episode

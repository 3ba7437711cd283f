#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "mjarm/core/messages/episode.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/episode/draw_looks_internal.hpp"
#include "mjarm/episode/plan_chain_internal.hpp"
#include "mjarm/kinematics/branch.hpp"
#include "mjarm/kinematics/ik.hpp"
#include "mjarm/model/find_arm.hpp"
#include "mjarm/path/letters.hpp"

namespace mjarm::episode {
namespace {

constexpr double kInkLift = 0.02;  // [m] of the pen above the sheet, as the plan takes it
constexpr double kInkForce = 1;    // [N]
constexpr double kInkSpeeds[] = {0.04, 0.02, 0.01};  // [m/s]
constexpr double kAwaySpeed = 0.1;                   // [m/s]
constexpr double kInkSpacing = 3e-4;                 // [m] between spots that are kept
/// Of the joints' acceleration and jerk, as a pen that starts fast presses with another force.
constexpr double kInkShare = 0.02;
constexpr double kOffFigure = 1e-3;   // [m] of the ink from the figure, at most
constexpr double kLackingInk = 1e-3;  // [m] of any place of the figure from the ink, at most
constexpr int kCircleSides = 180;     // of what ink is compared with
constexpr const char* kLetters = "ACLNOSTUVZ";

constexpr DrawRange kFigureX{"figure_x", "m", -0.1, 0.1};
constexpr DrawRange kFigureY{"figure_y", "m", -0.06, 0.06};
constexpr DrawRange kFigureSize{"figure_size", "m", 0.05, 0.08};
constexpr DrawRange kFigureTurn{"figure_turn", "rad", -0.4, 0.4};
constexpr DrawRange kSheetPitch{"sheet_pitch", "rad", -0.09, 0.09};
constexpr DrawRange kSheetRoll{"sheet_roll", "rad", -0.09, 0.09};

enum class FigureKind { circle, square, letter };

/// What is to be written, on a level sheet: of the tilt the plan knows nothing.
struct Figure {
  FigureKind kind = FigureKind::circle;
  char letter = 'A';
  double size = 0.05;  ///< [m] height, or diameter
  Pose X_WF;           ///< its middle: x to the right, y up
};

/// Its strokes in its own plane [m], each from point to point.
std::vector<std::vector<Eigen::Vector2d>> strokes_of(const Figure& figure) {
  const double half = 0.5 * figure.size;
  if (figure.kind == FigureKind::square) {
    return {{{-half, -half}, {half, -half}, {half, half}, {-half, half}, {-half, -half}}};
  }
  if (figure.kind == FigureKind::circle) {
    std::vector<Eigen::Vector2d> circle;
    for (int i = 0; i <= kCircleSides; ++i) {
      const double angle = 2 * std::numbers::pi * i / kCircleSides;
      circle.emplace_back(half * std::cos(angle), half * std::sin(angle));
    }
    return {circle};
  }
  std::vector<std::vector<Eigen::Vector2d>> out;
  const auto strokes = letter_strokes(std::string(1, figure.letter), figure.size);
  for (const Stroke& stroke : strokes.value_or(std::vector<Stroke>{})) {
    out.push_back(stroke.points);
    for (Eigen::Vector2d& p : out.back()) p.y() -= half;
  }
  return out;
}

double distance_to(const Eigen::Vector2d& p, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  const Eigen::Vector2d ab = b - a;
  const double length2 = ab.squaredNorm();
  const double s = length2 > 0 ? std::clamp((p - a).dot(ab) / length2, 0.0, 1.0) : 0.0;
  return (a + s * ab - p).norm();
}

/// [m] of a point from the nearest stroke.
double distance_to(const Eigen::Vector2d& p,
                   const std::vector<std::vector<Eigen::Vector2d>>& strokes) {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& stroke : strokes) {
    for (std::size_t i = 1; i < stroke.size(); ++i) {
      least = std::min(least, distance_to(p, stroke[i - 1], stroke[i]));
    }
  }
  return least;
}

/// Where ink is.
struct InkSpot {
  Eigen::Vector3d p_W;
  bool begins = false;  ///< no line leads here
};

/// What is drawn of a sheet.
struct Sheet {
  DrawnScene scene;
  Figure figure;
  Arm arm;  ///< that holds the pen
};

/// A pen writes a figure on a sheet, of whose tilt it knows nothing.
class DrawTask final : public Task {
 public:
  explicit DrawTask(Sheet sheet)
      : Task(std::move(sheet.scene)),
        figure_(sheet.figure),
        arm_(std::move(sheet.arm)),
        strokes_(strokes_of(figure_)) {}

  /// As fast as the joints can.
  [[nodiscard]] TaskPlan plan(const PlanInput& input) const override {
    TaskPlan out;
    for (const double speed : kInkSpeeds) {
      out = plan_at(input, speed);
      if (out.reason.empty()) break;
    }
    return out;
  }

  [[nodiscard]] ExecutionOptions execution() const override {
    return {.control = ControlMode::tool_impedance};
  }

  /// Ink is where the tip touches the sheet.
  void look(const Sim& sim) override {
    const bool touches = std::ranges::any_of(sim.contacts(), [](const Contact& contact) {
      return (contact.first == "pen_tip" && contact.second == "paper") ||
             (contact.first == "paper" && contact.second == "pen_tip");
    });
    if (touches) {
      const Eigen::Vector3d p_W = sim.tool(arm_).p;
      const bool begins = !touched_;
      if (begins || (p_W - ink_.back().p_W).norm() >= kInkSpacing) ink_.push_back({p_W, begins});
    }
    touched_ = touches;
  }

  /// Across the pen, which is upright: there its ink is the figure whatever the tilt of the sheet.
  [[nodiscard]] Verdict judge(const SceneEnd& /*end*/) const override {
    const auto [off, lacking] = compare(ink_);
    Verdict out{.position = off};
    out.facts = {{"ink_off_figure_max", off}, {"ink_lacking_max", lacking}};
    if (!(off <= kOffFigure)) {
      out.reason = "off_figure";
    } else if (!(lacking <= kLackingInk)) {
      out.reason = "incomplete";
    }
    return out;
  }

  [[nodiscard]] JsonDoc goal_json(const Pose& goal) const override {
    std::vector<JsonDoc> strokes;
    for (const auto& stroke : strokes_) {
      std::vector<std::vector<double>> points;
      for (const Eigen::Vector2d& p : stroke) points.push_back({p.x(), p.y()});
      strokes.emplace_back(points);
    }
    JsonDoc out = pose_json(goal);
    out.set("strokes", std::move(strokes));
    return out;
  }

  [[nodiscard]] std::size_t marks() const override { return ink_.size(); }

  [[nodiscard]] render::Overlay overlay(std::size_t marks) const override {
    constexpr double kWidth = 3e-3, kSpacing = 1.5e-3;  // [m]
    const Eigen::Vector3d above(0, 0, 0.25 * kWidth);   // out of what it is written on
    render::Overlay out;
    for (const InkSpot& spot : std::span(ink_).first(marks)) {
      if (spot.begins) {
        out.lines.push_back(
            {.width = kWidth, .color = {0.05F, 0.1F, 0.5F, 1}, .look = render::LineLook::tube});
      }
      auto& points = out.lines.back().points_W;
      const Eigen::Vector3d p_W = spot.p_W + above;
      if (points.empty() || (p_W - points.back()).norm() >= kSpacing) points.push_back(p_W);
    }
    return out;
  }

 private:
  [[nodiscard]] TaskPlan plan_at(const PlanInput& input, double speed) const {
    PlanChain chain(input, scene().q);
    // Shoulder and elbow as at home, where the arm stands behind the pen and hides little.
    Branch branch = branch_of(IkSolver(arm_), as_span(arm_.home));
    branch.way[2] = -1;
    chain.add(
        {{program::PlanMove{.goal = program::ProgramPose{.X_FT = lifted(strokes_.front().front())},
                            .branch = branch}}});
    if (figure_.kind == FigureKind::letter) {
      chain.add({written(speed)});
    } else {
      Robot slow = input.robot;
      slow.arm.limits.acceleration *= kInkShare;
      slow.arm.limits.jerk *= kInkShare;
      const PlanInput slowly{slow, input.jaws, input.before, input.stop};
      PlanChain trace(slowly, as_span(chain.q()));
      trace.add({traced(speed)});
      chain.append(std::move(trace), ToolPress{.force = kInkForce, .reach = 2 * kInkLift});
    }
    Pose away = lifted(strokes_.back().back());
    away.p.z() += kInkLift;
    chain.add({line_to(away, kAwaySpeed)});
    return std::move(chain).finish(figure_.X_WF);
  }

  /// The tool over a place of the figure, the pen upright.
  [[nodiscard]] Pose lifted(const Eigen::Vector2d& p) const {
    return {.p = figure_.X_WF * Eigen::Vector3d(p.x(), p.y(), kInkLift), .R = pen_turn()};
  }
  [[nodiscard]] Eigen::Matrix3d pen_turn() const {
    return figure_.X_WF.R * from_euler({std::numbers::pi, 0, 0});
  }

  [[nodiscard]] program::Instruction written(double speed) const {
    Pose X_WP = figure_.X_WF;
    X_WP.p = X_WP * Eigen::Vector3d(0, -0.5 * figure_.size, 0);
    return {program::DrawText{.text = std::string(1, figure_.letter),
                              .height = figure_.size,
                              .lift = kInkLift,
                              .press = kInkForce,
                              .plane = {.X_FT = X_WP},
                              .R_FT = pen_turn(),
                              .speed = speed}};
  }

  [[nodiscard]] program::Instruction traced(double speed) const {
    std::vector<program::ProgramPose> points;
    for (const Eigen::Vector2d& p : strokes_.front()) points.push_back({.X_FT = lifted(p)});
    if (figure_.kind == FigureKind::square) {
      return {program::DrawPolyline{.points = std::move(points), .speed = speed, .blend = 0.0}};
    }
    return {program::DrawSpline{.points = std::move(points), .speed = speed}};
  }

  /// [m] The farthest of the ink from the figure, and of the figure from the ink.
  [[nodiscard]] std::pair<double, double> compare(std::span<const InkSpot> ink) const {
    constexpr double kStep = 5e-4;  // [m] between places of the figure that are looked at
    const Pose X_FW = figure_.X_WF.inverse();
    std::vector<Eigen::Vector2d> spots;
    double off = 0, lacking = 0;
    for (const InkSpot& spot : ink) {
      spots.push_back((X_FW * spot.p_W).head<2>());
      off = std::max(off, distance_to(spots.back(), strokes_));
    }
    for (const auto& stroke : strokes_) {
      for (std::size_t i = 1; i < stroke.size(); ++i) {
        const Eigen::Vector2d way = stroke[i] - stroke[i - 1];
        const int count = std::max(1, static_cast<int>(std::ceil(way.norm() / kStep)));
        for (int k = 0; k <= count; ++k) {
          const Eigen::Vector2d p = stroke[i - 1] + way * (static_cast<double>(k) / count);
          double least = std::numeric_limits<double>::infinity();
          for (const Eigen::Vector2d& q : spots) least = std::min(least, (q - p).norm());
          lacking = std::max(lacking, least);
        }
      }
    }
    return {off, lacking};
  }

  Figure figure_;
  Arm arm_;
  std::vector<std::vector<Eigen::Vector2d>> strokes_;
  std::vector<InkSpot> ink_;
  bool touched_ = false;  ///< the sheet, in the last step
};

/// @param X_WS  the level sheet.
Figure draw_figure(Rng& rng, const Pose& X_WS) {
  Figure out;
  const std::string letters = kLetters;
  out.kind = static_cast<FigureKind>(rng.below(3));
  out.letter = letters[rng.below(letters.size())];
  out.size = drawn(rng, kFigureSize);
  const double x = drawn(rng, kFigureX), y = drawn(rng, kFigureY);
  out.X_WF = X_WS * Pose{.p = {x, y, 0}, .R = from_euler({0, 0, drawn(rng, kFigureTurn)})};
  return out;
}

void tell_figure(const Figure& figure, DrawnScene& out) {
  const Msg pattern = figure.kind == FigureKind::circle   ? msg::episode_circle
                      : figure.kind == FigureKind::square ? msg::episode_square
                                                          : msg::episode_letter;
  tell_task(
      pattern, [&](Language) { return std::vector<std::string>{std::string(1, figure.letter)}; },
      out);
}

std::unique_ptr<Task> draw_draw(const Robot& robot, EpisodeRng& rng) {
  const Pose X_WS = frame_pose(robot.model, "paper", robot.model.qpos0()).value_or(Pose{});
  Sheet sheet{.scene = {}, .figure = draw_figure(rng.scene, X_WS), .arm = robot.arm};
  DrawnScene& scene = sheet.scene;
  scene.joints = {{"paper_pitch", drawn(rng.scene, kSheetPitch)},
                  {"paper_roll", drawn(rng.scene, kSheetRoll)}};
  const Pose X_ST{.R = from_euler({scene.joints[0].value, 0, 0}) *
                       from_euler({0, scene.joints[1].value, 0})};
  draw_start(rng.scene, robot.arm, scene);

  scene.objects.push_back({"paper", X_WS * X_ST, "white", {0.96F, 0.94F, 0.88F, 1}});
  constexpr const char* kFurniture[] = {"desk"};
  draw_grays(rng.looks, kFurniture, scene);
  draw_light(rng.looks, scene);
  // From where one reads, and from its side.
  const double facing = std::atan2(X_WS.R(1, 1), X_WS.R(0, 1));
  const Eigen::Vector3d lookat = X_WS.p + Eigen::Vector3d(0, 0, 0.02);
  const DrawnView nominal[] = {
      {"front", {.lookat_W = lookat, .distance = 0.55, .azimuth = facing, .elevation = -0.8}},
      {"side",
       {.lookat_W = lookat, .distance = 0.6, .azimuth = facing + 0.73, .elevation = -0.75}}};
  draw_views(rng.looks, nominal, scene);
  tell_figure(sheet.figure, scene);
  return std::make_unique<DrawTask>(std::move(sheet));
}

}  // namespace

TaskKind draw_a_figure_task() {
  return {
      "draw", "calligraphy.xml",
      with_looks_ranges({kFigureX, kFigureY, kFigureSize, kFigureTurn, kSheetPitch, kSheetRoll}),
      draw_draw, "pen_tcp"};
}

}  // namespace mjarm::episode

#include "mjarm/session/show_plan.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "mjarm/collision/sphere_model.hpp"
#include "mjarm/core/language_scope.hpp"
#include "mjarm/core/log.hpp"
#include "mjarm/core/messages/show.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/core/progress.hpp"
#include "mjarm/execution/motion_clock.hpp"
#include "mjarm/render/fonts.hpp"
#include "mjarm/session/arm_json.hpp"
#include "mjarm/session/plan_player.hpp"
#include "mjarm/session/plan_view.hpp"
#include "mjarm/session/run_video.hpp"
#include "mjarm/session/simulate_world.hpp"
#include "mjarm/view/show_in_window.hpp"

namespace mjarm::session {
namespace {

constexpr double kFilmSpeed = 1;  // [rad/s or m/s, L2]

/// Width by height of what is drawn; in a window, of what its panel leaves.
double aspect_of(const PlanShow& show) {
  constexpr int kPanel = 300, kLeast = 200;  // [px]
  if (show.picture) return static_cast<double>(show.picture->width) / show.picture->height;
  return static_cast<double>(std::max(show.width - kPanel, kLeast)) / show.height;
}

/// The camera asked for; without one, that of the path.
Result<render::Camera> camera_of(const PlanShow& show, const PlanSubject& subject,
                                 const PlanDrawing& drawing) {
  if (show.camera) return show.camera(subject.model);
  return render::Camera{.view = plan_view(subject, drawing, aspect_of(show))};
}

/// What a picture shows: what a window lets the user add would be too much at once.
PlanLayers picture_layers() {
  PlanLayers layers;
  layers.tree = layers.corners = false;
  return layers;
}

/// What the colours of these layers mean.
std::vector<render::LegendEntry> legend_of(bool film, bool spheres) {
  const LanguageScope drawn(render::picture_language());
  std::vector<render::Rgba> scale;
  for (const double clearance : {0.0, 0.01, 0.03, 0.1, 0.3}) {
    scale.push_back(clearance_color(clearance));
  }
  return {{scale, text(spheres ? msg::show_plan_legend_scale : msg::show_plan_legend_way)},
          {{kPlanStartColor}, text(msg::show_plan_legend_start)},
          {{kPlanGoalColor}, text(msg::show_plan_legend_goal)},
          {{}, text(film ? msg::show_plan_legend_now : msg::show_plan_legend_tightest)}};
}

Snapshot standing(const PlanSubject& subject, const JointVec& q) {
  Sim sim(subject.model);
  place_subject(sim, subject, q);
  return sim.snapshot();
}

Result<std::string> draw_picture(const PictureOptions& options, const PlanSubject& subject,
                                 PlanDrawing& drawing, const render::Camera& camera) {
  Result<render::OffscreenRenderer> renderer =
      render::OffscreenRenderer::create(subject.model, offscreen_options(options));
  if (!renderer) return fail(std::move(renderer.error()));
  const JointVec q = drawing.way().at(drawing.tightest());
  return write_picture(*renderer, options, standing(subject, q), camera,
                       drawing.overlay(picture_layers(), drawing.look(q)));
}

/// The arm goes from start to goal.
Result<std::string> draw_film(const PictureOptions& options, const PlanSubject& subject,
                              PlanDrawing& drawing, const render::Camera& camera) {
  Result<VideoOfRun> video = VideoOfRun::open(subject.model, options, camera);
  if (!video) return fail(std::move(video.error()));
  const PlanLayers layers = picture_layers();
  const double length = drawing.way().length();
  const auto frames =
      static_cast<int>(std::ceil((length / kFilmSpeed + kRestAtEnd) * options.fps)) + 1;
  Progress progress(text(msg::show_plan_progress), static_cast<std::uint64_t>(frames));
  for (int i = 0; i < frames; ++i) {
    const JointVec q = drawing.way().at(std::min(length, kFilmSpeed * i / options.fps));
    const render::Overlay overlay = drawing.overlay(layers, drawing.look(q));
    if (!video->add(standing(subject, q), camera, overlay)) break;
    progress.advance();
  }
  if (Result<void> finished = video->finish(); !finished) return fail(finished.error());
  return video->summary();
}

/// The same to be played.
Result<void> record(const PlanShow& show, const PlanSubject& subject, PlanDrawing& drawing) {
  const Result<render::Camera> camera = camera_of(show, subject, drawing);
  if (!camera) return fail(camera.error());
  BodyRecord bodies(subject.model);
  const double length = drawing.way().length();
  const auto moments = static_cast<int>(std::ceil(length / kFilmSpeed / BodyRecord::kInterval)) + 1;
  for (int i = 0; i < moments; ++i) {
    const double time = i * BodyRecord::kInterval;
    Snapshot now = standing(subject, drawing.way().at(std::min(length, kFilmSpeed * time)));
    now.time = time;
    bodies.add(now);
  }
  PlanLayers layers = picture_layers();
  layers.spheres = layers.pair = false;  // they go with the arm
  const PlanLook look = drawing.look(drawing.way().at(0));
  return show.record({.model = subject.model,
                      .title = "mjarm plan " + subject.title,
                      .bodies = bodies,
                      .overlay = drawing.overlay(layers, look),
                      .camera = *camera,
                      .arm = arm_json(subject.model, subject.arm),
                      .dofs = dofs_of(subject.arm)});
}

Result<void> show_in_file(const PlanShow& show, const PlanSubject& subject, PlanDrawing& drawing) {
  PictureOptions options = *show.picture;
  options.legend = legend_of(options.video, drawing.has_spheres());
  const Result<render::Camera> camera = camera_of(show, subject, drawing);
  if (!camera) return fail(camera.error());
  const Result<std::string> line = options.video ? draw_film(options, subject, drawing, *camera)
                                                 : draw_picture(options, subject, drawing, *camera);
  if (!line) return fail(line.error());
  log_info(*line);
  return {};
}

Result<void> show_in_a_window(const PlanShow& show, const PlanSubject& subject,
                              PlanDrawing& drawing) {
  Result<render::Camera> camera = camera_of(show, subject, drawing);
  if (!camera) return fail(camera.error());
  PlanPlayer player(subject, drawing);
  const view::WindowOptions window{.width = show.width,
                                   .height = show.height,
                                   .camera = std::move(*camera),
                                   .quality = show.quality,
                                   .can_push = false,
                                   .right_panel = true,
                                   .joints_open = false};
  catch_interrupts();
  const Result<view::ViewStats> shown =
      view::show_in_window(subject.model, "mjarm plan " + subject.title, window, {show.seconds},
                           [&player](view::ViewLink& link) { simulate_world(player, link); });
  if (!shown) return fail(shown.error());
  return {};
}

}  // namespace

Result<void> show_plan(const PlanShow& show, const PlanSubject& subject) {
  if (!show.picture && !show.record && !has_display()) {
    return fail(Errc::impossible, text(msg::show_plan_no_display));
  }
  PlanDrawing drawing(subject);
  const PlanLook look = drawing.look(drawing.way().at(drawing.tightest()));
  if (look.pair) {
    const std::string place = pair_line(*look.pair);
    const std::size_t edges = subject.path.q.size() - 1;
    log_info(edges == 1 ? text(msg::show_plan_straight, place)
                        : text(msg::show_plan_tightest, edges, place));
  }
  if (show.record) return record(show, subject, drawing);
  return show.picture ? show_in_file(show, subject, drawing)
                      : show_in_a_window(show, subject, drawing);
}

Result<void> show_plan_of_spheres(const PlanShow& show, const FastRobot& robot,
                                  const PlanProblem& problem, const PlannedPath& path) {
  const Arm arm = with_tool(robot.arm(), robot.spheres());
  const Result<FastChecker> checker = FastChecker::create(robot, problem.obstacles);
  if (!checker) return fail(checker.error());
  SphereModelLook look;
  Result<SphereModel> made = sphere_model(arm, robot.spheres(), problem.obstacles, &look);
  if (!made) return fail(made.error());
  const PlanSubject subject{made->model, made->arm, *checker, problem.obstacles, path, problem.id};
  // What stands in the way of the eye is made again, to be seen through.
  const PlanDrawing drawing(subject);
  const Result<render::Camera> camera = camera_of(show, subject, drawing);
  if (!camera) return fail(camera.error());
  if (camera->view) look.see_through = hiding_solids(subject, drawing, *camera->view);
  if (look.see_through.empty()) return show_plan(show, subject);
  const Result<SphereModel> again = sphere_model(arm, robot.spheres(), problem.obstacles, &look);
  if (!again) return fail(again.error());
  return show_plan(show, {again->model, again->arm, *checker, problem.obstacles, path, problem.id});
}

}  // namespace mjarm::session

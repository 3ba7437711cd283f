#include "apps/mjarm/view/plan_show.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "apps/mjarm/cli/usage.hpp"
#include "apps/mjarm/commands/render_program.hpp"
#include "apps/mjarm/commands/render_video.hpp"
#include "apps/mjarm/messages/plan_show.hpp"
#include "apps/mjarm/view/view_show.hpp"
#include "mjarm/collision/sphere_model.hpp"
#include "mjarm/core/log.hpp"
#include "mjarm/core/messages/view.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/core/progress.hpp"
#include "mjarm/execution/motion_clock.hpp"
#include "mjarm/render/video.hpp"
#include "mjarm/session/plan_player.hpp"
#include "mjarm/session/plan_view.hpp"
#include "mjarm/session/simulate_world.hpp"

namespace mjarm::app {
namespace {

using session::PlanDrawing;
using session::PlanLayers;
using session::PlanPlayer;
using session::PlanSubject;

constexpr double kFilmSpeed = 1;  // [rad/s or m/s, L2]

/// Width by height of what is drawn; in a window, of what its panel leaves.
double aspect_of(const PlanShow& show) {
  constexpr int kPanel = 300, kLeast = 200;  // [px]
  if (show.picture) return static_cast<double>(show.picture->width) / show.picture->height;
  return static_cast<double>(std::max(show.width - kPanel, kLeast)) / show.height;
}

/// The camera asked for; without one, that of the path.
Result<Camera> camera_of(const PlanShow& show, const PlanSubject& subject,
                         const PlanDrawing& drawing) {
  if (!show.camera.empty()) return choose_camera(subject.model, show.camera);
  return Camera{.view = session::plan_view(subject, drawing, aspect_of(show))};
}

Snapshot standing(const PlanSubject& subject, const JointVec& q) {
  Sim sim(subject.model);
  session::place_subject(sim, subject, q);
  return sim.snapshot();
}

Result<std::string> draw_picture(const PictureOptions& options, const PlanSubject& subject,
                                 const PlanDrawing& drawing, const Camera& camera) {
  Result<OffscreenRenderer> renderer =
      OffscreenRenderer::create(subject.model, offscreen_options(options));
  if (!renderer) return fail(std::move(renderer.error()));
  const JointVec q = drawing.way().at(drawing.way().tightest());
  return write_picture(*renderer, options, standing(subject, q), camera,
                       drawing.overlay({}, drawing.look(q)));
}

/// The arm goes from start to goal.
Result<std::string> draw_film(const PictureOptions& options, const PlanSubject& subject,
                              const PlanDrawing& drawing, const Camera& camera) {
  Result<VideoOfRun> video = VideoOfRun::open(subject.model, options);
  if (!video) return fail(std::move(video.error()));
  PlanLayers layers;
  layers.corners = false;
  const double length = drawing.way().length();
  const auto frames =
      static_cast<int>(std::ceil((length / kFilmSpeed + kRestAtEnd) * options.fps)) + 1;
  Progress progress(text(msg::plan_show_progress), static_cast<std::uint64_t>(frames));
  for (int i = 0; i < frames; ++i) {
    const JointVec q = drawing.way().at(std::min(length, kFilmSpeed * i / options.fps));
    const Overlay overlay = drawing.overlay(layers, drawing.look(q));
    if (!video->add(standing(subject, q), camera, overlay)) break;
    progress.advance();
  }
  if (Result<void> finished = video->finish(); !finished) return fail(finished.error());
  return video->summary();
}

Result<void> show_in_file(const PlanShow& show, const PlanSubject& subject,
                          const PlanDrawing& drawing) {
  const PictureOptions& options = *show.picture;
  const Result<Camera> camera = camera_of(show, subject, drawing);
  if (!camera) return fail(camera.error());
  const Result<std::string> line = options.video ? draw_film(options, subject, drawing, *camera)
                                                 : draw_picture(options, subject, drawing, *camera);
  if (!line) return fail(line.error());
  log_info(*line);
  return {};
}

Result<void> show_in_a_window(const PlanShow& show, const PlanSubject& subject,
                              const PlanDrawing& drawing) {
  Result<Camera> camera = camera_of(show, subject, drawing);
  if (!camera) return fail(camera.error());
  PlanPlayer player(subject, drawing);
  const WindowOptions window{.width = show.width,
                             .height = show.height,
                             .camera = std::move(*camera),
                             .quality = show.quality,
                             .can_push = false,
                             .right_panel = true,
                             .joints_open = false};
  catch_interrupts();
  const Result<int> shown =
      show_in_window(subject.model, "mjarm plan " + subject.title, window, {show.seconds},
                     [&player](ViewLink& link) { session::simulate_world(player, link); });
  if (!shown) return fail(shown.error());
  return {};
}

Result<void> check_lone_options(const PlanShowArguments& arguments) {
  const std::pair<const char*, const std::string*> all[] = {{"--size", &arguments.size},
                                                            {"--camera", &arguments.camera},
                                                            {"--quality", &arguments.quality},
                                                            {"--seconds", &arguments.seconds}};
  for (const auto& [name, value] : all) {
    if (!value->empty()) return fail(Errc::usage, text(msg::plan_show_alone, name));
  }
  return {};
}

}  // namespace

void add_plan_show_options(CLI::App& app, PlanShowArguments& arguments) {
  add_option(app, "--picture", arguments.picture, msg::plan_show_option_picture, "F.png|mp4|gif");
  add_flag(app, "--view", arguments.view, msg::plan_show_option_view);
  add_option(app, "--size", arguments.size, msg::plan_show_option_size, "WxH");
  add_option(app, "--camera", arguments.camera, msg::plan_show_option_camera, "C");
  add_option(app, "--quality", arguments.quality, msg::plan_show_option_quality, "Q");
  add_option(app, "--seconds", arguments.seconds, msg::plan_show_option_seconds, "S");
}

Result<std::optional<PlanShow>> read_plan_show(const PlanShowArguments& arguments) {
  if (!arguments.wanted()) {
    if (Result<void> none = check_lone_options(arguments); !none) return fail(none.error());
    return std::nullopt;
  }
  if (arguments.view && !arguments.picture.empty()) {
    return fail(Errc::usage, text(msg::plan_show_both));
  }
  PlanShow out;
  out.camera = arguments.camera;
  // Sizes and qualities are read as those of pictures.
  const std::string file = arguments.view ? "window.png" : arguments.picture;
  const std::filesystem::path ending = std::filesystem::path(file).extension();
  if (ending != ".png" && ending != ".PNG" && !video_format(file)) {
    return fail(Errc::usage, text(msg::plan_show_ending, file));
  }
  const Result<PictureOptions> picture = read_picture_options({.out = file,
                                                               .size = arguments.size,
                                                               .camera = {},
                                                               .quality = arguments.quality,
                                                               .fps = {},
                                                               .seconds = {}});
  if (!picture) return fail(picture.error());
  out.quality = picture->quality;
  if (!arguments.view) {
    if (!arguments.seconds.empty()) {
      return fail(Errc::usage, text(msg::plan_show_alone, "--seconds"));
    }
    out.picture = *picture;
    return out;
  }
  if (!arguments.size.empty()) {
    out.width = picture->width;
    out.height = picture->height;
  }
  if (arguments.seconds.empty()) return out;
  const Result<double> seconds = parse_quantity(arguments.seconds, Quantity::time);
  if (!seconds) return fail(in_option("--seconds", seconds.error()));
  if (!(*seconds > 0)) return fail(Errc::usage, text(msg::view_bad_seconds, arguments.seconds));
  out.seconds = *seconds;
  return out;
}

Result<void> show_plan(const PlanShow& show, const PlanSubject& subject) {
  if (!show.picture && !has_display()) {
    return fail(Errc::impossible, text(msg::plan_show_no_display));
  }
  const PlanDrawing drawing(subject);
  const PlanDrawing::Look look = drawing.look(drawing.way().at(drawing.way().tightest()));
  if (look.pair) {
    log_info(text(msg::plan_show_tightest, subject.path.q.size() - 1,
                  drawing.pair_line(look, *look.pair)));
  }
  return show.picture ? show_in_file(show, subject, drawing)
                      : show_in_a_window(show, subject, drawing);
}

Result<void> show_plan_of_spheres(const PlanShow& show, const FastRobot& robot,
                                  const PlanProblem& problem, const PlannedPath& path) {
  const Arm arm = session::with_tool(robot.arm(), robot.spheres());
  const Result<FastChecker> checker = FastChecker::make(robot, problem.obstacles);
  if (!checker) return fail(checker.error());
  SphereModelLook look;
  Result<SphereModel> made = sphere_model(arm, robot.spheres(), problem.obstacles, &look);
  if (!made) return fail(made.error());
  const PlanSubject subject{made->model, made->arm, *checker, problem.obstacles, path, problem.id};
  // What stands in the way of the eye is made again, to be seen through.
  const PlanDrawing drawing(subject);
  const Result<Camera> camera = camera_of(show, subject, drawing);
  if (!camera) return fail(camera.error());
  if (camera->view) look.see_through = session::hiding_solids(subject, drawing, *camera->view);
  if (look.see_through.empty()) return show_plan(show, subject);
  const Result<SphereModel> again = sphere_model(arm, robot.spheres(), problem.obstacles, &look);
  if (!again) return fail(again.error());
  return show_plan(show, {again->model, again->arm, *checker, problem.obstacles, path, problem.id});
}

}  // namespace mjarm::app

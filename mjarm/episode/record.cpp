#include "mjarm/episode/record.hpp"

#include <cstdio>
#include <utility>

#include "mjarm/core/sha256.hpp"
#include "mjarm/core/stopwatch.hpp"
#include "mjarm/episode/archive_internal.hpp"
#include "mjarm/model/export.hpp"
#include "mjarm/render/offscreen.hpp"
#include "mjarm/render/png.hpp"

namespace mjarm::episode {
namespace {

constexpr std::size_t kNameSize = 64;

std::string frame_name(const std::string& camera, std::size_t row) {
  char number[kNameSize];
  std::snprintf(number, sizeof number, "/%06zu.png", row);
  return "frames/" + camera + number;
}

/// The scene of the shipped robots in which the tasks are.
const char* scene_file(const std::string& robot) {
  return robot == "panda" ? "franka_emika_panda/pick.xml" : "universal_robots_ur5e/pick.xml";
}

/// Draws every row as every camera sees it.
Result<void> add_frames(const Robot& robot, const EpisodeOptions& options, const DrawnScene& scene,
                        const Demonstration& done, const StopCheck& stop, EpisodeTimes& times,
                        StoredZipWriter& out) {
  if (done.samples.empty()) return {};
  const Stopwatch opening;
  const Result<Model> looks = with_looks(robot.model, scene.looks);
  if (!looks) return fail(looks.error());
  auto renderer = render::OffscreenRenderer::create(*looks, {.width = options.size,
                                                             .height = options.size,
                                                             .quality = render::RenderQuality::low,
                                                             .sites = false});
  if (!renderer) return fail(std::move(renderer.error()));
  times.rendering += opening.us();
  for (const DrawnView& view : scene.views) {
    for (std::size_t row = 0; row < done.samples.size(); ++row) {
      if (is_stopped(stop)) return fail(stopped());
      const Stopwatch drawing;
      const auto image = renderer->draw(done.samples[row].state, {.view = view.view});
      if (!image) return fail(image.error());
      times.rendering += drawing.us();
      const Stopwatch packing;
      const Result<std::string> png = render::encode_png(*image);
      if (!png) return fail(png.error());
      out.add(frame_name(view.name, row), *png);
      times.compression += packing.us();
    }
  }
  return {};
}

}  // namespace

Result<std::string> hash_of_model(const Model& model) {
  const Result<Exported> binary = export_model(model, ExportFormat::mjb, {});
  if (!binary) return fail(binary.error());
  return sha256(binary->content);
}

struct Studio::Impl {
  EpisodeOptions options;
  Robot robot;
  Jaws jaws;
  std::string model_hash;
};

Studio::Studio(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Studio::~Studio() = default;
Studio::Studio(Studio&&) noexcept = default;
Studio& Studio::operator=(Studio&&) noexcept = default;

Result<Studio> Studio::open(const EpisodeOptions& options) {
  if (Result<void> fits = check(options); !fits) return fail(std::move(fits.error()));
  Result<Robot> robot = load_robot(scene_file(options.robot));
  if (!robot) return fail(std::move(robot.error()));
  const Result<Jaws> jaws = find_jaws(robot->model, robot->arm);
  if (!jaws) return fail(jaws.error());
  Result<std::string> hash = hash_of_model(robot->model);
  if (!hash) return fail(std::move(hash.error()));
  return Studio(std::make_unique<Impl>(Impl{options, std::move(*robot), *jaws, std::move(*hash)}));
}

Result<Episode> Studio::make(std::uint64_t number, const StopCheck& stop) {
  const Robot& robot = impl_->robot;
  Episode out{.number = number};
  const DrawnScene scene = draw_scene(robot, impl_->options, number);
  Result<Demonstration> done =
      demonstrate(robot, impl_->jaws, impl_->options, scene, stop, out.times);
  if (!done) return fail(std::move(done.error()));
  out.verdict = done->verdict;
  StoredZipWriter archive;
  const Origin origin{impl_->options, number, impl_->model_hash};
  archive.add("episode.json", episode_json(robot, origin, scene, *done));
  add_columns(*done, archive);
  auto drawn = add_frames(robot, impl_->options, scene, *done, stop, out.times, archive);
  if (!drawn) return fail(std::move(drawn.error()));
  out.bytes = std::move(archive).finish();
  return out;
}

const std::string& Studio::model_hash() const { return impl_->model_hash; }

}  // namespace mjarm::episode

#include "mjarm/episode/record.hpp"

#include <cstdio>
#include <optional>
#include <span>
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

/// What a picture shows beside the model: what was written by then.
render::Overlay overlay_of(std::span<const InkSpot> ink) {
  constexpr double kWidth = 2.5e-3, kSpacing = 1e-3;  // [m]
  render::Overlay out;
  for (const InkSpot& spot : ink) {
    if (spot.begins || out.lines.empty()) {
      out.lines.push_back(
          {.width = kWidth, .color = {0.05F, 0.1F, 0.5F, 1}, .look = render::LineLook::tube});
    }
    std::vector<Eigen::Vector3d>& points = out.lines.back().points_W;
    if (points.empty() || (spot.p_W - points.back()).norm() >= kSpacing) points.push_back(spot.p_W);
  }
  return out;
}

/// Draws the same picture of two models: one is used until a lamp is on.
class FrameDrawer {
 public:
  FrameDrawer(const Robot& robot, const Task& task, int size)
      : model_(robot.model), task_(task), size_(size) {}

  Result<render::Image> draw(const Sample& sample, const DrawnView& view, EpisodeTimes& times) {
    const Stopwatch watch;
    std::optional<render::OffscreenRenderer>& renderer = sample.lit ? lit_ : dark_;
    if (!renderer) {
      auto opened = open(sample.lit);
      if (!opened) return fail(std::move(opened.error()));
      renderer = std::move(*opened);
    }
    auto image = renderer->draw(sample.state, {.view = view.view},
                                overlay_of(task_.ink().first(sample.ink)));
    times.rendering += watch.us();
    return image;
  }

 private:
  [[nodiscard]] Result<render::OffscreenRenderer> open(bool lit) const {
    LooksChange change = task_.scene().looks;
    const auto& more = task_.scene().lit;
    if (lit) change.geoms.insert(change.geoms.end(), more.begin(), more.end());
    const Result<Model> looks = with_looks(model_, change);
    if (!looks) return fail(looks.error());
    return render::OffscreenRenderer::create(
        *looks,
        {.width = size_, .height = size_, .quality = render::RenderQuality::low, .sites = false});
  }

  const Model& model_;
  const Task& task_;
  int size_;
  std::optional<render::OffscreenRenderer> dark_, lit_;
};

/// Draws every row as every camera sees it.
Result<void> add_frames(const Robot& robot, const EpisodeOptions& options, const Task& task,
                        const Demonstration& done, const StopCheck& stop, EpisodeTimes& times,
                        StoredZipWriter& out) {
  FrameDrawer drawer(robot, task, options.size);
  for (const DrawnView& view : task.scene().views) {
    for (std::size_t row = 0; row < done.samples.size(); ++row) {
      if (is_stopped(stop)) return fail(stopped());
      const auto image = drawer.draw(done.samples[row], view, times);
      if (!image) return fail(image.error());
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

struct Studio::Impl {
  EpisodeOptions options;
  Robot robot;  ///< as its file has it
  std::optional<Jaws> jaws;
  std::string model_hash;
};

Studio::Studio(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Studio::~Studio() = default;
Studio::Studio(Studio&&) noexcept = default;
Studio& Studio::operator=(Studio&&) noexcept = default;

Result<Studio> Studio::open(const EpisodeOptions& options) {
  if (Result<void> fits = check(options); !fits) return fail(std::move(fits.error()));
  Result<Robot> robot = load_robot(scene_file(options));
  if (!robot) return fail(std::move(robot.error()));
  std::optional<Jaws> jaws;
  if (robot->arm.gripper) {
    const Result<Jaws> found = find_jaws(robot->model, robot->arm);
    if (!found) return fail(found.error());
    jaws = *found;
  }
  const Result<Exported> binary = export_model(robot->model, ExportFormat::mjb, {});
  if (!binary) return fail(binary.error());
  return Studio(
      std::make_unique<Impl>(Impl{options, std::move(*robot), jaws, sha256(binary->content)}));
}

Result<Episode> Studio::make(std::uint64_t number, const StopCheck& stop) {
  Episode out{.number = number};
  const std::unique_ptr<Task> task = draw_task(impl_->robot, impl_->options, number);
  Robot robot = impl_->robot;
  if (const auto& places = task->scene().places; !places.empty()) {
    Result<Model> placed = with_bodies_at(robot.model, places);
    if (!placed) return fail(std::move(placed.error()));
    robot.model = std::move(*placed);
  }
  Result<Demonstration> done =
      demonstrate(robot, impl_->jaws, impl_->options, *task, stop, out.times);
  if (!done) return fail(std::move(done.error()));
  out.verdict = done->verdict;
  StoredZipWriter archive;
  const Origin origin{impl_->options, number, impl_->model_hash};
  archive.add("episode.json", episode_json(robot, origin, *task, *done));
  add_columns(*done, archive);
  auto drawn = add_frames(robot, impl_->options, *task, *done, stop, out.times, archive);
  if (!drawn) return fail(std::move(drawn.error()));
  out.bytes = std::move(archive).finish();
  return out;
}

const std::string& Studio::model_hash() const { return impl_->model_hash; }

}  // namespace mjarm::episode

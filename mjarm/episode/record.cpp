#include "mjarm/episode/record.hpp"

#include <cstdio>
#include <optional>
#include <utility>

#include "mjarm/core/sha256.hpp"
#include "mjarm/core/stopwatch.hpp"
#include "mjarm/episode/archive_internal.hpp"
#include "mjarm/episode/studio_internal.hpp"
#include "mjarm/model/export.hpp"
#include "mjarm/render/png.hpp"

namespace mjarm::episode {
namespace {

constexpr std::size_t kNameSize = 64;

std::string frame_name(const std::string& camera, std::size_t row) {
  char number[kNameSize];
  std::snprintf(number, sizeof number, "/%06zu.png", row);
  return "frames/" + camera + number;
}

/// Draws every row as every camera sees it.
Result<void> add_frames(const Robot& robot, const EpisodeOptions& options, const Task& task,
                        const Demonstration& done, const StopCheck& stop, EpisodeTimes& times,
                        StoredZipWriter& out) {
  if (done.samples.empty()) return {};
  const Stopwatch opening;
  auto renderer = open_pictures(robot, options, task.scene());
  if (!renderer) return fail(std::move(renderer.error()));
  times.rendering += opening.us();
  for (const DrawnView& view : task.scene().views) {
    for (std::size_t row = 0; row < done.samples.size(); ++row) {
      if (is_stopped(stop)) return fail(stopped());
      const Stopwatch drawing;
      const Sample& sample = done.samples[row];
      const auto image =
          renderer->draw(sample.state, {.view = view.view}, task.overlay(sample.marks));
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
  Robot robot;  ///< as its file has it
  std::optional<Jaws> jaws;
  std::string model_hash;
};

Studio::Studio(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Studio::~Studio() = default;
Studio::Studio(Studio&&) noexcept = default;
Studio& Studio::operator=(Studio&&) noexcept = default;

Result<Studio> Studio::open(const EpisodeOptions& options) {
  Result<Robot> robot = load_task_robot(options);
  if (!robot) return fail(std::move(robot.error()));
  std::optional<Jaws> jaws;
  if (robot->arm.gripper) {
    const Result<Jaws> found = find_jaws(robot->model, robot->arm);
    if (!found) return fail(found.error());
    jaws = *found;
  }
  Result<std::string> hash = hash_of_model(robot->model);
  if (!hash) return fail(std::move(hash.error()));
  return Studio(std::make_unique<Impl>(Impl{options, std::move(*robot), jaws, std::move(*hash)}));
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

const Robot& Studio::robot() const { return impl_->robot; }
const std::string& Studio::model_hash() const { return impl_->model_hash; }

}  // namespace mjarm::episode

#include "mjarm/clone/demonstrated.hpp"

#include <cmath>
#include <string>
#include <utility>

#include "mjarm/core/messages/clone.hpp"
#include "mjarm/core/messages/core.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/core/stored_zip.hpp"
#include "mjarm/episode/draw_scene.hpp"
#include "mjarm/episode/episode_file.hpp"
#include "mjarm/episode/read_column.hpp"
#include "mjarm/episode/record.hpp"

namespace mjarm::clone {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kPose = 7;  // numbers of one

Pose pose_at(std::span<const double> row, std::size_t pose) {
  const auto x = row.subspan(kPose * pose, kPose);
  return {.p = {x[0], x[1], x[2]}, .R = to_matrix(Quat(x[3], x[4], x[5], x[6]))};
}

/// The columns that a policy learns from.
struct LearnedColumns {
  episode::NumberRows tool, gripper, objects, action;
};

Result<LearnedColumns> read_columns(const episode::EpisodeFile& file, std::size_t objects,
                                    const std::string& source) {
  const Result<StoredZip> zip = StoredZip::open(file.bytes, source);
  if (!zip) return fail(zip.error());
  LearnedColumns out;
  const std::pair<episode::NumberRows*, std::pair<const char*, std::size_t>> wanted[] = {
      {&out.tool, {"tool_pose", kPose}},
      {&out.gripper, {"gripper", 1}},
      {&out.objects, {"object_poses", kPose * objects}},
      {&out.action, {"action_tool", kPose + 1}}};
  for (const auto& [column, what] : wanted) {
    auto read = episode::read_column(*zip, what.first, what.second, source);
    if (!read) return fail(std::move(read.error()));
    *column = std::move(*read);
    if (column->rows() != out.tool.rows()) {
      return fail(Errc::bad_input,
                  text(msg::clone_rows, source, what.first, column->rows(), out.tool.rows()));
    }
  }
  return out;
}

/// What stays the same from row to row.
Observed scene_of(const episode::DrawnScene& scene) {
  Observed out;
  out.objects.resize(scene.objects.size());
  out.target = scene.target;
  out.p_place = *scene.p_goal;
  return out;
}

void add_rows(const LearnedColumns& columns, const Observed& scene, std::vector<Shown>& out) {
  for (std::size_t i = 0; i < columns.tool.rows(); ++i) {
    Shown row{.seen = scene, .answer = {}};
    // The reference of a row is what the row before asked for.
    row.seen.X_WT = i == 0 ? pose_at(columns.tool.row(0), 0) : out.back().answer.X_WT;
    row.seen.grip = columns.gripper.row(i)[0];
    for (std::size_t k = 0; k < row.seen.objects.size(); ++k) {
      row.seen.objects[k] = pose_at(columns.objects.row(i), k);
    }
    row.answer = {.X_WT = pose_at(columns.action.row(i), 0), .grip = columns.action.row(i)[kPose]};
    out.push_back(std::move(row));
  }
}

Result<void> add_episode(const fs::path& file, episode::Studio& studio, Demonstrated& out) {
  const Result<episode::EpisodeFile> read = episode::read_episode(file);
  if (!read) return fail(read.error());
  const std::string source = file.string();
  if (read->head.model_hash != studio.model_hash()) {
    return fail(Errc::bad_input, text(msg::clone_other_model, source));
  }
  if (read->head.options != out.options) {
    return fail(Errc::bad_input, text(msg::clone_other_options, source));
  }
  const episode::DrawnScene scene =
      episode::draw_scene(studio.robot(), out.options, read->head.number);
  const Result<LearnedColumns> columns = read_columns(*read, scene.objects.size(), source);
  if (!columns) return fail(columns.error());
  add_rows(*columns, scene_of(scene), out.rows);
  out.numbers.push_back(read->head.number);
  return {};
}

}  // namespace

Result<Demonstrated> read_demonstrated(const fs::path& folder, std::size_t most,
                                       const StopCheck& stop) {
  if (!fs::is_directory(folder)) {
    return fail(Errc::bad_input, text(msg::core_no_such_folder, folder.string()));
  }
  std::vector<fs::path> files = episode::succeeded_files(folder);
  if (files.empty()) return fail(Errc::bad_input, text(msg::clone_none, folder.string()));
  if (most > 0 && files.size() > most) files.resize(most);
  const Result<episode::EpisodeFile> first = episode::read_episode(files.front());
  if (!first) return fail(first.error());
  Demonstrated out{.options = first->head.options, .numbers = {}, .rows = {}};
  Result<episode::Studio> studio = episode::Studio::open(out.options);
  if (!studio) return fail(std::move(studio.error()));
  if (!episode::draw_scene(studio->robot(), out.options, 0).p_goal) {
    return fail(Errc::bad_input, text(msg::clone_task, folder.string(), out.options.task));
  }
  for (const fs::path& file : files) {
    if (is_stopped(stop)) return fail(stopped());
    if (auto added = add_episode(file, *studio, out); !added) return fail(std::move(added.error()));
  }
  return out;
}

Shown blurred(Shown row, Rng& rng) {
  constexpr double kStays = 0.3;                    // share of rows that stay as they are
  constexpr double kLeast = 0.001, kMost = 0.02;    // [m] spread of places, by powers
  constexpr double kTurnPerWay = 4;                 // [rad/m]
  constexpr double kHoldsFrom = 0.3, kHolds = 0.1;  // command and distance [m] of what is held
  if (rng.uniform() < kStays) return row;
  const double spread = kLeast * std::pow(kMost / kLeast, rng.uniform());
  const auto vector = [&](double size) {
    return Eigen::Vector3d(size * rng.normal(), size * rng.normal(), size * rng.normal());
  };
  Pose beside{.p = vector(spread)};
  beside.R = rotation_exp(vector(kTurnPerWay * spread));
  Pose& object = row.seen.objects[row.seen.target];
  const Pose X_TB = row.seen.X_WT.inverse() * object;
  const bool holds = row.seen.grip > kHoldsFrom && X_TB.p.norm() < kHolds;
  row.seen.X_WT = row.seen.X_WT * beside;
  if (holds) object = row.seen.X_WT * X_TB;
  return row;
}

}  // namespace mjarm::clone

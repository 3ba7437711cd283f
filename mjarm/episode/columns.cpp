#include <algorithm>
#include <functional>
#include <vector>

#include "mjarm/core/rotation.hpp"
#include "mjarm/episode/archive_internal.hpp"
#include "mjarm/episode/npy_internal.hpp"

namespace mjarm::episode {
namespace {

using Row = std::vector<double>;

void append_pose(Row& row, const Pose& X) {
  const Quat quat = to_quat(X.R);
  row.insert(row.end(), {X.p.x(), X.p.y(), X.p.z(), quat.w(), quat.x(), quat.y(), quat.z()});
}

Row row_of(const JointVec& values) { return {values.data(), values.data() + values.size()}; }

Row row_of(const Pose& X) {
  Row row;
  append_pose(row, X);
  return row;
}

Row with_grip(Row row, const Sample& sample) {
  row.push_back(sample.grip);
  return row;
}

struct Column {
  const char* name;
  const char* unit;
  const char* meaning;
  /// Of a sample and the one after it, which for the last is itself.
  std::function<Row(const Sample& now, const Sample& next)> row;
};

const std::vector<Column>& columns() {
  static const std::vector<Column> all{
      {"time", "s", "of the simulation", [](auto& s, auto&) { return Row{s.state.time}; }},
      {"qpos", "rad, m or 1", "MuJoCo's qpos of the whole scene",
       [](auto& s, auto&) { return s.qpos; }},
      {"qvel", "rad/s or m/s", "MuJoCo's qvel", [](auto& s, auto&) { return s.qvel; }},
      {"ctrl", "of the actuators", "MuJoCo's ctrl of the last step",
       [](auto& s, auto&) { return s.ctrl; }},
      {"joint_position", "rad", "the arm's joints", [](auto& s, auto&) { return row_of(s.q); }},
      {"joint_velocity", "rad/s", "the arm's joints", [](auto& s, auto&) { return row_of(s.v); }},
      {"joint_reference", "rad", "where the controller wants the joints at this time",
       [](auto& s, auto&) { return row_of(s.q_ref); }},
      {"tool_pose", "m and 1", "x y z qw qx qy qz of the tool in the world",
       [](auto& s, auto&) { return row_of(s.X_WT); }},
      {"gripper", "1", "command, 0 open to 1 closed", [](auto& s, auto&) { return Row{s.grip}; }},
      {"object_poses", "m and 1", "x y z qw qx qy qz of each object in the world",
       [](auto& s, auto&) {
         Row row;
         for (const Pose& X_WB : s.objects) append_pose(row, X_WB);
         return row;
       }},
      {"motion", "1", "index in plan.motions",
       [](auto& s, auto&) { return Row{static_cast<double>(s.motion)}; }},
      {"action_joint", "rad, gripper 1",
       "joint_reference and gripper of the next row; of the last row its own",
       [](auto&, auto& next) { return with_grip(row_of(next.q_ref), next); }},
      {"action_tool", "m and 1", "x y z qw qx qy qz of the tool at action_joint, then the gripper",
       [](auto&, auto& next) { return with_grip(row_of(next.X_WT_ref), next); }},
  };
  return all;
}

}  // namespace

void add_columns(const Demonstration& done, StoredZipWriter& out) {
  const std::vector<Sample>& samples = done.samples;
  for (const Column& column : columns()) {
    Row values;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const Row row = column.row(samples[i], samples[std::min(i + 1, samples.size() - 1)]);
      values.insert(values.end(), row.begin(), row.end());
    }
    const std::size_t width = samples.empty() ? 0 : values.size() / samples.size();
    out.add(std::string(column.name) + ".npy", npy(values, {samples.size(), width}));
  }
}

JsonDoc columns_doc() {
  std::vector<JsonDoc> out;
  for (const Column& column : columns()) {
    out.push_back({{"name", column.name}, {"unit", column.unit}, {"meaning", column.meaning}});
  }
  return out;
}

}  // namespace mjarm::episode

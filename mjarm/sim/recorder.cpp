#include "mjarm/sim/recorder.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "mjarm/core/csv.hpp"
#include "mjarm/core/file.hpp"
#include "mjarm/core/number.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/sim/ghost_internal.hpp"

namespace mjarm {
namespace {

std::string joined(const std::vector<Contact>& contacts) {
  std::string all;
  for (const Contact& contact : contacts) {
    all += (all.empty() ? "" : ";") + contact.first + "|" + contact.second;
  }
  return all;
}

void append_pose(std::string& line, const Pose& X) {
  const Quat quat = to_quat(X.R);
  for (const double value : {X.p.x(), X.p.y(), X.p.z(), quat.w(), quat.x(), quat.y(), quat.z()}) {
    line += ',';
    append_number(line, value);
  }
}

void append_joints(std::string& line, const JointVec& values) {
  for (const double value : values) {
    line += ',';
    append_number(line, value);
  }
}

/// Column names of one quantity a joint; `turning` and `sliding` are its units.
void append_titles(std::string& line, const Arm& arm, const std::string& quantity,
                   const std::string& turning, const std::string& sliding) {
  for (const ArmJoint& joint : arm.joints) {
    const std::string& unit = joint.type == JointType::hinge ? turning : sliding;
    line += ',' + csv_field(quantity + " " + joint.name + (unit.empty() ? "" : " [" + unit + "]"));
  }
}

void append_pose_titles(std::string& line, const std::string& quantity) {
  for (const char* axis : {"x [m]", "y [m]", "z [m]", "qw", "qx", "qy", "qz"}) {
    line += ',' + quantity + " " + axis;
  }
}

}  // namespace

/// Rows lie flat in one vector: 1 + 5 dof numbers and two poses of 12 each.
struct Recorder::Impl {
  Arm arm;
  RecordOptions options;
  Ghost ghost;
  std::vector<double> numbers;
  std::vector<std::size_t> touching;      ///< index into `pairs`, one a row
  std::vector<std::string> pairs = {""};  ///< distinct contact texts, in order of appearance
  std::size_t calls = 0;
  std::size_t stride;

  Impl(const Model& model, const Arm& source, const RecordOptions& wanted)
      : arm(source),
        options(wanted),
        ghost(model, source),
        stride(static_cast<std::size_t>(std::max(wanted.every, 1))) {
    options.max_rows = std::max<std::size_t>(options.max_rows, 2);
  }

  [[nodiscard]] std::size_t width() const { return 25 + 5 * static_cast<std::size_t>(arm.dof()); }
  [[nodiscard]] std::size_t planned_at() const {
    return 1 + 5 * static_cast<std::size_t>(arm.dof());
  }

  void put(const JointVec& values) {
    numbers.insert(numbers.end(), values.data(), values.data() + values.size());
  }
  void put(const Pose& X) {
    numbers.insert(numbers.end(), X.p.data(), X.p.data() + 3);
    numbers.insert(numbers.end(), X.R.data(), X.R.data() + 9);
  }
  [[nodiscard]] JointVec joints(const double* row, int quantity) const {
    return Eigen::Map<const Eigen::VectorXd>(row + 1 + quantity * arm.dof(), arm.dof());
  }
  [[nodiscard]] static Pose pose(const double* at) {
    return {Eigen::Map<const Eigen::Vector3d>(at), Eigen::Map<const Eigen::Matrix3d>(at + 3)};
  }

  /// Drops every second row, so that the rest stays evenly spaced from the first on.
  void thin_out() {
    const std::size_t rows = touching.size();
    std::size_t kept = 0;
    for (std::size_t i = 0; i < rows; i += 2, ++kept) {
      std::copy_n(numbers.begin() + static_cast<std::ptrdiff_t>(i * width()), width(),
                  numbers.begin() + static_cast<std::ptrdiff_t>(kept * width()));
      touching[kept] = touching[i];
    }
    numbers.resize(kept * width());
    touching.resize(kept);
    stride *= 2;
  }

  [[nodiscard]] std::size_t index_of(const std::string& words) {
    const auto known = std::find(pairs.rbegin(), pairs.rend(), words);
    if (known != pairs.rend()) return static_cast<std::size_t>(pairs.rend() - known) - 1;
    pairs.push_back(words);
    return pairs.size() - 1;
  }
};

Recorder::Recorder(const Model& model, const Arm& arm, const RecordOptions& options)
    : impl_(std::make_unique<Impl>(model, arm, options)) {}
Recorder::~Recorder() = default;
Recorder::Recorder(Recorder&&) noexcept = default;
Recorder& Recorder::operator=(Recorder&&) noexcept = default;

void Recorder::record(const Sim& sim, const JointVec& q_ref) {
  Impl& me = *impl_;
  if (me.calls++ % me.stride != 0) return;
  const JointState state = sim.arm_state(me.arm);
  JointVec ctrl = JointVec::Zero(me.arm.dof());
  for (int i = 0; i < me.arm.dof(); ++i) {
    if (me.arm.joints[i].actuator) ctrl[i] = sim.ctrl()[me.arm.joints[i].actuator->id];
  }
  me.numbers.push_back(sim.time());
  me.put(q_ref);
  me.put(state.q);
  me.put(state.v);
  me.put(ctrl);
  me.put(sim.arm_torque(me.arm));
  me.put(me.ghost.tool(sim, q_ref));
  me.put(sim.tool(me.arm));
  me.touching.push_back(me.index_of(joined(sim.contacts())));
  if (me.touching.size() >= me.options.max_rows) me.thin_out();
}

std::size_t Recorder::size() const noexcept { return impl_->touching.size(); }

RecordRow Recorder::row(std::size_t i) const {
  const Impl& me = *impl_;
  const double* row = me.numbers.data() + i * me.width();
  return {row[0],
          me.joints(row, 0),
          me.joints(row, 1),
          me.joints(row, 2),
          Impl::pose(row + me.planned_at()),
          Impl::pose(row + me.planned_at() + 12),
          me.joints(row, 3),
          me.joints(row, 4),
          me.pairs[me.touching[i]]};
}

std::string Recorder::to_csv() const {
  const Arm& arm = impl_->arm;
  std::string csv = "time [s]";
  append_titles(csv, arm, "q_ref", "rad", "m");
  append_titles(csv, arm, "q", "rad", "m");
  append_titles(csv, arm, "v", "rad/s", "m/s");
  append_pose_titles(csv, "tool_ref");
  append_pose_titles(csv, "tool");
  append_titles(csv, arm, "ctrl", "", "");
  append_titles(csv, arm, "torque", "N m", "N");
  csv += ",contacts\n";
  for (std::size_t i = 0; i < size(); ++i) {
    const RecordRow line = row(i);
    append_number(csv, line.time);
    append_joints(csv, line.q_ref);
    append_joints(csv, line.q);
    append_joints(csv, line.v);
    append_pose(csv, line.X_ref);
    append_pose(csv, line.X_WT);
    append_joints(csv, line.ctrl);
    append_joints(csv, line.torque);
    csv += ',' + csv_field(line.contacts) + '\n';
  }
  return csv;
}

Result<void> Recorder::write_csv(const std::filesystem::path& file) const {
  return write_file(file, to_csv());
}

}  // namespace mjarm

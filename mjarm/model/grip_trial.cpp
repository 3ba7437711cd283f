#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>

#include "mjarm/core/rotation.hpp"
#include "mjarm/model/arm_parts_internal.hpp"
#include "mjarm/model/grip_mend_internal.hpp"
#include "mjarm/model/grip_trial_internal.hpp"
#include "mjarm/model/gripper_command.hpp"
#include "mjarm/model/home.hpp"
#include "mjarm/model/mujoco_guard.hpp"
#include "mjarm/model/scene_bodies.hpp"

namespace mjarm::detail {
namespace {

using Eigen::Vector3d;

constexpr double kGravity = 9.81;   // [m/s^2]
constexpr double kHold = 30;        // [rad/s] of the springs that hold the arm
constexpr double kOpenTime = 2;     // [s] at most
constexpr double kCloseTime = 3;    // [s] at most
constexpr double kRestTime = 1;     // [s] at most, from when they touch
constexpr double kLoadTime = 0.6;   // [s] from when the cube is let go to when creep is measured
constexpr double kCreepTime = 1.5;  // [s]
constexpr int kWindows = 15;        // of it
constexpr double kRest = 0.05;      // [s] between looks whether the fingers rest
constexpr int kMaxSteps = 3000;     // of each phase
constexpr double kStill = 1e-3;     // [rad/s or m/s] slower is at rest
constexpr double kAgainst = 0.5;    // cosine between a push and the way of closing
constexpr double kAligned = 0.985;  // cosine of 10 degrees
constexpr double kOverlap = 5e-4;   // [m] deeper than a soft contact, in the open hand
constexpr double kMeet = 1e-4;      // [m] the same where nothing should touch

bool is_slider_or_hinge(const mjModel& m, int joint) {
  return m.jnt_type[joint] == mjJNT_HINGE || m.jnt_type[joint] == mjJNT_SLIDE;
}

}  // namespace

GripTrial::GripTrial(const mjModel& m, const Model& model, const Arm& arm, const Jaws& jaws)
    : source_(m), gripper_(*arm.gripper), jaws_(jaws), cube_body_(static_cast<int>(m.nbody) - 1) {
  cube_geom_ = m.body_geomadr[cube_body_];
  cube_qpos_ = m.jnt_qposadr[m.body_jntadr[cube_body_]];
  const SceneBodies bodies = scene_bodies(model, arm);
  hand_.assign(static_cast<std::size_t>(m.nbody), 0);
  for (std::size_t b = 0; b < bodies.role.size(); ++b) {
    hand_[b] = bodies.role[b] == BodyRole::hand ? 1 : 0;
  }
  for (int j = 0; j < static_cast<int>(m.njnt); ++j) {
    const bool of_hand = hand_[static_cast<std::size_t>(m.jnt_bodyid[j])] != 0;
    if (of_hand && is_slider_or_hinge(m, j)) hand_joints_.push_back(j);
  }
  for (int v = 0; v < static_cast<int>(m.nv); ++v) {
    const int body = m.dof_bodyid[v];
    spring_dof_.push_back(body != cube_body_ && hand_[static_cast<std::size_t>(body)] == 0);
  }
  const std::span<const double> home = home_configuration(model.raw());
  open_qpos_.assign(m.qpos0, m.qpos0 + m.nq);
  std::ranges::copy(home, open_qpos_.begin());
  for (int i = 0; i < arm.dof(); ++i) {
    open_qpos_[static_cast<std::size_t>(arm.joints[static_cast<std::size_t>(i)].qpos)] =
        arm.home[i];
  }
  // Small steps of the pads turn the nearest way a little.
  const Vector3d axis = nearest_axis(jaws_.close_T);
  if (axis.dot(jaws_.close_T) > kAligned) jaws_.close_T = axis;
  const Result<TipFrame> tip = find_frame(model, arm.tip);
  if (!tip) return;
  tip_ = *tip;
  open();
}

MjModelPtr GripTrial::hand_alone(const GripMend& mend) const {
  MjModelPtr copy(mj_copyModel(nullptr, &source_));
  mjModel& m = *copy;
  apply(mend, m);
  if (!mend.armature.empty()) {
    const MjDataPtr data(mj_makeData(&m));
    mj_setConst(&m, data.get());
  }
  const auto of_hand = [&](int body) { return hand_[static_cast<std::size_t>(body)] != 0; };
  for (int v = 0; v < static_cast<int>(m.nv); ++v) {
    if (spring_dof_[static_cast<std::size_t>(v)] == 0) continue;
    m.dof_damping[v] += 2 * kHold * m.dof_M0[v];
    mjtNum& stiffness = m.jnt_stiffness[m.dof_jntid[v]];
    stiffness = std::max(stiffness, kHold * kHold * m.dof_M0[v]);
  }
  for (int j = 0; j < static_cast<int>(m.njnt); ++j) {
    if (!spring_dof_[static_cast<std::size_t>(m.jnt_dofadr[j])]) continue;
    const int begin = m.jnt_qposadr[j];
    const int end = j + 1 < m.njnt ? m.jnt_qposadr[j + 1] : static_cast<int>(m.nq);
    std::copy(open_qpos_.begin() + begin, open_qpos_.begin() + end, m.qpos_spring + begin);
  }
  std::fill_n(m.body_gravcomp, cube_body_, 1.0);
  m.ngravcomp = cube_body_;
  for (int a = 0; a < static_cast<int>(m.nactuator); ++a) {
    const int row = m.actuator_ctrladr[a];
    if (std::ranges::count(gripper_.drives, row, &GripperDrive::id) > 0) continue;
    m.actuator_gaintype[a] = mjGAIN_FIXED;
    m.actuator_biastype[a] = mjBIAS_NONE;
    std::fill_n(m.actuator_gainprm + mjNGAIN * a, mjNGAIN, 0.0);
  }
  for (int g = 0; g < static_cast<int>(m.ngeom); ++g) {
    if (!of_hand(m.geom_bodyid[g])) m.geom_contype[g] = m.geom_conaffinity[g] = 0;
    if (mend.exclude.empty() || (m.geom_contype[g] == 0 && m.geom_conaffinity[g] == 0)) continue;
    m.geom_contype[g] = 0;  // touches the cube and nothing of the hand
    m.geom_conaffinity[g] = 1;
  }
  // What every gripper is measured on is the same, whatever the file takes for its own things.
  m.geom_contype[cube_geom_] = m.geom_conaffinity[cube_geom_] = 0x7fffffff;
  m.geom_condim[cube_geom_] = 3;
  m.geom_priority[cube_geom_] = 0;
  m.geom_margin[cube_geom_] = m.geom_gap[cube_geom_] = 0;
  m.geom_solmix[cube_geom_] = 1;
  const mjtNum friction[] = {1, 0.005, 0.0001}, solref[] = {0.02, 1};
  const mjtNum solimp[] = {0.9, 0.95, 0.001, 0.5, 2};
  std::ranges::copy(friction, m.geom_friction + 3 * cube_geom_);
  std::ranges::copy(solref, m.geom_solref + mjNREF * cube_geom_);
  std::ranges::copy(solimp, m.geom_solimp + mjNIMP * cube_geom_);
  mju_zero3(m.opt.gravity);
  m.opt.disableflags &= ~static_cast<int>(mjDSBL_GRAVITY);
  m.opt.enableflags &= ~static_cast<int>(mjENBL_SLEEP);
  return copy;
}

void GripTrial::step(const mjModel& m, mjData* d, double seconds) const {
  const int steps = std::clamp(static_cast<int>(seconds / m.opt.timestep), 1, kMaxSteps);
  for (int k = 0; k < steps; ++k) mj_step(&m, d);
}

/// Steps until the fingers rest.
bool GripTrial::rest(const mjModel& m, mjData* d, double seconds) const {
  const int looks = std::min(static_cast<int>(seconds / kRest),
                             static_cast<int>(kMaxSteps * m.opt.timestep / kRest) + 1);
  for (int k = 0; k < looks; ++k) {
    step(m, d, kRest);
    const bool still = std::ranges::all_of(
        hand_joints_, [&](int j) { return std::abs(d->qvel[m.jnt_dofadr[j]]) < kStill; });
    if (still && k > 0) return true;
  }
  return false;
}

void GripTrial::open() {
  const MjModelPtr m = hand_alone({});
  m->geom_contype[cube_geom_] = m->geom_conaffinity[cube_geom_] = 0;
  const MjDataPtr d(mj_makeData(m.get()));
  const MujocoOutcome outcome = mjarm::call_mujoco([&] {
    std::ranges::copy(open_qpos_, d->qpos);
    set_grip(gripper_, 0, {d->ctrl, static_cast<std::size_t>(m->nu)});
    rest(*m, d.get(), kOpenTime);
    mj_kinematics(m.get(), d.get());
  });
  opens_ = !outcome.failed && d->warning[mjWARN_BADQACC].number == 0;
  if (!opens_) return;
  for (const int j : hand_joints_) {
    const int at = m->jnt_qposadr[j];
    open_qpos_[static_cast<std::size_t>(at)] = d->qpos[at];
  }
  open_act_.assign(d->act, d->act + m->na);
  const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> R(d->xmat + 9 * tip_.body);
  X_WT_ = Pose{Vector3d(d->xpos + 3 * tip_.body), R} * tip_.X_BT;
  place_cube(*m);
  look_for_overlaps();
}

/// Between the open fingers, before the palm.
void GripTrial::place_cube(const mjModel& m) {
  const double half = m.geom_size[3 * cube_geom_];
  const double ahead = std::max(0.0, half + 2e-3 - jaws_.palm);
  const Vector3d p = X_WT_ * Vector3d(jaws_.center_T + ahead * jaws_.approach_T);
  Eigen::Matrix3d R_TC;
  R_TC << jaws_.side_T(), jaws_.close_T, jaws_.approach_T;
  if (R_TC.determinant() < 0) R_TC.col(0) *= -1;
  const Quat turn = to_quat(X_WT_.R * R_TC);
  const double pose[] = {p.x(), p.y(), p.z(), turn.w(), turn.x(), turn.y(), turn.z()};
  std::ranges::copy(pose, open_qpos_.begin() + cube_qpos_);
}

void GripTrial::look_for_overlaps() {
  const MjModelPtr m = hand_alone({});
  const MjDataPtr d(mj_makeData(m.get()));
  const MujocoOutcome outcome = mjarm::call_mujoco([&] {
    std::ranges::copy(open_qpos_, d->qpos);
    mj_fwdPosition(m.get(), d.get());
  });
  if (!outcome.failed) overlaps_ = overlaps_in(d.get(), kOverlap);
}

std::vector<JawOverlap> GripTrial::overlaps_in(const mjData* d, double deeper) const {
  std::vector<JawOverlap> out;
  for (int c = 0; c < d->ncon; ++c) {
    const mjContact& contact = d->contact[c];
    if (contact.dist > -deeper || contact.geom[0] < 0 || contact.geom[1] < 0) continue;
    JawOverlap overlap{{contact.geom[0], contact.geom[1]}, -contact.dist};
    if (overlap.geom[0] == cube_geom_) std::swap(overlap.geom[0], overlap.geom[1]);
    if (overlap.geom[1] == cube_geom_) overlap.geom[1] = -1;
    out.push_back(overlap);
  }
  return out;
}

/// What of the hand overlaps once it has closed as far as it goes, while the cube is where it was.
void GripTrial::note_stops(const mjData* d, GripOutcome& out) const {
  const Vector3d from(open_qpos_.data() + cube_qpos_), to(d->qpos + cube_qpos_);
  const double edge = 2 * source_.geom_size[3 * cube_geom_];
  if (!out.held && (out.touched || (to - from).norm() > edge / 2)) return;
  for (JawOverlap one : overlaps_in(d, kMeet)) {
    if (one.geom[1] < 0) continue;
    one.closing = true;
    out.overlaps.push_back(one);
  }
}

std::vector<int> GripTrial::finger_geoms() const {
  std::vector<char> moved(hand_.size(), 0);
  for (const int j : hand_joints_) moved[static_cast<std::size_t>(source_.jnt_bodyid[j])] = 1;
  std::vector<int> out;
  for (int g = 0; g < cube_geom_; ++g) {
    int body = source_.geom_bodyid[g];
    while (body > 0 && moved[static_cast<std::size_t>(body)] == 0)
      body = source_.body_parentid[body];
    const bool collides = source_.geom_contype[g] != 0 || source_.geom_conaffinity[g] != 0;
    if (body > 0 && collides) out.push_back(g);
  }
  return out;
}

bool GripTrial::is_held(const mjModel& m, const mjData* d, std::vector<int>* pads) const {
  bool sides[2] = {false, false};
  std::set<int> touching;
  const Vector3d close_W = X_WT_.R * jaws_.close_T;
  for (int c = 0; c < d->ncon; ++c) {
    const mjContact& contact = d->contact[c];
    const bool second = contact.geom[1] == cube_geom_;
    const int other = contact.geom[second ? 0 : 1];
    if ((!second && contact.geom[0] != cube_geom_) || other < 0 || contact.efc_address < 0) {
      continue;
    }
    const double push = Vector3d(contact.frame).dot(close_W) * (second ? 1 : -1);
    mjtNum force[6] = {0};
    mj_contactForce(&m, d, c, force);
    if (std::abs(push) < kAgainst || !(force[0] > 0)) continue;
    sides[push > 0 ? 1 : 0] = true;
    if (hand_[static_cast<std::size_t>(m.geom_bodyid[other])] != 0) touching.insert(other);
  }
  if (pads != nullptr) pads->assign(touching.begin(), touching.end());
  return sides[0] && sides[1];
}

double GripTrial::cube_along(const mjData* d) const {
  const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> R(d->xmat + 9 * tip_.body);
  const Vector3d p(Vector3d(d->xpos + 3 * cube_body_) - Vector3d(d->xpos + 3 * tip_.body));
  return (R * tip_.X_BT.R * jaws_.approach_T).dot(p);
}

/// The median over windows of time: now and then a box that rocks on its edges jumps.
double GripTrial::creep(const mjModel& m, mjData* d) const {
  std::array<double, kWindows> rates{};
  for (double& rate : rates) {
    const double before = cube_along(d), begin = d->time;
    step(m, d, std::min(kCreepTime, kMaxSteps * m.opt.timestep) / kWindows);
    rate = std::abs(cube_along(d) - before) / (d->time - begin);
  }
  std::ranges::nth_element(rates, rates.begin() + kWindows / 2);
  return rates[kWindows / 2];
}

/// True once both sides touch and the fingers rest.
bool GripTrial::close(const mjModel& m, mjData* d, GripOutcome& out) const {
  set_grip(gripper_, 1, {d->ctrl, static_cast<std::size_t>(m.nu)});
  const int steps = std::min(static_cast<int>(kCloseTime / m.opt.timestep), kMaxSteps);
  for (int k = 0; k < steps && !out.touched; ++k) {
    mj_step(&m, d);
    out.touched = is_held(m, d, nullptr);
  }
  out.closing_time = d->time;
  rest(m, d, kRestTime);
  return is_held(m, d, &out.pads);
}

GripOutcome GripTrial::run(const GripMend& mend) const {
  GripOutcome out;
  if (!opens_) return out;
  const MjModelPtr m = hand_alone(mend);
  const MjDataPtr d(mj_makeData(m.get()));
  const MujocoOutcome outcome = mjarm::call_mujoco([&] {
    std::ranges::copy(open_qpos_, d->qpos);
    std::ranges::copy(open_act_, d->act);
    out.held = close(*m, d.get(), out);
    note_stops(d.get(), out);
    if (!out.held) return;
    const Vector3d down = kGravity * (X_WT_.R * jaws_.approach_T);
    mju_copy3(m->opt.gravity, down.data());
    step(*m, d.get(), kLoadTime);
    out.creep = creep(*m, d.get());
    out.lost = !is_held(*m, d.get(), nullptr);
  });
  if (outcome.failed || d->warning[mjWARN_BADQACC].number > 0) out = {};
  return out;
}

}  // namespace mjarm::detail

#include "mjarm/model/jaws.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "mjarm/core/messages/model.hpp"
#include "mjarm/model/arm_parts_internal.hpp"
#include "mjarm/model/gripper_command.hpp"
#include "mjarm/model/home.hpp"
#include "mjarm/model/load_internal.hpp"
#include "mjarm/model/mujoco_guard.hpp"
#include "mjarm/model/scene_bodies.hpp"

namespace mjarm {
namespace {

using Eigen::Vector3d;

constexpr double kSettle = 2.0;   // [s] for the fingers to open
constexpr double kFar = 0.25;     // [m] what is farther from the tool frame is no finger
constexpr double kStep = 5e-4;    // [m] between rays that find where the fingers end
constexpr double kFlat = 2e-3;    // [m] by which a finger's surface may step back
constexpr int kDirections = 180;  // of closing that are tried, over half a turn
constexpr double kBehind = 0.05;  // [m] from the middle of the fingers back, where jaws may begin
constexpr double kAhead = 0.15;   // [m] and on, where they have ended
constexpr double kCoarse = 2e-3;  // [m] between places that are looked at
constexpr double kGrasp = 0.012;  // [m] from the fingertips to where a part is held, at most

/// Where a ray meets a part of the hand.
struct Hit {
  double far = kInf;  ///< [m] infinite where there is nothing near
  int body = -1;
};

/// An open gripper, and rays from its tool frame.
class OpenHand {
 public:
  OpenHand(const Model& model, const Arm& arm) : m_(model.raw()), d_(mj_makeData(m_)) {
    const SceneBodies bodies = scene_bodies(model, arm);
    for (int g = 0; g < static_cast<int>(m_->ngeom); ++g) {
      const int body = m_->geom_bodyid[g];
      if (bodies.role[static_cast<std::size_t>(body)] != BodyRole::hand) continue;
      if (m_->geom_contype[g] != 0 || m_->geom_conaffinity[g] != 0) geoms_.push_back(g);
    }
    last_link_ = m_->dof_bodyid[arm.joints.back().dof];
    if (const auto tip = find_frame(model, arm.tip)) tip_ = *tip;
  }

  /// Steps until the fingers stand open; all else stays where it is at home.
  void open(const Arm& arm, mjModel& still) {
    for (double& g : still.opt.gravity) g = 0;
    mj_resetData(&still, d_.get());
    std::ranges::copy(home_configuration(&still), d_->qpos);
    std::vector<double> rest(d_->qpos, d_->qpos + still.nq);
    for (int i = 0; i < arm.dof(); ++i) {
      rest[static_cast<std::size_t>(arm.joints[static_cast<std::size_t>(i)].qpos)] = arm.home[i];
    }
    set_grip(*arm.gripper, 0, {d_->ctrl, static_cast<std::size_t>(still.nu)});
    const std::vector<char> hand = hand_dofs(still);
    for (int k = 0; k < static_cast<int>(kSettle / still.opt.timestep); ++k) {
      for (int j = 0; j < static_cast<int>(still.njnt); ++j) hold(still, j, hand, rest);
      mj_step(&still, d_.get());
    }
    for (int j = 0; j < static_cast<int>(still.njnt); ++j) hold(still, j, hand, rest);
    mj_kinematics(&still, d_.get());
  }

  [[nodiscard]] Pose X_WT() const {
    const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> R(d_->xmat +
                                                                           9 * tip_.body);
    return Pose{Vector3d(d_->xpos + 3 * tip_.body), R} * tip_.X_BT;
  }

  /// From `p_W` along `way_W` (unit) to the hand.
  [[nodiscard]] Hit ray(const Vector3d& p_W, const Vector3d& way_W) const {
    Hit nearest;
    for (const int g : geoms_) {
      const mjtNum far =
          m_->geom_type[g] == mjGEOM_MESH
              ? mj_rayMesh(m_, d_.get(), g, p_W.data(), way_W.data(), nullptr)
              : mju_rayGeom(d_->geom_xpos + 3 * g, d_->geom_xmat + 9 * g, m_->geom_size + 3 * g,
                            p_W.data(), way_W.data(), m_->geom_type[g], nullptr);
      if (far >= 0 && far <= kFar && far < nearest.far) nearest = {far, m_->geom_bodyid[g]};
    }
    return nearest;
  }

  /// [m] the mean of where the hand's geoms are.
  [[nodiscard]] Vector3d middle_W() const { return middle_W(geoms_); }

  /// [m] the mean of where the geoms of its fingers are; of all, where none moves.
  [[nodiscard]] Vector3d fingers_W() const {
    std::vector<int> moved;
    for (const int g : geoms_) {
      if (m_->body_weldid[m_->geom_bodyid[g]] != m_->body_weldid[last_link_]) moved.push_back(g);
    }
    return middle_W(moved.empty() ? geoms_ : moved);
  }

  /// [m] where the last link of the arm begins.
  [[nodiscard]] Vector3d last_link_W() const { return Vector3d(d_->xpos + 3 * last_link_); }

 private:
  /// Per degree of freedom: it moves a part of the hand and nothing else.
  [[nodiscard]] std::vector<char> hand_dofs(const mjModel& m) const {
    std::vector<char> out(static_cast<std::size_t>(m.nv), 0);
    for (const int g : geoms_) {
      for (int b = m.geom_bodyid[g]; b > 0; b = m.body_parentid[b]) {
        const bool hand =
            std::ranges::any_of(geoms_, [&](int other) { return m.geom_bodyid[other] == b; });
        if (!hand) break;
        for (int k = 0; k < m.body_dofnum[b]; ++k) {
          out[static_cast<std::size_t>(m.body_dofadr[b] + k)] = 1;
        }
      }
    }
    return out;
  }

  void hold(const mjModel& m, int joint, const std::vector<char>& hand,
            const std::vector<double>& rest) {
    const int dof = m.jnt_dofadr[joint];
    if (hand[static_cast<std::size_t>(dof)] != 0) return;
    const std::array<int, 4> sizes = {7, 4, 1, 1}, dofs = {6, 3, 1, 1};
    const auto type = static_cast<std::size_t>(m.jnt_type[joint]);
    for (int k = 0; k < sizes[type]; ++k) {
      const int at = m.jnt_qposadr[joint] + k;
      d_->qpos[at] = rest[static_cast<std::size_t>(at)];
    }
    for (int k = 0; k < dofs[type]; ++k) d_->qvel[dof + k] = 0;
  }

  [[nodiscard]] Vector3d middle_W(const std::vector<int>& geoms) const {
    Vector3d sum = Vector3d::Zero();
    for (const int g : geoms) sum += Vector3d(d_->geom_xpos + 3 * g);
    return geoms.empty() ? sum : Vector3d(sum / static_cast<double>(geoms.size()));
  }

  const mjModel* m_;
  MjDataPtr d_;
  std::vector<int> geoms_;
  int last_link_ = 0;
  TipFrame tip_;
};

/// Measures the space between the fingers.
class JawsMeasure {
 public:
  explicit JawsMeasure(const OpenHand& hand) : hand_(hand), X_WT_(hand.X_WT()) {}

  std::optional<Jaws> measure() {
    const Vector3d behind = X_WT_.inverse() * hand_.middle_W();
    if (behind.norm() == 0) return std::nullopt;
    jaws_.approach_T = nearest_axis(-behind);
    return measure_here();
  }

  /// The same for a tool frame anywhere: between the fingers, near their tips.
  std::optional<Jaws> measure_along() {
    const Pose X_TW = X_WT_.inverse();
    const Vector3d middle = X_TW * hand_.fingers_W();
    const Vector3d ahead = middle - X_TW * hand_.last_link_W();
    if (ahead.norm() == 0) return std::nullopt;
    jaws_.approach_T = nearest_axis(ahead);
    std::optional<double> first, last;
    for (double s = -kBehind; s < kAhead; s += kCoarse) {
      origin_T_ = middle + s * jaws_.approach_T;
      if (!is_between()) continue;
      if (!first) first = s;
      last = s;
    }
    if (!first) return std::nullopt;
    const double back = std::min(kGrasp, (*last - *first) / 2);
    origin_T_ = middle + (*last - back) * jaws_.approach_T;
    return measure_here();
  }

 private:
  std::optional<Jaws> measure_here() {
    if (!find_closing()) return std::nullopt;
    jaws_.half_width = std::min(extent(jaws_.side_T()), extent(-jaws_.side_T()));
    jaws_.tips = extent(jaws_.approach_T);
    jaws_.palm = std::min(ray(jaws_.center_T, -jaws_.approach_T).far, kFar);
    return jaws_;
  }

  /// Parts that move against each other lie on both sides.
  [[nodiscard]] bool is_between() const {
    const Vector3d x = nearest_axis(jaws_.approach_T.unitOrthogonal());
    for (const Vector3d& way : {x, Vector3d(jaws_.approach_T.cross(x))}) {
      const Hit there = ray(origin_T_, way), back = ray(origin_T_, -way);
      if (there.far + back.far < kInf && there.body != back.body) return true;
    }
    return false;
  }

  [[nodiscard]] Hit ray(const Vector3d& p_T, const Vector3d& way_T) const {
    return hand_.ray(X_WT_ * p_T, X_WT_.R * way_T);
  }

  /// The direction in which two sides, parts that move against each other, are nearest together.
  bool find_closing() {
    const Vector3d x = nearest_axis(jaws_.approach_T.unitOrthogonal());
    const Vector3d y = jaws_.approach_T.cross(x);
    double best = kInf;
    for (int k = 0; k < kDirections; ++k) {
      const double angle = std::numbers::pi * k / kDirections;
      const Vector3d way = std::cos(angle) * x + std::sin(angle) * y;
      const Hit there = ray(origin_T_, way), back = ray(origin_T_, -way);
      if (there.far + back.far >= best - 1e-6 || there.body == back.body) continue;
      best = there.far + back.far;
      jaws_.close_T = way;
      jaws_.center_T = origin_T_ + way * (there.far - back.far) / 2;
      jaws_.opening = best;
    }
    return best < kInf;
  }

  /// [m] from the centre along `way_T` as far as there are fingers on both sides.
  [[nodiscard]] double extent(const Vector3d& way_T) const {
    double far = 0;
    for (; far < kFar; far += kStep) {
      const Vector3d p = jaws_.center_T + way_T * (far + kStep);
      const double most = jaws_.opening / 2 + kFlat;
      if (ray(p, jaws_.close_T).far > most || ray(p, -jaws_.close_T).far > most) break;
    }
    return far;
  }

  const OpenHand& hand_;
  Pose X_WT_;
  Vector3d origin_T_ = Vector3d::Zero();  ///< from where it is looked for the fingers
  Jaws jaws_;
};

}  // namespace

Result<Jaws> find_jaws(const Model& model, const Arm& arm) {
  if (!arm.gripper) return fail(Errc::not_available, text(msg::model_no_gripper, arm.name));
  OpenHand hand(model, arm);
  const MjModelPtr still(mj_copyModel(nullptr, model.raw()));
  const MujocoOutcome opened = call_mujoco([&] { hand.open(arm, *still); });
  std::optional<Jaws> jaws;
  if (!opened.failed) jaws = JawsMeasure(hand).measure();
  if (!opened.failed && !jaws) jaws = JawsMeasure(hand).measure_along();
  if (!jaws) return fail(Errc::not_available, text(msg::model_no_jaws, arm.name));
  return *jaws;
}

}  // namespace mjarm

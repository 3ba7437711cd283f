#include "mjarm/render/clear_view.hpp"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "mjarm/model/home.hpp"

namespace mjarm::render {
namespace {

using Eigen::Vector3d;

constexpr mjtByte kShownGroups[mjNGROUP] = {1, 1, 1, 0, 0, 0};
constexpr int kHeadings = 24;
constexpr double kElevations[] = {-0.22, -0.45, -0.85};  // [rad] the last one on what is read
constexpr std::size_t kMaxMarks = 80;                    // that are looked for
constexpr double kLevel = 0.3;       // what is read lies at least so much across
constexpr double kReading = 2;       // how much half a turn from there costs
constexpr double kTouching = 0.012;  // [m] in front of a mark does not hide it

/// The places of a model's parts in some state.
class Standing {
 public:
  explicit Standing(const Model& model)
      : m_(*model.raw()), d_(mj_makeData(model.raw()), mj_deleteData) {}
  /// @return false where the state is of another model.
  bool set(const Snapshot& moment) {
    if (!d_) return false;
    mj_resetData(&m_, d_.get());
    if (moment.state.empty()) {
      std::ranges::copy(home_configuration(&m_), d_->qpos);
    } else {
      if (static_cast<int>(moment.state.size()) != mj_stateSize(&m_, mjSTATE_INTEGRATION)) {
        return false;
      }
      mj_setState(&m_, d_.get(), moment.state.data(), mjSTATE_INTEGRATION);
    }
    mj_kinematics(&m_, d_.get());
    return true;
  }
  [[nodiscard]] const mjModel& model() const { return m_; }
  [[nodiscard]] const mjData& data() const { return *d_; }

 private:
  const mjModel& m_;
  std::unique_ptr<mjData, void (*)(mjData*)> d_;
};

bool is_drawn(const mjModel& m, int geom) {
  const int type = m.geom_type[geom];
  const bool bounded = type != mjGEOM_PLANE && type != mjGEOM_HFIELD;
  const float alpha =
      m.geom_matid[geom] >= 0 ? m.mat_rgba[4 * m.geom_matid[geom] + 3] : m.geom_rgba[4 * geom + 3];
  return bounded && alpha > 0 && kShownGroups[m.geom_group[geom]] != 0;
}

/// For each body whether it belongs to a tree that has joints.
std::vector<bool> moving_bodies(const mjModel& m) {
  std::vector<bool> root(static_cast<std::size_t>(m.nbody)), out(root.size());
  for (int b = 1; b < m.nbody; ++b) {
    if (m.body_dofnum[b] > 0) root[static_cast<std::size_t>(m.body_rootid[b])] = true;
  }
  for (int b = 1; b < m.nbody; ++b) {
    out[static_cast<std::size_t>(b)] = root[static_cast<std::size_t>(m.body_rootid[b])];
  }
  return out;
}

void add_corners(const mjModel& m, const mjData& d, int geom, std::vector<FramedBall>& balls) {
  const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> R_WG(d.geom_xmat + 9 * geom);
  const Eigen::Map<const Vector3d> p_W(d.geom_xpos + 3 * geom);
  const Eigen::Map<const Vector3d> middle(m.geom_aabb + 6 * geom);
  const Eigen::Map<const Vector3d> half(m.geom_aabb + 6 * geom + 3);
  for (int i = 0; i < 8; ++i) {
    const Vector3d corner((i & 1) != 0 ? 1 : -1, (i & 2) != 0 ? 1 : -1, (i & 4) != 0 ? 1 : -1);
    balls.push_back({p_W + R_WG * (middle + half.cwiseProduct(corner)), 0});
  }
}

/// Solids near the box round all that moves that are not much larger.
void add_solids_in_reach(const mjModel& m, const mjData& d, const std::vector<bool>& moves,
                         std::vector<FramedBall>& balls) {
  Vector3d low = balls.front().p_W, high = low;
  for (const FramedBall& ball : balls) {
    low = low.cwiseMin(ball.p_W);
    high = high.cwiseMax(ball.p_W);
  }
  const double reach = 0.5 * (high - low).norm();
  for (int g = 0; g < m.ngeom; ++g) {
    const bool solid = m.geom_contype[g] != 0 || m.geom_conaffinity[g] != 0;
    if (!solid || !is_drawn(m, g) || moves[static_cast<std::size_t>(m.geom_bodyid[g])]) continue;
    const Eigen::Map<const Vector3d> p_W(d.geom_xpos + 3 * g);
    const double radius = m.geom_rbound[g];
    const double way = (p_W - 0.5 * (low + high)).norm() - radius;
    if (radius < 2 * reach && way < 1.5 * reach) add_corners(m, d, g, balls);
  }
}

/// Marks that are looked for: evenly some of all.
std::vector<Vector3d> thinned(const std::vector<Vector3d>& all) {
  if (all.size() <= kMaxMarks) return all;
  std::vector<Vector3d> out;
  for (std::size_t i = 0; i < kMaxMarks; ++i) out.push_back(all[i * all.size() / kMaxMarks]);
  return out;
}

/// Share of the marks that nothing of the model hides from the camera.
double seen_share(const Standing& scene, std::span<const Vector3d> marks_W, const Vector3d& eye_W) {
  int seen = 0;
  for (const Vector3d& p_W : marks_W) {
    const Vector3d way = p_W - eye_W;
    if (way.norm() < kTouching) {  // MuJoCo stops at a ray without a direction
      ++seen;
      continue;
    }
    const double hit = mj_ray(&scene.model(), &scene.data(), eye_W.data(), way.data(), kShownGroups,
                              1, -1, nullptr, nullptr);
    if (hit < 0 || hit * way.norm() > way.norm() - kTouching) ++seen;
  }
  return static_cast<double>(seen) / static_cast<double>(marks_W.size());
}

/// How large the marks are in the picture, up to a common factor: the area they spread over, or a
/// part of their length where they are a line.
double spread(std::span<const Vector3d> marks_W, const CameraView& view) {
  const Vector3d right(std::sin(view.azimuth), -std::cos(view.azimuth), 0);
  const Vector3d forward(std::cos(view.elevation) * std::cos(view.azimuth),
                         std::cos(view.elevation) * std::sin(view.azimuth),
                         std::sin(view.elevation));
  const Vector3d up = right.cross(forward);
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const Vector3d& p : marks_W) mean += Eigen::Vector2d(right.dot(p), up.dot(p));
  mean /= static_cast<double>(marks_W.size());
  Eigen::Matrix2d sum = Eigen::Matrix2d::Zero();
  for (const Vector3d& p : marks_W) {
    const Eigen::Vector2d q = Eigen::Vector2d(right.dot(p), up.dot(p)) - mean;
    sum += q * q.transpose();
  }
  sum /= static_cast<double>(marks_W.size());
  return (std::sqrt(std::max(sum.determinant(), 0.0)) + 0.1 * sum.trace()) /
         (view.distance * view.distance);
}

/// Where `right_W` points to the right in the picture.
double reading_azimuth(const Vector3d& right_W) { return std::atan2(right_W.x(), -right_W.y()); }

double turned(double a, double b) { return std::abs(std::remainder(a - b, 2 * std::numbers::pi)); }

}  // namespace

std::vector<FramedBall> moving_parts(const Model& model, std::span<const Snapshot> moments) {
  const mjModel& m = *model.raw();
  const std::vector<bool> moves = moving_bodies(m);
  std::vector<FramedBall> balls;
  Standing scene(model);
  for (const Snapshot& moment : moments) {
    if (!scene.set(moment)) continue;
    for (int g = 0; g < m.ngeom; ++g) {
      if (!moves[static_cast<std::size_t>(m.geom_bodyid[g])] || !is_drawn(m, g)) continue;
      add_corners(m, scene.data(), g, balls);
    }
  }
  if (!balls.empty()) add_solids_in_reach(m, scene.data(), moves, balls);
  return balls;
}

CameraView clear_view(const Model& model, const ViewSubject& subject, double aspect) {
  const bool read = subject.right_W && subject.right_W->head<2>().norm() > kLevel;
  const double heading = read ? reading_azimuth(*subject.right_W) : default_view(model).azimuth;
  const std::vector<Vector3d> marks_W = thinned(subject.marks_W);
  struct Candidate {
    CameraView view;
    double seen = 1, spread = 0;
  };
  std::vector<Candidate> all;
  for (const double elevation : std::span(kElevations).first(read ? 3 : 2)) {
    for (int i = 0; i < kHeadings; ++i) {
      const double azimuth = heading + 2 * std::numbers::pi * i / kHeadings;
      Candidate& one = all.emplace_back();
      one.view = framing_view(model, subject.balls, {azimuth, elevation, aspect});
      if (marks_W.size() > 1) one.spread = spread(marks_W, one.view);
    }
  }
  if (!marks_W.empty() && !subject.moments.empty()) {
    for (Candidate& one : all) one.seen = 0;
    Standing scene(model);
    for (const Snapshot& moment : subject.moments) {
      if (!scene.set(moment)) continue;
      for (Candidate& one : all) {
        one.seen += seen_share(scene, marks_W, camera_place(one.view)) /
                    static_cast<double>(subject.moments.size());
      }
    }
  }
  double widest = 1e-12;
  for (const Candidate& one : all) widest = std::max(widest, one.spread);
  const auto worth = [&](const Candidate& one) {
    return 2 * one.seen + 0.5 * std::sqrt(one.spread / widest) -
           (read ? kReading : 0.15) * turned(one.view.azimuth, heading) / std::numbers::pi;
  };
  return std::ranges::max_element(all, {}, worth)->view;
}

}  // namespace mjarm::render

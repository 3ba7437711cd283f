#include <mujoco/mujoco.h>

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "mjarm/collision/cover_geoms_internal.hpp"
#include "mjarm/collision/cover_pairs_internal.hpp"
#include "mjarm/collision/edge_march_internal.hpp"
#include "mjarm/collision/exact_data_internal.hpp"
#include "mjarm/collision/exact_gaps_internal.hpp"
#include "mjarm/kinematics/fk.hpp"

namespace mjarm {
namespace {

using detail::GeomGroup;
using detail::GeomIds;
using detail::Look;
using detail::PlacedGeom;
using detail::Twist;
using detail::Watch;

constexpr double kMarchMeasured = 0.2;  // [m] farther than that balls round the geoms will do
constexpr double kFarthest = 10;        // [m] to which distances are measured
constexpr double kMeasureError = 1e-5;  // [m] more than MuJoCo's distances are off by

}  // namespace

struct ModelMarch::Impl final : detail::MarchGeometry {
  Impl(Model of, Arm whose, detail::GeomGroups parts, detail::Meetings meet)
      : model(std::move(of)),
        arm(std::move(whose)),
        groups(std::move(parts)),
        meetings(std::move(meet)),
        d(mj_makeData(model.raw())) {
    std::erase_if(meetings.standing, [&](const detail::Meetings::Standing& standing) {
      const int geom = groups.obstacles[standing.obstacle].geoms.front().geom;
      return model.raw()->geom_type[geom] == mjGEOM_HFIELD;
    });
  }

  const GeomGroup& link(int index) const { return groups.links[static_cast<std::size_t>(index)]; }
  const GeomGroup& obstacle(int index) const {
    return groups.obstacles[meetings.standing[static_cast<std::size_t>(index)].obstacle];
  }

  int links() const override { return static_cast<int>(groups.links.size()); }
  int joint_of(int index) const override { return link(index).joint; }
  double reach_of(int index) const override {
    double reach = 0;
    for (const PlacedGeom& placed : link(index).geoms) {
      reach = std::max(reach, placed.X_LG.p.norm() + ball(placed));
    }
    return reach;
  }
  int obstacles() const override { return static_cast<int>(meetings.standing.size()); }
  bool is_held(int index, int standing) const override {
    const auto& ignored = meetings.standing[static_cast<std::size_t>(standing)].ignored;
    return std::find(ignored.begin(), ignored.end(), index) == ignored.end();
  }
  std::span<const std::array<int, 2>> pairs() const override { return meetings.pairs; }

  void look(const Watch& watch, std::span<const Pose> X_WJ, const Twist& twist, double need,
            Look& out) override {
    const GeomGroup& ours = link(watch.link);
    const bool is_link = watch.obstacle < 0;
    const GeomGroup& other = is_link ? link(watch.other_link) : obstacle(watch.obstacle);
    for (const PlacedGeom& placed : ours.geoms) {
      const Pose X_WG = place_of(ours, X_WJ) * placed.X_LG;
      const double speed = twist.at(X_WG.p).norm() + twist.turn.norm() * ball(placed);
      for (const PlacedGeom& against : other.geoms) {
        const double apart =
            distance(placed, X_WG, against, place_of(other, X_WJ) * against.X_LG, kMarchMeasured);
        out.add(apart, need, kMeasureError, -speed, watch.bend);
      }
    }
  }

  double ball(const PlacedGeom& placed) const { return model.raw()->geom_rbound[placed.geom]; }
  bool is_plane(const PlacedGeom& placed) const {
    return model.raw()->geom_type[placed.geom] == mjGEOM_PLANE;
  }
  static Pose place_of(const GeomGroup& group, std::span<const Pose> X_WJ) {
    return group.joint < 0 ? Pose() : X_WJ[static_cast<std::size_t>(group.joint)];
  }

  /// No more than the distance of two geoms; exact below `measured`.
  double distance(const PlacedGeom& a, const Pose& X_WA, const PlacedGeom& b, const Pose& X_WB,
                  double measured) {
    if (!is_plane(a) && !is_plane(b)) {
      const double least = (X_WA.p - X_WB.p).norm() - ball(a) - ball(b);
      if (least > measured) return least;
    }
    GeomIds ids{a.geom, b.geom};
    detail::put_geom(*d, ids.geom1, X_WA);
    detail::put_geom(*d, ids.geom2, X_WB);
    const mjModel& m = *model.raw();
    if (m.geom_type[ids.geom1] > m.geom_type[ids.geom2]) std::swap(ids.geom1, ids.geom2);
    return detail::geom_distance(m, d.get(), ids, 2 * measured);
  }

  double distance(const GeomGroup& a, const GeomGroup& b, std::span<const Pose> X_WJ) {
    double least = std::numeric_limits<double>::infinity();
    for (const PlacedGeom& one : a.geoms) {
      for (const PlacedGeom& other : b.geoms) {
        least = std::min(least, distance(one, place_of(a, X_WJ) * one.X_LG, other,
                                         place_of(b, X_WJ) * other.X_LG, kFarthest));
      }
    }
    return least;
  }

  Model model;
  Arm arm;
  detail::GeomGroups groups;
  detail::Meetings meetings;
  detail::MjDataPtr d;
};

Result<ModelMarch> ModelMarch::create(const Model& model, const Arm& arm, const ContactRules& rules,
                                      const StopCheck& stop) {
  Result<detail::GeomGroups> groups = detail::group_geoms(model, arm, {.rules = rules});
  if (!groups) return fail(std::move(groups.error()));
  const detail::GeomSolids solids = solids_of_groups(*model.raw(), arm, *groups);
  const detail::MeetingProof proof(*model.raw(), arm, *groups, solids, rules);
  // Never from UserCache: what is verified is proved anew.
  auto meetings = find_meetings(proof, *groups, stop);
  if (!meetings) return fail(stopped());
  return ModelMarch(std::make_unique<Impl>(model, arm, std::move(*groups), std::move(*meetings)));
}

ModelMarch::ModelMarch(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
ModelMarch::~ModelMarch() = default;
ModelMarch::ModelMarch(const ModelMarch& other)
    : impl_(std::make_unique<Impl>(other.impl_->model, other.impl_->arm, other.impl_->groups,
                                   other.impl_->meetings)) {}
ModelMarch& ModelMarch::operator=(const ModelMarch& other) { return *this = ModelMarch(other); }
ModelMarch::ModelMarch(ModelMarch&&) noexcept = default;
ModelMarch& ModelMarch::operator=(ModelMarch&&) noexcept = default;

Result<VerifyResult> ModelMarch::verify_edge(std::span<const double> q0, std::span<const double> q1,
                                             const VerifyOptions& options) {
  return detail::march(impl_->arm, *impl_, q0, q1, options);
}

std::optional<double> ModelMarch::distance(const std::string& link, const std::string& other,
                                           std::span<const double> q) {
  std::vector<Pose> X_WJ(q.size());
  fk_all(impl_->arm, q, X_WJ);
  std::optional<double> least;
  const auto note = [&](const GeomGroup& a, const GeomGroup& b) {
    const double apart = impl_->distance(a, b, X_WJ);
    least = std::min(least.value_or(apart), apart);
  };
  for (int i = 0; i < impl_->links(); ++i) {
    if (link_name(i) != link) continue;
    for (int k = 0; k < impl_->obstacles(); ++k) {
      if (obstacle_name(k) == other && impl_->is_held(i, k)) {
        note(impl_->link(i), impl_->obstacle(k));
      }
    }
  }
  for (const auto& [a, b] : impl_->meetings.pairs) {
    const bool named = (link_name(a) == link && link_name(b) == other) ||
                       (link_name(a) == other && link_name(b) == link);
    if (named) note(impl_->link(a), impl_->link(b));
  }
  return least;
}

const std::string& ModelMarch::link_name(int link) const { return impl_->link(link).name; }
const std::string& ModelMarch::obstacle_name(int obstacle) const {
  return impl_->obstacle(obstacle).name;
}

}  // namespace mjarm

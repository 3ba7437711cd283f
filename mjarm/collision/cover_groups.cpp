#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "mjarm/collision/cover_geoms_internal.hpp"
#include "mjarm/collision/exact_data_internal.hpp"
#include "mjarm/collision/exact_gaps_internal.hpp"
#include "mjarm/core/messages/collision.hpp"
#include "mjarm/kinematics/fk.hpp"

namespace mjarm::detail {
namespace {

using Eigen::Vector3d;

constexpr double kLeastBound = 1e-5;  // [m] finer ones need more points than memory has

class GeomSorter {
 public:
  GeomSorter(const Model& model, const Arm& arm, const CoverOptions& options)
      : m_(*model.raw()),
        arm_(arm),
        options_(options),
        bodies_(m_, arm, options.rules.attached),
        filter_(m_, arm, options.rules) {}

  Result<GeomGroups> run() {
    if (const Result<void> fine = check(); !fine) return fail(fine.error());
    for (int g = 0; g < static_cast<int>(m_.ngeom); ++g) add(g);
    if (out_.links.empty()) return fail(Errc::bad_input, text(msg::collision_no_geoms, arm_.name));
    return std::move(out_);
  }

 private:
  Result<void> check() {
    if (!(options_.bound >= kLeastBound && options_.bound <= 1)) {
      return fail(Errc::bad_input, text(msg::collision_cover_bound, options_.bound));
    }
    const bool fits =
        options_.qpos.empty() || options_.qpos.size() == static_cast<std::size_t>(m_.nq);
    if (!fits || !std::all_of(options_.qpos.begin(), options_.qpos.end(),
                              [](double q) { return std::isfinite(q); })) {
      return fail(Errc::bad_input, text(msg::collision_cover_qpos, m_.nq));
    }
    d_.reset(mj_makeData(&m_));
    if (!d_ || !bodies_.matches || arm_.joints.empty()) return not_of_the_model();
    rest_ = options_.qpos.empty() ? rest_configuration(m_) : options_.qpos;
    place(rest_);
    out_.root = m_.body_rootid[bodies_.bodies.front()];
    // A wrong arm, or a base that `qpos` puts somewhere else.
    for (std::size_t j = 0; j < X_WJ_.size(); ++j) {
      const int qpos = arm_.joints[j].qpos;
      int id = 0;
      while (m_.jnt_qposadr[id] != qpos) ++id;
      const Vector3d anchor(d_->xanchor + 3 * id), axis(d_->xaxis + 3 * id);
      const bool hinge = arm_.joints[j].type == JointType::hinge;
      if ((X_WJ_[j].R * arm_.joints[j].axis - axis).norm() > 1e-6 ||
          (hinge && (X_WJ_[j].p - anchor).norm() > 1e-6)) {
        return not_of_the_model();
      }
    }
    return {};
  }

  tl::unexpected<Error> not_of_the_model() const {
    return fail(Errc::bad_input, text(msg::collision_cover_arm, arm_.name));
  }

  /// Places the model; the arm's joints as well, which matters to nothing but this frame.
  void place(const std::vector<double>& qpos) {
    std::copy(qpos.begin(), qpos.end(), d_->qpos);
    std::vector<double> q;
    for (const int address : bodies_.addresses)
      q.push_back(qpos[static_cast<std::size_t>(address)]);
    X_WJ_.resize(q.size());
    bodies_.place_attached(fk_all(arm_, q, X_WJ_), d_->qpos);
    mj_kinematics(&m_, d_.get());
  }

  int piece(int geom) const {
    return bodies_.pieces[static_cast<std::size_t>(m_.geom_bodyid[geom])];
  }

  void add(int geom) {
    std::vector<bool> meets(static_cast<std::size_t>(m_.ngeom));
    for (int other = 0; other < static_cast<int>(m_.ngeom); ++other) {
      meets[static_cast<std::size_t>(other)] = piece(other) != piece(geom) &&
                                               may_collide(m_, geom, other) &&
                                               !filter_.may_touch(geom, other);
    }
    if (std::find(meets.begin(), meets.end(), true) == meets.end()) return;
    if (piece(geom) == 0) {
      out_.obstacles.push_back({geom_name(m_, geom), -1, {{geom, pose_of_geom(geom)}}});
      return;
    }
    const auto [known, fresh] = groups_.try_emplace({piece(geom), meets}, out_.links.size());
    if (fresh) out_.links.push_back({free_name(geom), piece(geom) - 1, {}});
    out_.links[known->second].geoms.push_back({geom, pose_of_geom(geom)});
  }

  /// Name of the geom's body; of the geom where another group has it.
  std::string free_name(int geom) {
    std::string name = body_name(m_, m_.geom_bodyid[geom]);
    if (name.starts_with('#') || !names_.insert(name).second) name = geom_name(m_, geom);
    names_.insert(name);
    return name;
  }

  Pose pose_of_geom(int geom) const {
    const Pose X_WG = geom_pose(*d_, geom);
    const int joint = piece(geom) - 1;
    return joint < 0 ? X_WG : X_WJ_[static_cast<std::size_t>(joint)].inverse() * X_WG;
  }

  const mjModel& m_;
  const Arm& arm_;
  const CoverOptions& options_;
  ArmBodies bodies_;
  ContactFilter filter_;
  MjDataPtr d_;
  std::vector<double> rest_;
  std::vector<Pose> X_WJ_;
  std::map<std::pair<int, std::vector<bool>>, std::size_t> groups_;
  std::set<std::string> names_;
  GeomGroups out_;
};

}  // namespace

Result<GeomGroups> group_geoms(const Model& model, const Arm& arm, const CoverOptions& options) {
  if (Result<void> fine = check_contact_rules(model, arm, options.rules); !fine) {
    return fail(std::move(fine.error()));
  }
  return GeomSorter(model, arm, options).run();
}

}  // namespace mjarm::detail

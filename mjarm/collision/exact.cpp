#include "mjarm/collision/exact.hpp"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "mjarm/collision/exact_arm_bodies_internal.hpp"
#include "mjarm/collision/exact_data_internal.hpp"
#include "mjarm/collision/exact_gaps_internal.hpp"
#include "mjarm/collision/exact_memory_internal.hpp"
#include "mjarm/collision/never_meet_internal.hpp"
#include "mjarm/core/finite.hpp"
#include "mjarm/core/messages/collision.hpp"
#include "mjarm/core/rng.hpp"
#include "mjarm/kinematics/fk.hpp"

namespace mjarm {
namespace {

using detail::GeomGap;
using detail::GeomIds;

Eigen::Vector3d vector(const mjtNum* v) { return {v[0], v[1], v[2]}; }

}  // namespace

struct ExactChecker::Impl {
  Impl(const Model& model_in, const Arm& arm_in, const ExactOptions& options_in)
      : model(model_in),
        arm(arm_in),
        options(options_in),
        m(*model.raw()),
        m_wide(*model.raw()),
        sound(check_contact_rules(model, arm, options.rules)),
        bodies(m, arm, sound ? options.rules.attached : std::vector<AttachedBody>()),
        filter(m, arm, options.rules) {
    // The arrays are those of the shared model; only the options of these two heads differ.
    for (mjModel* head : {&m, &m_wide}) {
      head->opt.disableflags &= ~(mjDSBL_CONTACT | mjDSBL_CONSTRAINT | mjDSBL_NATIVECCD);
      head->opt.enableflags &= ~(mjENBL_SLEEP | mjENBL_SPECULATIVE);
    }
    m_wide.opt.enableflags |= mjENBL_OVERRIDE;
    m_wide.opt.o_margin = range();
    q_rest = options.qpos.empty() ? detail::rest_configuration(m) : options.qpos;
    std::vector<bool> moves;
    for (const int joints : bodies.pieces) moves.push_back(joints > 0);
    measured_here = detail::pairs_measured_here(m, moves);
    std::erase_if(measured_here, [&](GeomIds ids) { return is_left_out(ids.geom1, ids.geom2); });
    make_data();
  }
  Impl(const Impl& other)
      : model(other.model),
        arm(other.arm),
        options(other.options),
        m(other.m),
        m_wide(other.m_wide),
        sound(other.sound),
        bodies(other.bodies),
        filter(other.filter),
        q_rest(other.q_rest),
        measured_here(other.measured_here),
        constant_pairs(other.constant_pairs) {
    make_data();
  }

  /// [m] up to where distances are measured: beyond the margin, so that configurations beside one
  /// that was looked at are known to keep it.
  double range() const {
    constexpr double kBeyond = 0.02;
    return options.margin + kBeyond;
  }

  void make_data() {
    d.reset(mj_makeData(&m));
    if (d && fits()) std::copy(q_rest.begin(), q_rest.end(), d->qpos);
  }

  /// True where no joint of the arm is between two geoms: both are at rest, or both on one link or
  /// in its hand (closed fingers touch each other, wherever the arm is).
  bool are_rigid(int geom1, int geom2) const {
    const auto piece = [&](int geom) {
      return bodies.pieces[static_cast<std::size_t>(m.geom_bodyid[geom])];
    };
    return piece(geom1) == piece(geom2);
  }

  bool is_left_out(int geom1, int geom2) const {
    return are_rigid(geom1, geom2) || filter.may_touch(geom1, geom2);
  }

  /// [m] how deep two geoms may be in each other where one is attached and the other stands.
  double rest_depth(GeomIds ids) const {
    const auto at = [&](int geom) { return static_cast<std::size_t>(m.geom_bodyid[geom]); };
    const std::size_t b1 = at(ids.geom1), b2 = at(ids.geom2);
    const bool rests = (bodies.carried[b1] && bodies.pieces[b2] == 0) ||
                       (bodies.carried[b2] && bodies.pieces[b1] == 0);
    return rests ? options.rest_depth : 0;
  }

  /// A gap as it counts: bodies that rest on each other touch at most.
  double gap_of(GeomIds ids, double distance) const {
    return distance < 0 && distance >= -rest_depth(ids) ? 0 : distance;
  }

  bool fits() const {
    return q_rest.size() == static_cast<std::size_t>(m.nq) && all_finite(q_rest);
  }

  bool accepts(std::span<const double> q) const {
    return sound && fits() && bodies.matches && d && q.size() == bodies.addresses.size() &&
           std::all_of(q.begin(), q.end(), [](double value) { return std::isfinite(value); });
  }

  void place(std::span<const double> q) {
    for (std::size_t i = 0; i < q.size(); ++i) d->qpos[bodies.addresses[i]] = q[i];
    if (!bodies.attached.empty()) bodies.place_attached(fk(arm, q), d->qpos);
    mj_kinematics(&m, d.get());
    mj_comPos(&m, d.get());
    if (m.nflex > 0) mj_flex(&m, d.get());
  }

  /// True for a contact between two geoms that the arm moves against each other and no rule lets
  /// touch, but for those that are measured by gap_measured_here().
  bool counts(const mjContact& contact) const {
    const int geom1 = contact.geom[0];
    const int geom2 = contact.geom[1];
    if (geom1 < 0 || geom2 < 0 || detail::is_measured_here(m, geom1, geom2)) return false;
    return !is_left_out(geom1, geom2);
  }

  std::span<const mjContact> detect(const mjModel& head) {
    mj_collision(&head, d.get());
    return {d->contact, static_cast<std::size_t>(d->ncon)};
  }

  /// [m] by which any point is elsewhere than at the last look; infinite beyond the limits, where
  /// pairs may meet that never do within.
  double moved(std::span<const double> q) const {
    for (std::size_t i = 0; i < q.size(); ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      if (!(q[i] >= arm.limits.lower[k] && q[i] <= arm.limits.upper[k])) return kInfinity;
    }
    return memory.moved(q);
  }

  bool is_free(std::span<const double> q) {
    constexpr double kBeside = 0.05;  // [m] so near to what was looked at that more will follow
    const double moved = this->moved(q);
    if (memory.is_free(moved)) return true;
    if (moved < kBeside && options.margin > 0) return check(q).free;
    place(q);
    const bool free = !overlaps();
    memory.remember(q, {0, 0, 0});
    return free;
  }

  bool overlaps() {
    const double max = -options.allow_depth;
    const std::span<const mjContact> all = detect(m);
    return std::any_of(all.begin(), all.end(),
                       [&](const mjContact& contact) {
                         return contact.dist < max && counts(contact) &&
                                gap_of({contact.geom[0], contact.geom[1]}, contact.dist) < max;
                       }) ||
           std::any_of(measured_here.begin(), measured_here.end(), [&](GeomIds ids) {
             const std::optional<GeomGap> gap = detail::gap_measured_here(m, d.get(), ids, 0);
             return gap && gap_of(ids, gap->distance) < max;
           });
  }

  GeomPair name_pair(GeomIds ids) const {
    return {detail::geom_name(m, ids.geom1), detail::geom_name(m, ids.geom2),
            detail::body_name(m, m.geom_bodyid[ids.geom1]),
            detail::body_name(m, m.geom_bodyid[ids.geom2])};
  }

  /// The deepest contact of each pair that overlaps, deepest first.
  std::vector<ContactPoint> overlapping() {
    std::map<GeomIds, GeomGap> deepest;  // ordered, so that equal depths come in a fixed order
    for (const mjContact& contact : detect(m)) {
      if (contact.dist >= 0 || !counts(contact)) continue;
      const GeomIds ids{contact.geom[0], contact.geom[1]};
      if (gap_of(ids, contact.dist) == 0) continue;
      const GeomGap gap{contact.dist, vector(contact.pos), vector(contact.frame)};
      const auto [entry, fresh] = deepest.try_emplace(ids, gap);
      if (!fresh && gap.distance < entry->second.distance) entry->second = gap;
    }
    for (const GeomIds ids : measured_here) {
      const std::optional<GeomGap> gap = detail::gap_measured_here(m, d.get(), ids, 0);
      if (gap && gap_of(ids, gap->distance) < 0) deepest.emplace(ids, *gap);
    }
    std::vector<ContactPoint> out;
    for (const auto& [ids, gap] : deepest) {
      out.push_back({name_pair(ids), -gap.distance, gap.point_W, gap.normal_W});
    }
    std::stable_sort(out.begin(), out.end(), [](const ContactPoint& a, const ContactPoint& b) {
      return a.depth > b.depth;
    });
    return out;
  }

  /// Candidates come from the collision detection with a wide margin, so that its rules decide
  /// which pairs count; their distance is measured exactly.
  std::set<GeomIds> candidates() {
    std::set<GeomIds> out;
    for (const mjContact& contact : detect(m_wide)) {
      if (counts(contact)) out.insert({contact.geom[0], contact.geom[1]});
    }
    return out;
  }

  /// Up to the margin.
  double distance(GeomIds ids) { return detail::geom_distance(m, d.get(), ids, options.margin); }

  /// Pairs that are equally far apart in every posture, found by drawing some.
  void find_constant_pairs() {
    constexpr int kPostures = 8;
    constexpr double kSame = 1e-6;  // [m] more than the distance is uncertain by
    constant_pairs.emplace();
    std::map<GeomIds, double> same;
    Rng rng(1);
    for (int k = 0; k < kPostures && (k == 0 || !same.empty()); ++k) {
      std::vector<double> q(bodies.addresses.size());
      for (double& value : q) value = rng.uniform(-1.5, 1.5);
      place(q);
      if (k == 0) {
        std::set<GeomIds> pairs = candidates();
        pairs.insert(measured_here.begin(), measured_here.end());
        for (const GeomIds ids : pairs) same.emplace(ids, distance(ids));
        std::erase_if(same, [&](const auto& entry) { return !(entry.second < options.margin); });
      } else {
        std::erase_if(same, [&](const auto& entry) {
          return std::abs(distance(entry.first) - entry.second) > kSame;
        });
      }
    }
    for (const auto& [ids, apart] : same) constant_pairs->insert(ids);
  }

  /// True for two geoms that ExactOptions::skip_neighbours leaves out.
  bool are_neighbours(GeomIds ids, double distance) {
    constexpr int kJoints = 3;
    constexpr double kFar = detail::ClearanceMemory::kNeighboursFrom;
    if (!options.skip_neighbours) return false;
    const auto piece = [&](int geom) {
      return bodies.pieces[static_cast<std::size_t>(m.geom_bodyid[geom])];
    };
    const int a = piece(ids.geom1), b = piece(ids.geom2);
    if (a > 0 && b > 0 && std::abs(a - b) <= kJoints && distance >= kFar) return true;
    return never_meets(ids);
  }

  void prove_meetings() {
    if (never_meet) return;
    never_meet.emplace(model, arm, options.rules, q_rest);
    memory.set_levers(never_meet->longest_levers());
  }

  bool never_meets(GeomIds ids) {
    prove_meetings();
    return (*never_meet)(ids);
  }

  /// All pairs within range().
  std::vector<std::pair<GeomIds, NearestPair>> near_pairs() {
    std::vector<std::pair<GeomIds, NearestPair>> out;
    for (const GeomIds ids : candidates()) {
      std::array<mjtNum, 6> segment{};
      const double distance =
          gap_of(ids, mj_geomDistance(&m, d.get(), ids.geom1, ids.geom2, range(), segment.data()));
      if (distance >= range()) continue;
      out.push_back({ids, {{}, distance, vector(segment.data()), vector(segment.data() + 3)}});
    }
    for (const GeomIds ids : measured_here) {
      const std::optional<GeomGap> gap = detail::gap_measured_here(m, d.get(), ids, range());
      if (!gap || gap->distance >= range()) continue;
      const Eigen::Vector3d half = 0.5 * gap->distance * gap->normal_W;
      out.push_back(
          {ids, {{}, gap_of(ids, gap->distance), gap->point_W - half, gap->point_W + half}});
    }
    return out;
  }

  /// That of the pairs which is told; remembers what they prove of other configurations.
  std::optional<NearestPair> nearest(std::span<const double> q,
                                     std::vector<std::pair<GeomIds, NearestPair>> pairs) {
    if (!constant_pairs) find_constant_pairs();
    prove_meetings();
    std::ranges::stable_sort(pairs, {}, [](const auto& entry) { return entry.second.distance; });
    detail::ClearanceMemory::Seen seen{range(), range(), range()};
    std::optional<NearestPair> out;
    for (auto& [ids, pair] : pairs) {
      const bool constant = constant_pairs->contains(ids);
      const bool neighbours = !constant && are_neighbours(ids, pair.distance);
      if (!constant && !neighbours) {
        seen.told = std::min(seen.told, pair.distance);
        if (!out && pair.distance < options.margin) {
          out = pair;
          out->pair = name_pair(ids);
        }
      }
      const bool nearer = pair.distance < (neighbours ? seen.neighbours : seen.all);
      if (!nearer || never_meets(ids)) continue;
      seen.all = std::min(seen.all, pair.distance);
      if (neighbours) seen.neighbours = pair.distance;
    }
    memory.remember(q, seen);
    return out;
  }

  CollisionReport check(std::span<const double> q) {
    constexpr double kApart = 1e-3;  // [m] clearly
    place(q);
    CollisionReport report;
    const bool measures = options.margin > 0;
    auto pairs = measures ? near_pairs() : std::vector<std::pair<GeomIds, NearestPair>>();
    // Where all that is near is clearly apart nothing overlaps.
    if (!measures || std::ranges::any_of(
                         pairs, [](const auto& entry) { return entry.second.distance < kApart; })) {
      report.contacts = overlapping();
    }
    report.free = report.contacts.empty() || report.contacts.front().depth <= options.allow_depth;
    if (measures) report.nearest = nearest(q, std::move(pairs));
    return report;
  }

  Model model;  // keeps the arrays alive
  Arm arm;
  ExactOptions options;
  mjModel m;           // head of the model for contacts
  mjModel m_wide;      // the same with `margin` round every geom
  Result<void> sound;  // the rules
  detail::ArmBodies bodies;
  detail::ContactFilter filter;
  std::vector<double> q_rest;
  std::vector<GeomIds> measured_here;
  std::optional<std::set<GeomIds>> constant_pairs;  // once they were looked for
  std::optional<detail::NeverMeet> never_meet;      // once it was asked for; each copy its own
  detail::ClearanceMemory memory;
  detail::MjDataPtr d;
};

Result<ExactChecker> ExactChecker::create(const Model& model, const Arm& arm,
                                          const ExactOptions& options) {
  const auto fits = [](double length) { return length >= 0 && std::isfinite(length); };
  if (!fits(options.margin) || !fits(options.allow_depth) || !fits(options.rest_depth)) {
    return fail(Errc::bad_input, text(msg::collision_exact_options));
  }
  ExactChecker out(model, arm, options);
  if (!out.impl_->sound) return fail(out.impl_->sound.error());
  if (!out.impl_->bodies.matches) {
    return fail(Errc::bad_input, text(msg::collision_other_arm, arm.name));
  }
  if (!out.impl_->fits()) {
    return fail(Errc::bad_input, text(msg::collision_cover_qpos, out.impl_->m.nq));
  }
  return out;
}

ExactChecker::ExactChecker(const Model& model, const Arm& arm, const ExactOptions& options)
    : impl_(std::make_unique<Impl>(model, arm, options)) {}
ExactChecker::~ExactChecker() = default;
ExactChecker::ExactChecker(const ExactChecker& other)
    : impl_(std::make_unique<Impl>(*other.impl_)) {}
ExactChecker& ExactChecker::operator=(const ExactChecker& other) {
  if (this != &other) impl_ = std::make_unique<Impl>(*other.impl_);
  return *this;
}
ExactChecker::ExactChecker(ExactChecker&&) noexcept = default;
ExactChecker& ExactChecker::operator=(ExactChecker&&) noexcept = default;

Result<CollisionReport> ExactChecker::check(std::span<const double> q) {
  if (!impl_->sound) return fail(impl_->sound.error());
  if (!impl_->fits()) {
    return fail(Errc::bad_input, text(msg::collision_cover_qpos, impl_->m.nq));
  }
  if (!impl_->accepts(q)) {
    return fail(Errc::bad_input,
                text(msg::collision_bad_q, impl_->bodies.addresses.size(), q.size()));
  }
  return impl_->check(q);
}

bool ExactChecker::is_free(std::span<const double> q) {
  return impl_->accepts(q) && impl_->is_free(q);
}

double ExactChecker::least_distance(std::span<const double> q) const {
  if (!impl_->accepts(q)) return -kInfinity;
  return impl_->memory.least_told(impl_->moved(q), impl_->options.margin);
}

std::function<bool(std::span<const double>)> ExactChecker::predicate() const {
  auto own = std::make_shared<ExactChecker>(*this);
  return [own](std::span<const double> q) { return own->is_free(q); };
}

}  // namespace mjarm

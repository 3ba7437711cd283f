#include "mjarm/planning/verify_path.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

#include "mjarm/collision/verify_edge.hpp"
#include "mjarm/core/messages/planning.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/planning/plan_path.hpp"
#include "mjarm/planning/tilt_limit.hpp"
#include "mjarm/planning/verify_region_internal.hpp"
#include "mjarm/planning/verify_scene_internal.hpp"

namespace mjarm {
namespace {

constexpr double kEndSlack = 1e-4;        // [rad or m] of start, goal and limits
constexpr double kAnywhere = 1e9;         // slack with which limits and overlaps do not matter
constexpr double kCostSlack = 1e-6;       // relative
constexpr double kTiltSlack = 1e-6;       // [rad]
constexpr double kClearanceAbove = 1e-5;  // [m] by which a stated clearance may be too large
constexpr double kKeptSlack = 1e-6;       // [m] and what is said to be kept
constexpr double kClearanceBelow = 1e-3;  // [m] and too small: it is a lower bound

using Row = std::span<const double>;

/// The largest difference of a joint.
double farthest(Row a, Row b) {
  double max = 0;
  for (std::size_t i = 0; i < a.size(); ++i) max = std::max(max, std::abs(a[i] - b[i]));
  return max;
}

double length_of(Row a, Row b) {
  double squares = 0;
  for (std::size_t i = 0; i < a.size(); ++i) squares += (b[i] - a[i]) * (b[i] - a[i]);
  return std::sqrt(squares);
}

class PathJudge {
 public:
  /// @param ends  null: the path ends where it ends.
  PathJudge(detail::VerifyScene& scene, const PlanProblem* ends, const GivenPath& path,
            const VerifyRules& rules)
      : scene_(scene), arm_(scene.arm()), ends_(ends), path_(path), rules_(rules) {}

  Result<PathVerdict> run() {
    if (!(rules_.step >= kLeastVerifyStep)) {
      return fail(Errc::bad_input, text(msg::planning_verify_step, rules_.step, kLeastVerifyStep));
    }
    check_ends();
    find_walkable();
    if (Result<void> done = prove_edges(); !done) return fail(std::move(done.error()));
    if (Result<void> done = walk_edges(); !done) return fail(std::move(done.error()));
    check_tilt();
    check_region();
    if (is_stopped(rules_.stop)) return fail(stopped());
    check_cost();
    if (Result<void> done = check_certificates(); !done) return fail(std::move(done.error()));
    if (Result<void> done = check_clearance(); !done) return fail(std::move(done.error()));
    return std::move(out_);
  }

 private:
  /// A path of one row is an edge of no length.
  int edges() const { return std::max(static_cast<int>(path_.rows.size()) - 1, 1); }
  Row row(int i) const {
    return path_.rows[std::min(static_cast<std::size_t>(i), path_.rows.size() - 1)];
  }

  std::vector<double> on_edge(int edge, double t) const {
    std::vector<double> q(row(edge).begin(), row(edge).end());
    for (std::size_t i = 0; i < q.size(); ++i) q[i] += t * (row(edge + 1)[i] - q[i]);
    return q;
  }

  void add(const char* kind, int edge, std::string what) {
    out_.faults.push_back({kind, edge, std::move(what)});
  }

  void check_ends() {
    if (ends_ == nullptr) return;
    const double off = farthest(path_.rows.front(), ends_->start);
    if (off > kEndSlack) add("start", -1, text(msg::planning_verify_start, off));
    double nearest = std::numeric_limits<double>::infinity();
    for (const JointVec& goal : ends_->goals) {
      nearest = std::min(nearest, farthest(path_.rows.back(), as_span(goal)));
    }
    if (nearest > kEndSlack) add("goal", -1, text(msg::planning_verify_goal, nearest));
  }

  void add_edge_fault(int edge, const VerifyResult& found) {
    if (found.verdict == EdgeVerdict::outside) {
      const auto joint = static_cast<std::size_t>(found.joint);
      const int at = edge + static_cast<int>(found.t);
      add("limits", edge,
          text(msg::planning_verify_limits, at, arm_.joints[joint].name, row(at)[joint],
               arm_.limits.lower[found.joint], arm_.limits.upper[found.joint]));
      return;
    }
    const auto [link, other] = scene_.names(found);
    if (found.verdict == EdgeVerdict::hit) {
      add("hit", edge, text(msg::planning_verify_hit, edge, found.t, link, other, -found.distance));
    } else {
      add("undecided", edge,
          text(msg::planning_verify_undecided, edge, found.t, link, other, found.distance));
    }
  }

  double pieces_of(int edge) const {
    return std::ceil(length_of(row(edge), row(edge + 1)) / rules_.step);
  }

  /// Whether an edge is looked at between its ends.
  bool is_walkable(int edge) const { return walkable_[static_cast<std::size_t>(edge)] != 0; }

  bool is_inside(Row q) const {
    for (int i = 0; i < arm_.dof(); ++i) {
      const double value = q[static_cast<std::size_t>(i)];
      if (!(value >= arm_.limits.lower[i] - kEndSlack && value <= arm_.limits.upper[i] + kEndSlack))
        return false;
    }
    return true;
  }

  /// Leaves out what is outside of the limits, where nothing between tells more, and what is too
  /// long to be sampled, which is a fault.
  void find_walkable() {
    double samples = 0;
    for (int edge = 0; edge < edges(); ++edge) {
      const bool inside = is_inside(row(edge)) && is_inside(row(edge + 1));
      if (inside) samples += pieces_of(edge);
      const bool too_long = inside && !(samples <= kMaxVerifySamples);
      walkable_.push_back(inside && !too_long ? 1 : 0);
      if (!too_long) continue;
      if (!told_length_) {
        add("length", edge,
            text(msg::planning_verify_length, edge, kMaxVerifySamples, rules_.step));
      }
      told_length_ = true;
    }
  }

  /// How deep the overlaps of an edge are, at samples: verify_edge() ends at the first.
  Result<void> measure(int edge) {
    if (!is_walkable(edge)) return {};
    const double pieces = pieces_of(edge);
    for (double k = 0; k <= pieces; ++k) {
      if (is_stopped(rules_.stop)) return fail(stopped());
      const std::vector<double> q = on_edge(edge, k / std::max(pieces, 1.0));
      const Result<VerifyResult> found =
          scene_.edge(q, q, {.allow_depth = kAnywhere, .limit_slack = kAnywhere});
      if (!found) return fail(found.error());
      out_.clearance = std::min(out_.clearance, found->distance);
    }
    return {};
  }

  Result<void> prove_edges() {
    const VerifyOptions options{
        .allow_depth = rules_.allow_depth, .limit_slack = kEndSlack, .stop = rules_.stop};
    bool is_faulty = false;
    for (int edge = 0; edge < edges(); ++edge) {
      if (told_length_ && !is_walkable(edge) && is_inside(row(edge)) && is_inside(row(edge + 1))) {
        continue;
      }
      const Result<VerifyResult> found = scene_.edge(row(edge), row(edge + 1), options);
      if (!found) return fail(found.error());
      if (found->verdict != EdgeVerdict::outside) {
        out_.clearance = std::min(out_.clearance, found->distance);
      }
      if (found->verdict == EdgeVerdict::hit) {
        if (Result<void> done = measure(edge); !done) return done;
      }
      if (found->verdict == EdgeVerdict::free || is_faulty) continue;
      is_faulty = true;
      add_edge_fault(edge, *found);
    }
    return {};
  }

  Result<void> walk_edges() {
    for (int edge = 0; edge < edges(); ++edge) {
      if (!is_walkable(edge)) continue;
      const auto found = scene_.contact(row(edge), row(edge + 1), rules_);
      if (!found) return fail(found.error());
      if (!found->has_value()) continue;
      const ContactPoint& contact = (*found)->contact;
      add("contact", edge,
          text(msg::planning_verify_contact, edge, (*found)->t, contact.pair.geom1,
               contact.pair.geom2, contact.depth));
      return {};
    }
    return {};
  }

  /// At samples: the tool leans by no more than is stated.
  void check_tilt() {
    if (!path_.tilt) return;
    const TiltLimit stated{path_.tilt->largest,
                           Eigen::Map<const Eigen::Vector3d>(path_.tilt->tool.data()),
                           Eigen::Map<const Eigen::Vector3d>(path_.tilt->world.data())};
    for (int edge = 0; edge < edges(); ++edge) {
      if (!is_walkable(edge)) continue;
      const double pieces = pieces_of(edge);
      for (double k = 0; k <= pieces && !is_stopped(rules_.stop); ++k) {
        const double t = k / std::max(pieces, 1.0), leans = tilt(stated, arm_, on_edge(edge, t));
        if (leans <= stated.max + kTiltSlack) continue;
        add("tilt", edge, text(msg::planning_verify_tilt, edge, t, leans, stated.max));
        return;
      }
    }
  }

  /// At samples: the tool has the room that is stated, and a mechanism need not jump.
  void check_region() {
    if (!path_.within) return;
    const RegionRoom& stated = path_.within->room;
    if (!stated.within(detail::kRoomSlack)) {
      add("region", -1, text(msg::planning_verify_no_room, stated.place, stated.turn));
      return;
    }
    detail::RegionWatch watch(*path_.within);
    for (int edge = 0; edge < edges(); ++edge) {
      if (!is_walkable(edge)) continue;
      const double pieces = pieces_of(edge);
      const auto tool = [&](double t) { return fk(arm_, on_edge(edge, t)); };
      double before = 0;
      for (double k = 0; k <= pieces && !is_stopped(rules_.stop); ++k) {
        const double t = k / std::max(pieces, 1.0);
        const detail::RegionWatch::Found found = watch.look(tool, before, t);
        before = t;
        if (found.kept && !found.jumped) continue;
        const RegionRoom& room = found.room;
        add("region", edge,
            found.kept ? text(msg::planning_verify_jump, edge, t)
                       : text(msg::planning_verify_room, edge, t, room.place, room.turn,
                              stated.place, stated.turn));
        return;
      }
    }
  }

  void check_cost() {
    for (int edge = 0; edge < edges(); ++edge) out_.cost += length_of(row(edge), row(edge + 1));
    if (!path_.cost) return;
    const double off = std::abs(*path_.cost - out_.cost);
    if (!(off <= kCostSlack * (1 + out_.cost))) {
      add("cost", -1, text(msg::planning_verify_cost, *path_.cost, out_.cost));
    }
  }

  /// What is wrong with a certificate; empty where nothing is.
  Result<std::string> fault_of(const GivenCertificate& given, int edge) const {
    const double length = length_of(row(edge), row(edge + 1));
    if (!(given.step >= 0 && given.step <= length * (1 + kCostSlack))) {
      return text(msg::planning_verify_certificate_step, given.step, length);
    }
    if (!(given.t >= 0 && given.t <= 1)) return text(msg::planning_verify_certificate_t, given.t);
    if (given.pair.empty()) return std::string();
    const Result<std::optional<double>> found =
        scene_.distance(given.pair[0], given.pair[1], on_edge(edge, given.t));
    if (!found) return fail(found.error());
    if (!*found) return text(msg::planning_verify_certificate_pair, given.pair[0], given.pair[1]);
    const double off = given.clearance - **found;
    if (off <= kClearanceAbove && off >= -kClearanceBelow) return std::string();
    return text(msg::planning_verify_certificate_clearance, given.clearance, given.t, **found);
  }

  Result<void> check_certificates() {
    if (!path_.certificate) return {};
    const std::size_t given = path_.certificate->size(), wanted = path_.rows.size() - 1;
    if (given != wanted) {
      add("certificate", -1, text(msg::planning_verify_certificate_count, given, wanted));
      return {};
    }
    for (std::size_t i = 0; i < given; ++i) {
      const int edge = static_cast<int>(i);
      const Result<std::string> fault = fault_of((*path_.certificate)[i], edge);
      if (!fault) return fail(fault.error());
      if (fault->empty()) continue;
      add("certificate", edge, text(msg::planning_verify_certificate, edge, *fault));
      return {};
    }
    return {};
  }

  /// That every edge keeps what is stated, and that this is the clearance but near the ends. Of the
  /// edges the first that is faulty counts.
  Result<void> check_clearance() {
    if (!path_.clearance || told_length_ || !path_.certificate) return {};
    const auto given = static_cast<int>(path_.certificate->size());
    for (int edge = 0; edge < std::min(given, edges()); ++edge) {
      const Result<std::string> fault = clearance_fault(edge);
      if (!fault) return fail(fault.error());
      if (fault->empty()) continue;
      add("clearance", edge, *fault);
      return {};
    }
    return {};
  }

  Result<std::string> clearance_fault(int edge) const {
    const auto kept = (*path_.certificate)[static_cast<std::size_t>(edge)].kept;
    if (!kept) return text(msg::planning_verify_no_kept, edge);
    if (*kept < *path_.clearance) {
      const Result<bool> fine = may_be_nearer(edge, *kept);
      if (!fine) return fail(fine.error());
      if (!*fine) {
        return text(msg::planning_verify_kept_less, edge, *kept, *path_.clearance, kFarthestExit);
      }
    }
    const VerifyOptions options{.keep = std::max(*kept - kKeptSlack, 0.0), .stop = rules_.stop};
    const Result<VerifyResult> found = scene_.edge(row(edge), row(edge + 1), options);
    if (!found) return fail(found.error());
    if (found->verdict == EdgeVerdict::free) return std::string();
    return text(msg::planning_verify_kept, edge, *kept, found->t);
  }

  /// Whether an edge is a short one at an end of the path that has no more clearance itself.
  Result<bool> may_be_nearer(int edge, double kept) const {
    if (length_of(row(edge), row(edge + 1)) > kFarthestExit + kEndSlack) return false;
    for (const auto& [here, end] : {std::pair{edge == 0, 0}, {edge + 1 == edges(), edges()}}) {
      if (!here) continue;
      const Result<VerifyResult> own = scene_.edge(row(end), row(end), {});
      if (!own) return fail(own.error());
      if (kept > own->distance - kClearanceBelow) return true;
    }
    return false;
  }

  detail::VerifyScene& scene_;
  const Arm& arm_;
  const PlanProblem* ends_;
  const GivenPath& path_;
  const VerifyRules& rules_;
  std::vector<char> walkable_;  // edges
  bool told_length_ = false;
  PathVerdict out_;
};

}  // namespace

Result<PathVerdict> verify_path(const ProblemFile& file, const PlanProblem& problem,
                                const GivenPath& path, const VerifyRules& rules) {
  detail::SphereVerifyScene scene(file, problem);
  return PathJudge(scene, &problem, path, rules).run();
}

Result<PathVerdict> verify_path(const Robot& robot, const ContactRules& contact,
                                const GivenPath& path, const VerifyRules& rules) {
  Result<ModelMarch> march = ModelMarch::create(robot.model, robot.arm, contact, rules.stop);
  if (!march) return fail(std::move(march.error()));
  const ExactOptions exact{.margin = 0, .allow_depth = rules.allow_depth, .rules = contact};
  detail::ModelVerifyScene scene(std::move(*march), ExactChecker(robot.model, robot.arm, exact),
                                 robot.arm);
  return PathJudge(scene, nullptr, path, rules).run();
}

}  // namespace mjarm

#include <algorithm>
#include <optional>
#include <utility>

#include "mjarm/kinematics/fk.hpp"
#include "mjarm/program/lifted_detour_internal.hpp"

namespace mjarm::program::detail {
namespace {

constexpr double kLift = 0.03;        // [m] more than spheres stick out, twice over
constexpr std::size_t kMaxAbove = 4;  // that are looked at from above, the first ones

/// Where the arm is with the tool moved off, near `q`; none where it cannot stand there.
std::optional<JointVec> lifted(const Tool& with, const JointVec& q, bool up) {
  Pose X = fk(with.arm, as_span(q));
  const Eigen::Vector3d way = up ? Eigen::Vector3d(0, 0, 1) : Eigen::Vector3d(-X.R.col(2));
  X.p += kLift * way;
  const auto answer = with.ik.solve(X, as_span(q));
  constexpr double kNear = 0.5;  // [rad or m] another branch is no way up
  if (!answer || (answer->q - q).cwiseAbs().maxCoeff() > kNear) return std::nullopt;
  return answer->q;
}

class LiftedPlanner {
 public:
  LiftedPlanner(Tool& with, const JointVec& q, std::span<const JointVec> goals,
                const DetourWish& wish, const MoveTo& move_to)
      : with_(with), q_(q), goals_(goals), wish_(wish), move_to_(move_to) {}

  Result<LiftedDetour, DetourFault> plan() {
    if (!with_.gripped) return attempt({}, true);
    // First what is needed where coarse spheres stand for the links: finer ones take their time.
    const Ends likely{is_near(q_), std::ranges::all_of(goals_, [this](const JointVec& goal) {
                        return is_near(goal);
                      })};
    std::vector<Ends> order{likely};
    for (const Ends& other : {Ends{}, Ends{true, false}, Ends{false, true}, Ends{true, true}}) {
      if (other != likely) order.push_back(other);
    }
    std::optional<DetourFault> first;
    for (const Ends& ends : order) {
      for (const bool up : {true, false}) {
        auto found = attempt(ends, up);
        if (found || found.error().reason != "collision") return found;
        if (!first || first->what.empty()) first = found.error();
        if (ends == Ends{}) break;  // there is no up in it
      }
    }
    return tl::unexpected(std::move(*first));
  }

 private:
  /// Which ends of the way are moved off.
  struct Ends {
    bool lift = false, lower = false;
    bool operator==(const Ends&) const = default;
  };

  /// So near to something that spheres may hit it.
  bool is_near(const JointVec& q) const {
    constexpr double kSpheres = 0.012;  // [m] that the first ones stick out
    const ClearanceCheck& clearance = with_.judge.clearance();
    return clearance && clearance(as_span(q)).distance < kSpheres + with_.detours.margin();
  }

  Result<LiftedDetour, DetourFault> attempt(const Ends& ends, bool up) {
    const auto [lift, lower] = ends;
    const DetourFault none{"collision", {}};
    LiftedDetour out;
    JointVec from = q_;
    if (lift) {
      const auto above = lifted(with_, q_, up);
      if (!above || !move_to_(q_, *above, "lift", out.before)) return tl::unexpected(none);
      from = *above;
    }
    std::vector<JointVec> to(goals_.begin(), goals_.end());
    std::vector<std::size_t> index;
    if (lower) to = above_goals(up, index);
    if (to.empty()) return tl::unexpected(none);
    Result<DetourMotion, DetourFault> motion =
        with_.detours.plan(from, to, wish_.share, wish_.clearance);
    if (!motion) return tl::unexpected(std::move(motion.error()));
    out.goal = lower ? index[motion->goal()] : motion->goal();
    if (lower) {
      const JointVec& last = motion->corners.back();
      if (!move_to_(last, goals_[out.goal], "lower", out.after)) return tl::unexpected(none);
    }
    out.motion = std::move(*motion);
    return out;
  }

  /// @param index  gets of each the goal that it is above.
  std::vector<JointVec> above_goals(bool up, std::vector<std::size_t>& index) const {
    std::vector<JointVec> out;
    for (std::size_t g = 0; g < goals_.size() && out.size() < kMaxAbove; ++g) {
      if (const auto above = lifted(with_, goals_[g], up)) {
        out.push_back(*above);
        index.push_back(g);
      }
    }
    return out;
  }

  Tool& with_;
  const JointVec& q_;
  std::span<const JointVec> goals_;
  const DetourWish& wish_;
  const MoveTo& move_to_;
};

}  // namespace

Result<LiftedDetour, DetourFault> plan_lifted(Tool& with, const JointVec& q,
                                              std::span<const JointVec> goals,
                                              const DetourWish& wish, const MoveTo& move_to) {
  return LiftedPlanner(with, q, goals, wish, move_to).plan();
}

}  // namespace mjarm::program::detail

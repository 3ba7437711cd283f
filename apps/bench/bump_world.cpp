#include "apps/bench/bump_world.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <numbers>
#include <string>
#include <utility>

#include "apps/bench/robust_lap.hpp"
#include "mjarm/collision/exact.hpp"
#include "mjarm/control/contact_observer.hpp"
#include "mjarm/control/contact_place.hpp"
#include "mjarm/control/step_inverse.hpp"
#include "mjarm/core/linear_algebra.hpp"
#include "mjarm/execution/motion_clock.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/model/moved_bodies.hpp"
#include "mjarm/model/scene_bodies.hpp"
#include "mjarm/model/surface.hpp"

namespace mjarm::app {
namespace {

constexpr double kReach = 1.2;   // [rad] that joints go from home at most
constexpr double kMargin = 0.1;  // [rad] to the ends of their ranges
constexpr int kLooks = 40;       // configurations of a move that are checked
constexpr int kGoalDraws = 1000;
constexpr double kLearned = 2;     // [s] after which alarms count
constexpr double kTurning = 0.05;  // [rad/s]
constexpr double kTurningTime = 0.06, kBefore = 0.06, kAfter = 0.14;  // [s]
constexpr double kEncoderSteps = 3;
constexpr double kHeld = 0.06, kFall = 0.05;  // [s] of the push
constexpr double kNamed = 0.014;              // [s] after the notice, in which the link is judged

/// A random motion that touches nothing, from rest to rest.
Result<PlannedMove> draw_move(const Arm& arm, ExactChecker& checker, const JointVec& q, Rng& rng) {
  for (int draw = 0; draw < kGoalDraws; ++draw) {
    JointVec goal(arm.dof());
    for (int i = 0; i < arm.dof(); ++i) {
      goal[i] = std::clamp(arm.home[i] + rng.uniform(-kReach, kReach),
                           arm.limits.lower[i] + kMargin, arm.limits.upper[i] - kMargin);
    }
    bool free = true;
    for (int k = 1; k <= kLooks && free; ++k) {
      const JointVec here = q + (goal - q) * (static_cast<double>(k) / kLooks);
      free = checker.is_free(as_span(here));
    }
    if (!free) continue;
    JointLimits limits = arm.limits;
    const double share = rng.uniform(0.15, 0.8);
    limits.velocity *= share;
    limits.acceleration *= share;
    limits.jerk = (share * limits.jerk).cwiseMin(500 * share);
    Result<Trajectory> way = time_joint_move(as_span(q), as_span(goal), limits);
    if (!way) return fail(std::move(way.error()));
    return PlannedMove{.word = "movej", .trajectory = std::move(*way)};
  }
  return fail(Errc::impossible, "no free motion was drawn");
}

/// What pushes the arm.
struct Bump {
  int body = -1, link = -1;
  Eigen::Vector3d p_B, way_B;       ///< where, and in which direction, in the body's frame
  double force = 0, rise = 0;       ///< [N], [s]
  std::optional<double> from = {};  ///< [s] of the simulation

  [[nodiscard]] double force_at(double time) const {
    const double t = from ? time - *from : -1;
    if (t <= 0) return 0;
    const double fading = std::clamp(1 - (t - kHeld) / kFall, 0.0, 1.0);
    return force * std::min(1.0, t / rise) * fading;
  }
};

Bump draw_bump(const Model& model, std::span<const MovedBody> bodies, Rng& rng) {
  Bump out;
  for (;;) {
    const MovedBody& body = bodies[rng.below(bodies.size())];
    const auto skin = body_surface(model, body.body);
    if (!skin) continue;  // a load without a shape
    const SurfacePoint point = SurfacePoints(*skin).draw(rng.uniform(), rng);
    const Eigen::Vector3d aside(rng.normal(), rng.normal(), rng.normal());
    out.p_B = point.p;
    out.way_B = (0.5 * aside.normalized() - point.outward).normalized();
    out.body = body.body;
    out.link = body.joint;
    out.force = rng.uniform(25, 80);
    out.rise = rng.uniform(0.004, 0.02);
    return out;
  }
}

/// A run under way.
class BumpDrive {
 public:
  BumpDrive(const Robot& known, const Model& world, Controller controller, ContactObserver observer,
            ExactChecker checker, const Rng& rng)
      : arm_(known.arm),
        h_(known.model.timestep()),
        controller_(std::move(controller)),
        observer_(std::move(observer)),
        places_(known.model, known.arm),
        checker_(std::move(checker)),
        inverse_(known.model, known.arm),
        rng_(rng),
        drives_(arm_, {.late_steps = kRobustLate}, h_, Rng(rng_.next())),
        sim_(world),
        q_(arm_.home),
        qpos_(static_cast<std::size_t>(known.model.nq()), 0.0),
        bodies_(moved_bodies(world, arm_)) {
    sim_.place(arm_, as_span(q_));
    ctrl_.assign(sim_.ctrl().begin(), sim_.ctrl().end());
  }

  Result<BumpRun> drive(bool push, double seconds) {
    if (auto warm = warm_up(); !warm) return fail(std::move(warm.error()));
    if (push) bump_ = draw_bump(sim_.model(), bodies_, rng_);
    const double starts = push ? rng_.uniform(3, 8) : seconds;
    while (sim_.time() < starts + (push ? kBefore + kAfter + kHeld : 0)) {
      if (push && !bump_->from && sim_.time() >= starts) bump_->from = sim_.time();
      if (auto moved = move_on(); !moved) return fail(std::move(moved.error()));
      // What follows a contact of the motion itself would be no false alarm, and an arm whose
      // drives give all they have is off its motion.
      if (!(push && bump_->from) && (cut_ || !sim_.contacts(arm_).empty())) break;
    }
    // The brakes may take longer than the push.
    while (noticed_ && clock_->state() == MotionClock::State::stopping) {
      if (auto moved = move_on(); !moved) return fail(std::move(moved.error()));
    }
    if (noticed_ && resting_) out_.at_rest = *resting_ - *noticed_;
    if (noticed_ && passed_) out_.delay = std::max(0.0, *noticed_ - *passed_);
    for (BumpMoment& moment : out_.moments) moment.time -= passed_.value_or(0);
    out_.seconds = sim_.time();
    return out_;
  }

 private:
  Result<void> warm_up() {
    const std::vector<JointVec> q = warm_up_at(q_, h_);
    for (std::size_t i = 0; i + 1 < q.size(); ++i) {
      if (auto done = step(reference_at(q, i)); !done) return done;
    }
    return {};
  }

  /// One step along the random moves.
  Result<void> move_on() {
    if (!clock_ || clock_->state() == MotionClock::State::done) {
      auto move = draw_move(arm_, checker_, q_, rng_);
      if (!move) return fail(std::move(move.error()));
      q_ = move->trajectory.at(move->trajectory.duration()).q;
      plan_ = {.arms = {arm_}, .q_start = move->trajectory.at(0).q, .moves = {*move}};
      clock_.emplace(plan_, h_, rng_.uniform(0, 0.2));
      clock_->run();
    }
    const StepReference reference = clock_->next().reference;
    if (auto done = step(reference); !done) return done;
    if (noticed_ && !braked_) {
      clock_->brake(arm_.limits);
      braked_ = true;
    }
    if (braked_ && !resting_ && clock_->state() != MotionClock::State::stopping) {
      resting_ = sim_.time();
    }
    return {};
  }

  Result<void> step(const StepReference& reference) {
    drives_.read(sim_.qpos(), sim_.qvel());
    cut_ = controller_.command(drives_.qpos(), drives_.qvel(), reference, ctrl_) || cut_;
    look(observer_.look(drives_.qpos(), drives_.qvel()));
    observer_.take(controller_.torque());
    drives_.pass(ctrl_);
    for (int k = 0; k < kRobustSubsteps; ++k) {
      if (bump_ && bump_->from) push();
      if (auto done = sim_.step(ctrl_); !done) return done;
    }
    turned_.push_back(sim_.arm_state(arm_).v);
    if (static_cast<double>(turned_.size()) * h_ > kTurningTime) turned_.pop_front();
    return {};
  }

  void look(const std::optional<NoticedContact>& noticed) {
    const double t = sim_.time();
    if (!bump_ || !bump_->from) {
      if (t < kLearned) return;
      out_.surprise = std::max(out_.surprise, observer_.surprise());
      if (noticed && !alarmed_) ++out_.alarms;
      alarmed_ = noticed.has_value();
    } else if (noticed) {
      if (!noticed_) noticed_ = t;
      if (t <= *noticed_ + kNamed && noticed->surprise > strongest_) {
        strongest_ = noticed->surprise;
        out_.named = places_.find(arm_positions(arm_, drives_.qpos()), *noticed).joint;
      }
    }
    if (!bump_ || t < kLearned) return;
    BumpMoment moment{.time = t, .force = bump_->force_at(t), .surprise = observer_.surprise()};
    const JointVec torque = observer_.torque(), v = sim_.arm_state(arm_).v;
    moment.torque.assign(torque.begin(), torque.end());
    moment.speed.assign(v.begin(), v.end());
    out_.moments.push_back(std::move(moment));
    const double first = bump_->from ? *bump_->from - kBefore : t - kBefore;
    while (out_.moments.front().time < first) out_.moments.erase(out_.moments.begin());
  }

  void push() {
    const double force = bump_->force_at(sim_.time());
    const Pose X_WB = sim_.body_pose(bump_->body);
    const Eigen::Vector3d f_W = force * (X_WB.R * bump_->way_B), p_W = X_WB * bump_->p_B;
    for (const MovedBody& body : bodies_) {
      if (body.body != bump_->body) continue;
      std::vector<Pose> X_WJ(static_cast<std::size_t>(arm_.dof()));
      const JointVec q = sim_.arm_state(arm_).q;
      fk_all(arm_, as_span(q), X_WJ);
      const Eigen::Vector3d center = X_WJ[static_cast<std::size_t>(body.joint)] * body.center_J;
      sim_.set_external_force(body.body, f_W, (p_W - center).cross(f_W));
      if (force < kBumpForce || passed_) return;
      passed_ = sim_.time();
      out_.pushed = true;
      out_.link = bump_->link;
      out_.told = can_be_told(q, X_WJ, p_W, kBumpForce / force * f_W);
    }
  }

  /// See drive_bump(), with the masses that the controller knows.
  bool can_be_told(const JointVec& q, std::span<const Pose> X_WJ, const Eigen::Vector3d& p_W,
                   const Eigen::Vector3d& f_W) {
    std::vector<int> moving;
    JointVec torque = JointVec::Zero(arm_.dof());
    for (int j = 0; j < arm_.dof(); ++j) {
      qpos_[static_cast<std::size_t>(arm_.joints[j].qpos)] = q[j];
      const Pose& X = X_WJ[static_cast<std::size_t>(j)];
      if (j <= bump_->link) torque[j] = (X.R * arm_.joints[j].axis).dot((p_W - X.p).cross(f_W));
      const bool turns = std::ranges::all_of(turned_, [&](const JointVec& v) {
        return std::abs(v[j]) > kTurning && v[j] * turned_.back()[j] > 0;
      });
      if (turns) moving.push_back(j);
    }
    if (moving.empty()) return false;
    const Eigen::MatrixXd mass = inverse_.mass_matrix(qpos_);
    const Eigen::MatrixXd a = solve_symmetric(mass(moving, moving), torque(moving));
    const double turn = 0.5 * a.cwiseAbs().maxCoeff() * kBumpTime * kBumpTime;
    return turn >= kEncoderSteps * DriveFaults{}.encoder_step;
  }

  Arm arm_;
  double h_;
  Controller controller_;
  ContactObserver observer_;
  ContactPlaces places_;
  ExactChecker checker_;
  StepInverse inverse_;
  Rng rng_;
  ImperfectDrives drives_;
  Sim sim_;
  JointVec q_;
  std::vector<double> qpos_;
  std::vector<MovedBody> bodies_;
  std::vector<double> ctrl_;
  MotionPlan plan_;
  std::optional<MotionClock> clock_;
  std::optional<Bump> bump_;
  std::deque<JointVec> turned_;
  std::optional<double> noticed_, passed_, resting_;
  bool braked_ = false, alarmed_ = false, cut_ = false;
  double strongest_ = 0;
  BumpRun out_;
};

}  // namespace

Result<BumpRun> drive_bump(const Robot& known, const Robot& bare, std::uint64_t seed,
                           std::uint64_t world, bool push, double seconds) {
  Rng rng(seed, world);
  const Result<Model> drawn = draw_wrong_world(bare, rng);
  if (!drawn) return fail(drawn.error());
  Result<Controller> controller = Controller::create(known.model, known.arm, ControlMode::robust,
                                                     {.robust = {.late_steps = kRobustLate}});
  if (!controller) return fail(std::move(controller.error()));
  Result<ContactObserver> observer =
      ContactObserver::create(known.model, known.arm, {.late_steps = kRobustLate});
  if (!observer) return fail(std::move(observer.error()));
  ExactChecker checker(bare.model, bare.arm);
  return BumpDrive(known, *drawn, std::move(*controller), std::move(*observer), std::move(checker),
                   rng)
      .drive(push, seconds);
}

}  // namespace mjarm::app

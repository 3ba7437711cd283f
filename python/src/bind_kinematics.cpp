// Forward and inverse kinematics.
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <limits>
#include <optional>

#include "mjarm/kinematics/fk.hpp"
#include "mjarm/kinematics/fk_batch.hpp"
#include "mjarm/kinematics/ik_all.hpp"
#include "mjarm/kinematics/ik_batch.hpp"
#include "mjarm/kinematics/singularity.hpp"
#include "mjarm/kinematics/track.hpp"
#include "python/src/bindings.hpp"
#include "python/src/convert.hpp"
#include "python/src/robot.hpp"

namespace mjarm::python {
namespace {

constexpr double kAnyStep = std::numeric_limits<double>::infinity();

/// What all calls of inverse kinematics take besides pose and seed.
struct IkWords {
  const std::optional<std::string>& task;
  double pos_tol, rot_tol, max_step;
  int restarts;
  nb::handle valid;
};

bool are_usual(const IkWords& words, const IkOptions& usual) {
  return !words.task && words.valid.is_none() && words.pos_tol == usual.pos_tol &&
         words.rot_tol == usual.rot_tol && words.max_step == usual.max_step &&
         words.restarts == usual.restarts;
}

IkTask task_of(const std::string& word) {
  const auto names = ik_task_names();
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i] == word) return static_cast<IkTask>(i);
  }
  refuse(msg::python_task, word);
}

/// What a caller's function threw while an answer was sought; solvers must not be thrown through.
using Thrown = std::optional<nb::python_error>;

void throw_again(Thrown& thrown) {
  if (thrown) throw nb::python_error(std::move(*thrown));
}

/// A solver with these options.
IkSolver solver_of(const BoundRobot& robot, const IkWords& words, Thrown& thrown) {
  IkOptions options = robot.ik.options();
  options.pos_tol = words.pos_tol;
  options.rot_tol = words.rot_tol;
  options.max_step = words.max_step;
  options.restarts = words.restarts;
  if (words.task) options.task = task_of(*words.task);
  if (!words.valid.is_none()) {
    options.valid = [call = words.valid, &thrown](std::span<const double> q) {
      if (thrown) return false;
      try {
        const int answer = PyObject_IsTrue(call(array(q, {q.size()})).ptr());
        if (answer < 0) throw nb::python_error();
        return answer == 1;
      } catch (nb::python_error& error) {
        thrown.emplace(std::move(error));
        return false;
      }
    };
  }
  return value_of(IkSolver::create(robot.arm(), std::move(options)));
}

[[noreturn]] void raise_unreachable(const IkFailure& failure, const Arm& arm) {
  if (failure.code == IkErrc::bad_input) raise_bad_input(describe(failure, arm));
  nb::object exception = error_class("Unreachable")(describe(failure, arm));
  exception.attr("reason") = nb::cast(failure.code);
  exception.attr("amount") = failure.amount;
  exception.attr("best") = nb::cast(failure.best);
  exception.attr("joint") = failure.joint < 0 ? nb::none() : nb::cast(failure.joint);
  raise(exception);
}

IkSolution ik(const BoundRobot& robot, nb::handle pose, nb::handle seed,
              const std::optional<std::string>& task, double pos_tol, double rot_tol,
              double max_step, int restarts, nb::handle valid) {
  const Pose X_WT = pose_of(pose, "pose");
  const JointVec q_seed = robot.joints_or_home(seed, "seed");
  const IkWords words{task, pos_tol, rot_tol, max_step, restarts, valid};
  Thrown thrown;
  const auto answer = are_usual(words, robot.ik.options())
                          ? robot.ik.solve(X_WT, as_span(q_seed))
                          : solver_of(robot, words, thrown).solve(X_WT, as_span(q_seed));
  throw_again(thrown);
  if (!answer) raise_unreachable(answer.error(), robot.arm());
  return *answer;
}

nb::object ik_all(const BoundRobot& robot, nb::handle pose, nb::handle seed, bool windings, int max,
                  const std::optional<std::string>& task, double pos_tol, double rot_tol,
                  double max_step, nb::handle valid) {
  const Pose X_WT = pose_of(pose, "pose");
  const JointVec q_seed = robot.joints_or_home(seed, "seed");
  Thrown thrown;
  const IkSolver solver = solver_of(
      robot, {task, pos_tol, rot_tol, max_step, robot.ik.options().restarts, valid}, thrown);
  const auto answers = solve_all(solver, X_WT, as_span(q_seed), {.windings = windings, .max = max});
  throw_again(thrown);
  if (!answers) raise_unreachable(answers.error(), robot.arm());
  std::vector<JointVec> rows;
  for (const IkSolution& one : *answers) rows.push_back(one.q);
  return array(rows, robot.dof());
}

/// Poses whose answers are held at a time: those of 100,000 are 40 MB, which take longer to be
/// fetched from the system than an eighth of the solving.
constexpr std::size_t kBlock = 8192;

nb::tuple ik_batch(const BoundRobot& robot, nb::handle poses, nb::handle seed, int threads) {
  const std::vector<Pose> X_WT = poses_of(poses, "poses");
  const auto dof = static_cast<std::size_t>(robot.dof());
  const bool one_each = !seed.is_none() && reals(seed, "seed").ndim() == 2;
  const JointVec same = one_each ? JointVec() : robot.joints_or_home(seed, "seed");
  const std::vector<double> seeds =
      one_each ? robot.rows(seed, "seed") : std::vector<double>(same.begin(), same.end());
  if (one_each && seeds.size() != X_WT.size() * dof) {
    refuse(msg::python_seed_rows, X_WT.size());
  }
  if (threads < 0) refuse(msg::python_not_negative, "threads");
  const NewArray<double> q({X_WT.size(), dof});
  const NewArray<bool> ok({X_WT.size()});
  {
    const nb::gil_scoped_release free;
    for (std::size_t from = 0; from < X_WT.size(); from += kBlock) {
      const std::size_t count = std::min(kBlock, X_WT.size() - from);
      const std::span<const double> begin(seeds);
      const auto answers = solve_batch(robot.ik, std::span(X_WT).subspan(from, count),
                                       one_each ? begin.subspan(from * dof, count * dof) : begin,
                                       {.threads = threads});
      for (std::size_t i = 0; i < count; ++i) {
        ok.data[from + i] = answers[i].has_value();
        double* const row = q.data + (from + i) * dof;
        if (answers[i]) {
          std::copy(answers[i]->q.begin(), answers[i]->q.end(), row);
        } else {
          std::fill_n(row, dof, std::numeric_limits<double>::quiet_NaN());
        }
      }
    }
  }
  return nb::make_tuple(q.object, ok.object);
}

nb::object fk_many(const BoundRobot& robot, nb::handle q) {
  const std::vector<double> rows = robot.rows(q, "q");
  const std::size_t n = rows.size() / static_cast<std::size_t>(robot.dof());
  const NewArray<double> out({n, 4, 4});
  {
    const nb::gil_scoped_release free;
    std::vector<Pose> X_WT(n);
    fk_batch(robot.ik.chain(), rows, X_WT);
    for (std::size_t i = 0; i < n; ++i) {
      Eigen::Map<Homogeneous>(out.data + 16 * i) = homogeneous(X_WT[i]);
    }
  }
  return out.object;
}

nb::object jacobian(const BoundRobot& robot, nb::handle q) {
  const JointVec values = robot.joints(q, "q");
  const auto dof = static_cast<std::size_t>(robot.dof());
  const NewArray<double> rows({6, dof});
  using RowMajor = Eigen::Matrix<double, 6, Eigen::Dynamic, Eigen::RowMajor>;
  Jacobian J_W = fk_jacobian(robot.arm(), as_span(values)).J_W;
  const Eigen::Matrix3d R = robot.moved_base(q).R;
  J_W.topRows<3>() = R * J_W.topRows<3>();
  J_W.bottomRows<3>() = R * J_W.bottomRows<3>();
  Eigen::Map<RowMajor>(rows.data, 6, robot.dof()) = J_W;
  return rows.object;
}

void bind_answers(nb::module_& m) {
  nb::enum_<IkErrc>(m, "IkReason", "Why a pose has no answer.")
      .value("out_of_reach", IkErrc::out_of_reach, "Farther than the arm can stretch.")
      .value("inner_void", IkErrc::inner_void, "Inside a region the arm cannot fold into.")
      .value("joint_limit", IkErrc::joint_limit, "Reached only with a joint beyond its limit.")
      .value("collision", IkErrc::collision, "Answers exist, `valid` refused them all.")
      .value("no_convergence", IkErrc::no_convergence, "No answer was found; not a proof.")
      .value("too_far", IkErrc::too_far,
             "Answers exist, all farther than `max_step` from the seed.")
      .value("bad_input", IkErrc::bad_input, "No number, no rotation, a wrong size.");
  nb::class_<IkSolution>(m, "IkSolution", "Joint values, and how far their tool is from the goal.")
      .def_prop_ro(
          "q", [](const IkSolution& s) { return array(s.q); }, nb::sig("def q(self) -> Array"),
          "Joint values [rad or m] within the limits, shape (dof,).")
      .def_ro("pos_err", &IkSolution::pos_err, "Distance to the goal [m].")
      .def_ro("rot_err", &IkSolution::rot_err, "Angle to the goal [rad].")
      .def_ro("iterations", &IkSolution::iterations, "Steps taken in all; 0 in closed form.")
      .def_ro("restarts", &IkSolution::restarts, "Random starts used; 0: solved from the seed.")
      .def("__getstate__",  // with it what a worker process raises comes whole
           [](const IkSolution& s) {
             return nb::make_tuple(array(s.q), s.pos_err, s.rot_err, s.iterations, s.restarts);
           })
      .def("__setstate__", [](IkSolution& s, const nb::tuple& state) {
        new (&s) IkSolution{joint_vec(reals(state[0], "q").span()), nb::cast<double>(state[1]),
                            nb::cast<double>(state[2]), nb::cast<int>(state[3]),
                            nb::cast<int>(state[4])};
      });
  nb::enum_<SingularKind>(m, "SingularKind", "Which part of an arm loses a direction of motion.")
      .value("none", SingularKind::none)
      .value("shoulder", SingularKind::shoulder)
      .value("elbow", SingularKind::elbow)
      .value("wrist", SingularKind::wrist)
      .value("other", SingularKind::other);
}

constexpr const char* kIk = R"(Joint values that put the tool to a pose.

Parameters
----------
pose : Pose or array_like, shape (4, 4)
    Of the tool in the world.
seed : array_like, shape (dof,), optional
    Joint values [rad or m]: of several answers the nearest to them is taken. Default: home.
task : {"pose", "position", "axis"}, optional
    What of the pose must be met; "axis" leaves the turn about the tool's z free.
pos_tol, rot_tol : float, optional
    [m], [rad]
max_step : float, optional
    Farthest that any joint may be from the seed [rad or m]; rather no answer than a flip.
restarts : int, optional
    Random starts of a search, where no closed form is known.
valid : callable, optional
    valid(q) -> bool, refuses answers.

Returns
-------
IkSolution
    Its `q` is within the limits.

Raises
------
Unreachable
    With `reason`, `amount`, `joint` and the `best` that was had.
)";

constexpr const char* kIkSig =
    "def ik(self, pose: PoseLike, seed: ArrayLike | None = None, *, task: str | None = None, "
    "pos_tol: "
    "float = 1e-07, rot_tol: float = 1e-07, max_step: float = float('inf'), restarts: int = 100, "
    "valid: "
    "Callable[[Array], bool] | None = None) -> IkSolution";

constexpr const char* kIkAllSig =
    "def ik_all(self, pose: PoseLike, seed: ArrayLike | None = None, *, windings: bool = False, "
    "max: int "
    "= 4096, task: str | None = None, pos_tol: float = 1e-07, rot_tol: float = 1e-07, max_step: "
    "float = "
    "float('inf'), valid: Callable[[Array], bool] | None = None) -> Array";

/// `mjarm.Tracker`, and how many joints it leads.
struct BoundTracker {
  Robot robot;
  Tracker tracker;
};

BoundTracker tracker(const BoundRobot& r, double dt, double gain, double speed_share) {
  if (!(dt > 0)) refuse(msg::python_positive, "dt");
  if (!(gain > 0 && gain <= 1)) refuse(msg::python_share, "gain");
  if (!(speed_share > 0 && speed_share <= 1)) refuse(msg::python_share, "speed_share");
  return {r.robot, Tracker(r.arm(), {.dt = dt, .gain = gain, .speed_share = speed_share})};
}

void bind_tracker(nb::module_& m) {
  nb::class_<TrackStep>(m, "TrackStep", "One step of servoing.")
      .def_prop_ro(
          "q", [](const TrackStep& s) { return array(s.q); }, nb::sig("def q(self) -> Array"),
          "Where to go [rad or m], (dof,), within the limits.")
      .def_ro("pos_err", &TrackStep::pos_err, "Of the tool before the step [m].")
      .def_ro("rot_err", &TrackStep::rot_err, "Likewise [rad].")
      .def_ro("speed_scale", &TrackStep::speed_scale,
              "Below 1 where the greatest speed slowed the whole step down.")
      .def_ro("damping", &TrackStep::damping, "What was used; 0 away from singularities.")
      .def_ro("held", &TrackStep::held, "Joints that stand at a limit.");
  nb::class_<BoundTracker>(m, "Tracker",
                           "Leads the tool after a pose that may change with every call.")
      .def(
          "step",
          [](const BoundTracker& t, nb::handle pose, nb::handle q) {
            const JointVec now = joint_vec(reals(q, "q", {t.robot.arm.dof()}).span());
            const TrackStep step = t.tracker.step(pose_of(pose, "pose"), as_span(now));
            if (!step.ok) refuse(msg::python_no_step);
            return step;
          },
          nb::arg("pose"), nb::arg("q"),
          nb::sig("def step(self, pose: PoseLike, q: ArrayLike) -> TrackStep"),
          "One damped step from `q` [rad or m], (dof,), towards a pose (Y. Nakamura and H. "
          "Hanafusa, J. Dyn. Sys. Meas.\nControl 108 (1986) 163), no joint faster than it may be.");
}

}  // namespace

void bind_kinematics(nb::module_& m) {
  bind_answers(m);
  bind_tracker(m);
  const IkOptions usual;
  const auto none = [](const char* name) { return nb::arg(name).none() = nb::none(); };
  auto robot = nb::borrow<nb::class_<BoundRobot>>(m.attr("Robot"));
  robot
      .def(
          "fk",
          [](const BoundRobot& r, nb::handle q) {
            return r.moved_base(q) * fk(r.ik.links(), as_span(r.joints(q, "q")));
          },
          nb::arg("q"), nb::sig("def fk(self, q: ArrayLike) -> Pose"),
          "Pose of the tool in the world at joint values `q` [rad or m], shape (dof,), or at the "
          "whole\n"
          "configuration of the model, shape (nq,), such as `data.qpos`.")
      .def("fk_batch", &fk_many, nb::arg("q"), nb::sig("def fk_batch(self, q: ArrayLike) -> Array"),
           "The same of many at once: (n, dof) to homogeneous matrices (n, 4, 4).")
      .def("jacobian", &jacobian, nb::arg("q"),
           nb::sig("def jacobian(self, q: ArrayLike) -> Array"),
           "Geometric Jacobian of the tool's origin in axes of the world, shape (6, dof): rows 0 "
           "to 2\n"
           "[m/rad], rows 3 to 5 [rad/rad].")
      .def(
          "manipulability",
          [](const BoundRobot& r, nb::handle q) {
            return manipulability(fk_jacobian(r.arm(), as_span(r.joints(q, "q"))).J_W);
          },
          nb::arg("q"), nb::sig("def manipulability(self, q: ArrayLike) -> float"),
          "sqrt(det(J J^T)), 0 at a singularity (T. Yoshikawa, IJRR 4 (1985)).")
      .def(
          "singularity",
          [](const BoundRobot& r, nb::handle q) {
            const Singularity s = singularity(r.ik, as_span(r.joints(q, "q")));
            return nb::make_tuple(nb::cast(s.kind), s.smallest);
          },
          nb::arg("q"),
          nb::sig("def singularity(self, q: ArrayLike) -> tuple[SingularKind, float]"),
          "The kind of the nearest singularity and the smallest singular value of the Jacobian.")
      .def("ik", &ik, nb::arg("pose"), none("seed"), nb::kw_only(), none("task"),
           nb::arg("pos_tol") = usual.pos_tol, nb::arg("rot_tol") = usual.rot_tol,
           nb::arg("max_step") = kAnyStep, nb::arg("restarts") = usual.restarts, none("valid"),
           nb::sig(kIkSig), kIk)
      .def("ik_all", &ik_all, nb::arg("pose"), none("seed"), nb::kw_only(),
           nb::arg("windings") = false, nb::arg("max") = IkAllOptions().max, none("task"),
           nb::arg("pos_tol") = usual.pos_tol, nb::arg("rot_tol") = usual.rot_tol,
           nb::arg("max_step") = kAnyStep, none("valid"), nb::sig(kIkAllSig),
           "All distinct answers, nearest to the seed first, shape (n, dof) [rad or m]: of six "
           "hinges, whatever\n"
           "their geometry, and of other closed forms every branch, else those that random starts "
           "find; with\n"
           "`windings` every winding of each. Raises as `ik` does where none is.")
      .def("tracker", &tracker, nb::kw_only(), nb::arg("dt") = TrackOptions().dt,
           nb::arg("gain") = TrackOptions().gain,
           nb::arg("speed_share") = TrackOptions().speed_share,
           "Differential inverse kinematics for servoing: `dt` [s] from call to call, `gain` the "
           "share of the error taken off\nin a call, `speed_share` of the joints' greatest speed.")
      .def("ik_batch", &ik_batch, nb::arg("poses"), none("seed"), nb::kw_only(),
           nb::arg("threads") = 0,
           nb::sig("def ik_batch(self, poses: PosesLike, seed: ArrayLike | None = None, *, "
                   "threads: int = 0) "
                   "-> tuple[Array, Flags]"),
           "Many poses at once, on all cores (`threads` of them).\n\n"
           "Takes (n, 4, 4), a list of poses or a pair of positions (n, 3) and quaternions (n, 4); "
           "the seed\n"
           "is one for all, (dof,), or one each, (n, dof). Returns joint values (n, dof), NaN "
           "where a pose\n"
           "has no answer, and which have one, (n,). Each answer is that of `ik`, whatever the "
           "threads.");
}

}  // namespace mjarm::python

// Identification: what the logs of an arm tell of it.
#include <nanobind/stl/array.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <cmath>
#include <map>
#include <utility>

#include "mjarm/execution/motion_plan.hpp"
#include "mjarm/identification/excitation.hpp"
#include "mjarm/identification/identify.hpp"
#include "mjarm/identification/joint_log.hpp"
#include "mjarm/model/joint_values.hpp"
#include "python/src/bindings.hpp"
#include "python/src/convert.hpp"
#include "python/src/interrupt.hpp"
#include "python/src/robot.hpp"

namespace mjarm::python {
namespace {

/// `mjarm.JointEstimate`: with its name and its torque limit.
struct BoundJointEstimate : JointEstimate {
  std::string name = {};
  double limit = 0;  ///< [N m or N]
};

/// `mjarm.BaseParameter`
struct BoundBaseParameter {
  std::string name;
  Estimate found;
  double model = 0;
  std::map<std::string, double> merged;
};

/// `mjarm.Identification`: with the names of what it is of.
struct BoundIdentification {
  Identification found;
  Arm arm;
};

std::vector<JointVec> log_rows(const Reals& given) {
  const std::size_t dof = given.shape(1);
  std::vector<JointVec> out;
  for (std::size_t i = 0; i < given.size(); i += dof)
    out.push_back(joint_vec({given.data() + i, dof}));
  return out;
}

JointLog joint_log(double timestep, nb::handle q, nb::handle torque) {
  if (!(timestep > 0) || !std::isfinite(timestep)) refuse(msg::python_positive, "timestep");
  const Reals positions = reals(q, "q", {-1, -1});
  const std::size_t dof = positions.shape(1);
  if (positions.shape(0) == 0) refuse(msg::python_empty, "q");
  if (dof == 0 || dof > kMaxDof) refuse(msg::python_log_joints, kMaxDof, dof);
  const Reals torques = reals(
      torque, "torque", {static_cast<long long>(positions.shape(0)), static_cast<long long>(dof)});
  return {timestep, log_rows(positions), log_rows(torques)};
}

nb::object rows_of(const std::vector<JointVec>& rows) {
  return array(rows, rows.empty() ? 0 : static_cast<int>(rows.front().size()));
}

/// A log of this robot, in its units.
void check_log(const JointLog& log, const BoundRobot& robot, const char* name) {
  for (const JointVec& q : log.q) {
    if (q.size() != robot.dof()) refuse(msg::python_log_dof, name, q.size(), robot.dof());
    value_of(check_joint_units(as_span(q), robot.arm()));
  }
}

BoundIdentification identify_log(const BoundRobot& robot, const JointLog& log,
                                 const JointLog* empty, bool payload, bool links) {
  if (empty == nullptr && payload && links) {
    raise(Error{Errc::usage, text(msg::python_payload_and_links)});
  }
  check_log(log, robot, "log");
  if (empty != nullptr) check_log(*empty, robot, "empty");
  Result<Identification> found = interruptible([&](const StopCheck& stop) {
    return identify(
        robot.robot,
        {.log = &log, .empty = empty, .payload = payload, .links = links, .stop = stop});
  });
  return {value_of(std::move(found)), robot.arm()};
}

PlannedMove excite(const BoundRobot& robot, nb::handle start, double seconds, std::uint64_t seed,
                   double share, double reach, bool collisions) {
  if (!(share > 0 && share <= 1)) refuse(msg::python_share, "share");
  if (!(reach > 0)) refuse(msg::python_positive, "reach");
  const JointVec q_start = robot.joints_or_home(start, "start");
  const Model& model = robot.robot.model;
  ClearanceCheck clearance;
  if (collisions) clearance = clearance_check({model, robot.arm()});
  Result<Trajectory> motion = interruptible([&](const StopCheck& stop) {
    const ExcitationOptions options{
        .seconds = seconds,
        .seed = seed,
        .share = share,
        .reach = reach,
        .valid = [&](std::span<const double>) { return !is_stopped(stop); }};
    return free_excitation(model, robot.arm(), q_start, clearance, options);
  });
  return {.word = "excite", .trajectory = value_of(std::move(motion))};
}

std::vector<BoundJointEstimate> joints_of(const BoundIdentification& self) {
  std::vector<BoundJointEstimate> out;
  for (std::size_t j = 0; j < self.found.joints.size(); ++j) {
    out.push_back({self.found.joints[j], self.arm.joints[j].name,
                   self.arm.limits.torque[static_cast<Eigen::Index>(j)]});
  }
  return out;
}

std::vector<BoundBaseParameter> links_of(const BoundIdentification& self) {
  const Identification& found = self.found;
  std::vector<BoundBaseParameter> out;
  for (std::size_t i = 0; i < found.links.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    BoundBaseParameter one{
        parameter_name(found.base.kept[i], self.arm), found.links[i], found.model_links[row], {}};
    for (std::size_t k = 0; k < found.base.merged.size(); ++k) {
      const double weight = found.base.weight(row, static_cast<Eigen::Index>(k));
      if (weight != 0) one.merged[parameter_name(found.base.merged[k], self.arm)] = weight;
    }
    out.push_back(std::move(one));
  }
  return out;
}

/// Noise may put the mass of nothing below 0.
Payload payload_value(const PayloadEstimate& found) {
  return found.mass.value > 0 ? found.payload() : Payload{};
}

std::string payload_words(const PayloadEstimate& found) {
  if (!found.is_told()) return "no payload (" + describe(found.mass) + " kg)";
  std::string out = describe(found.mass) + " kg at (";
  for (std::size_t i = 0; i < 3; ++i) out += (i > 0 ? ", " : "") + describe(found.center[i]);
  return out + ") m";
}

std::string identification_words(const BoundIdentification& self) {
  const Identification& found = self.found;
  std::string out = "<mjarm.Identification of '" + self.arm.name + "': ";
  if (found.payload) out += payload_words(*found.payload) + ", ";
  if (!found.links.empty()) out += std::to_string(found.links.size()) + " base parameters, ";
  return out + std::to_string(found.rows) + " equations>";
}

constexpr const char* kJointLog = R"(Joint positions and torques of an arm, a row a time step.

    log = robot.simulate(motion).log
    log = mjarm.JointLog(robot.timestep, log["q"], log["torque"])

Parameters
----------
timestep : float
    From row to row [s], > 0.
q : array_like, shape (n, dof)
    Positions as they were measured [rad or m].
torque : array_like, shape (n, dof)
    Of the drives at the joints [N m or N].

Raises
------
BadInput
    Arrays of other shapes, or with numbers that are not finite.
)";

constexpr const char* kReadLog =
    R"(Reads a log: log.csv of `mjarm run` and Run.save(), or a table of a real arm.

Parameters
----------
file : str or os.PathLike
    CSV with the columns `time [s]`, and `q JOINT [rad]` and `torque JOINT [N m]` of every joint, in any order; others may stand
    between.
robot : Robot
    Whose joints are looked for.

Raises
------
BadInput
    One line that names file and line or column: a column that is missing, a number that is none, rows that are not evenly
    spaced in time.
)";

constexpr const char* kIdentify =
    R"(What hangs at the tool, how joints resist and what links weigh, by weighted least squares.

    log = robot.simulate(mjarm.excitation(robot), payload=mjarm.Payload(1.5)).log
    found = mjarm.identify(robot, mjarm.JointLog(robot.timestep, log["q"], log["torque"]))
    print(found.payload.mass)                 # 1.5 kg
    robot.simulate(motion, payload=found.payload.value)

A payload cannot be told from an error of the last link: with one log the links are taken to be as in the model, with one
of the empty arm as well nothing is.

Parameters
----------
robot : Robot
    As far as it is known.
log : JointLog
    A row every 20 ms or more often, for 2 s at least, in which joints move: excitation() has them do so.
empty : JointLog, optional
    Of the same arm without the payload, by any motion, with the same time step. Payload and links are found then, whatever is
    said of them.
payload : bool, optional
    Something may hang at the tool, beside what the model has there.
links : bool, optional
    The links are not as in the model; without `empty` it takes `payload=False`.

Returns
-------
Identification

Raises
------
BadInput
    A log that is of another arm, too short or too coarse, or in which nothing moves.
Usage
    `payload` and `links` from one log.
)";

constexpr const char* kExcitation =
    R"(A motion of which a log tells much: every joint to and fro by a Fourier series, from rest to rest.

Of thirty random ones it is that whose equations are best conditioned; same robot, start and seed, same motion.

Parameters
----------
robot : Robot
start : array_like, shape (dof,), optional
    Where it begins and ends [rad or m]; None: home.
seconds : float, optional
    How long it takes [s], 5 to 120.
seed : int, optional
    Of the random numbers.
share : float, optional
    Of the limits of velocity and acceleration, up to 1.
reach : float, optional
    How far a joint goes from its start at most [rad or m].
collisions : bool, optional
    Keep 10 mm from everything, as the instruction `excite` of programs does.

Returns
-------
Motion

Raises
------
BadInput
    A value beyond its range.
Impossible
    No motion from there is free of contact.
)";

void bind_log(nb::module_& m) {
  nb::class_<JointLog>(m, "JointLog", kJointLog)
      .def(
          "__init__",
          [](JointLog* self, double timestep, nb::handle q, nb::handle torque) {
            new (self) JointLog(joint_log(timestep, q, torque));
          },
          nb::arg("timestep"), nb::arg("q").none(), nb::arg("torque").none(),
          nb::sig("def __init__(self, timestep: float, q: ArrayLike, torque: ArrayLike) -> None"))
      .def_ro("timestep", &JointLog::timestep, "From row to row [s].")
      .def_prop_ro(
          "q", [](const JointLog& log) { return rows_of(log.q); }, nb::sig("def q(self) -> Array"),
          "Positions [rad or m], (n, dof).")
      .def_prop_ro(
          "torque", [](const JointLog& log) { return rows_of(log.torque); },
          nb::sig("def torque(self) -> Array"), "Of the drives at the joints [N m or N], (n, dof).")
      .def("__len__", [](const JointLog& log) { return log.q.size(); })
      .def("__repr__", [](const JointLog& log) {
        const auto dof = log.q.empty() ? 0 : log.q.front().size();
        return nb::str("<mjarm.JointLog: {} rows of {} joints, every {:.6g} s>")
            .format(log.q.size(), dof, log.timestep);
      });
  m.def(
      "read_joint_log",
      [](const std::filesystem::path& file, const BoundRobot& robot) {
        return value_of([&] {
          const nb::gil_scoped_release free;
          return read_joint_log(file, robot.arm());
        }());
      },
      nb::arg("file"), nb::arg("robot"),
      nb::sig("def read_joint_log(file: str | os.PathLike[str], robot: Robot) -> JointLog"),
      kReadLog);
}

void bind_estimates(nb::module_& m) {
  nb::class_<Estimate>(m, "Estimate", "A number that was estimated; float() has its value.")
      .def_ro("value", &Estimate::value, "Where it is not known, as the model has it.")
      .def_ro("error", &Estimate::error, "Standard error, of the same unit; inf: it is not known.")
      .def_ro("known", &Estimate::known, "The log tells it.")
      .def("__float__", [](const Estimate& e) { return e.value; })
      .def("__repr__", [](const Estimate& e) { return "<mjarm.Estimate: " + describe(e) + ">"; });
  nb::class_<PayloadEstimate>(m, "PayloadEstimate", "What hangs at the tool, as a point mass.")
      .def_ro("mass", &PayloadEstimate::mass, "[kg]")
      .def_ro("center", &PayloadEstimate::center,
              "Centre of mass in the frame of the tool [m]: x, y, z.")
      .def_prop_ro("told", &PayloadEstimate::is_told,
                   "There is more than nothing, by three standard errors.")
      .def_prop_ro("value", &payload_value,
                   "As Robot.simulate() and Program.run() take it; a mass below 0 counts as 0.")
      .def("__repr__", [](const PayloadEstimate& found) {
        return "<mjarm.PayloadEstimate: " + payload_words(found) + ">";
      });
  using Joint = BoundJointEstimate;
  nb::class_<Joint>(m, "JointEstimate", "How one joint resists beside what its links need.")
      .def_ro("name", &Joint::name, "Of the joint.")
      .def_ro("friction", &Joint::friction, "Dry friction [N m or N].")
      .def_ro("viscous", &Joint::viscous, "Viscous friction [N m s/rad or N s/m].")
      .def_ro("offset", &Joint::offset, "Of the torque in the log [N m or N].")
      .def_ro("inertia", &Joint::inertia,
              "Of the rotor, at the joint [kg m^2 or kg]; where links are asked, that of the first "
              "joints cannot be told from them.")
      .def_ro("rms", &Joint::rms, "Of the torque that the estimates leave unexplained [N m or N].")
      .def_prop_ro(
          "unexplained", [](const Joint& j) { return j.rms / j.limit; },
          "The same as a share of the joint's torque limit. More than 0.02: something was touched, "
          "or the links are not as in the model.")
      .def("__repr__", [](const Joint& j) {
        return "<mjarm.JointEstimate '" + j.name + "': friction " + describe(j.friction) +
               ", viscous " + describe(j.viscous) + ">";
      });
}

void bind_answer(nb::module_& m) {
  using Link = BoundBaseParameter;
  nb::class_<Link>(
      m, "BaseParameter",
      "Of the links, in the frame of its joint: what torques can tell, which stands for "
      "itself and for what goes along with it.")
      .def_ro("name", &Link::name,
              "\"m\", \"mx\", \"Ixx\" and so on, or \"rotor\", and the joint: \"mx elbow_joint\".")
      .def_ro("estimate", &Link::found, "[kg, kg m or kg m^2]")
      .def_ro("model", &Link::model, "The same as the model has it.")
      .def_ro("merged", &Link::merged, "What goes along with it, by name, with its weight.")
      .def("__repr__", [](const Link& link) {
        return nb::str("<mjarm.BaseParameter '{}': {}, in the model {:.4f}>")
            .format(link.name, describe(link.found), link.model);
      });
  using Found = BoundIdentification;
  nb::class_<Found>(m, "Identification", "What positions and torques tell of an arm.")
      .def_prop_ro("joints", &joints_of, "Of each joint, from base to tip.")
      .def_prop_ro(
          "payload", [](const Found& f) { return f.found.payload; },
          "What hangs at the tool beside what the model has there; None where it was not asked.")
      .def_prop_ro("links", &links_of,
                   "Base parameters, payload not included; empty where they were not asked.")
      .def_prop_ro(
          "delay", [](const Found& f) { return f.found.delay; },
          "By which torques in the log are told before they act [s]; of Run.log a time step less "
          "than "
          "0, as its rows have the torque that led to them.")
      .def_prop_ro(
          "rows", [](const Found& f) { return f.found.rows; }, "Of the equations.")
      .def("__repr__", &identification_words);
}

}  // namespace

void bind_identification(nb::module_& m) {
  bind_log(m);
  bind_estimates(m);
  bind_answer(m);
  m.def("identify", &identify_log, nb::arg("robot"), nb::arg("log"),
        nb::arg("empty").none() = nb::none(), nb::arg("payload") = true, nb::arg("links") = false,
        nb::sig("def identify(robot: Robot, log: JointLog, empty: JointLog | None = None, payload: "
                "bool = True, links: bool = False) -> Identification"),
        kIdentify);
  const ExcitationOptions usual;
  m.def("excitation", &excite, nb::arg("robot"), nb::arg("start").none() = nb::none(),
        nb::kw_only(), nb::arg("seconds") = usual.seconds, nb::arg("seed") = usual.seed,
        nb::arg("share") = usual.share, nb::arg("reach") = usual.reach,
        nb::arg("collisions") = true,
        nb::sig("def excitation(robot: Robot, start: ArrayLike | None = None, *, seconds: float = "
                "20.0, seed: int = 1, share: float = 0.4, reach: float = 1.2, collisions: bool = "
                "True) -> Motion"),
        kExcitation);
}

}  // namespace mjarm::python

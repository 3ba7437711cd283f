#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "mjarm/core/result.hpp"
#include "mjarm/model/grip_check.hpp"
#include "mjarm/model/model.hpp"

namespace mjarm {

/// How bad a finding is.
enum class Grade {
  error,    ///< the description says something that cannot be, or that nobody can have meant
  warning,  ///< the model works, but most likely not as was meant
  note,     ///< worth knowing; nothing that must be mended
};
/// "error", "warning" or "note".
[[nodiscard]] std::string_view name(Grade grade) noexcept;

/// What a finding is about. The names are stable: scripts may hold on to them.
enum class CheckCode {
  not_loadable,            ///< the loader refuses the file
  name_doubled,            ///< two things of one kind bear the same name
  inertia_triangle,        ///< the two smaller principal moments add up to less than the largest
  inertia_not_positive,    ///< a principal moment is zero or negative
  inertia_implausible,     ///< radius of gyration far from the size of the body
  inertial_missing,        ///< a moving body without mass of its own
  mass_zero,               ///< a moving body whose mass is given as zero
  mass_implausible,        ///< far lighter or heavier than its shapes allow
  com_outside,             ///< the centre of mass lies far outside the shapes
  degrees_for_radians,     ///< an angle in degrees where radians are read
  radians_for_degrees,     ///< an angle in radians where degrees are read
  length_implausible,      ///< a link of 10 m and more: millimetres for metres
  mesh_size_odd,           ///< a mesh of 5 m and more, or under 1 mm
  limits_missing,          ///< a joint of the arm without stops
  limits_empty,            ///< lower and upper limit are equal
  limits_ignored,          ///< a range is given but switched off
  range_tiny,              ///< a hinge of the arm that may turn by less than 0.1 rad
  velocity_limit_missing,  ///< URDF: no velocity limit, or 0
  effort_limit_missing,    ///< URDF: no effort limit, or 0
  axis_missing,            ///< URDF: a moving joint without <axis>, which then is x
  axis_not_unit,           ///< URDF: an axis whose length is not 1
  mimic,                   ///< URDF: a joint that follows another one
  collision_missing,       ///< shapes that are seen but touch nothing
  material_unknown,        ///< URDF: a material that is nowhere defined
  unused_mesh,             ///< nothing shows this mesh
  unused_texture,          ///< nothing shows this texture
  unused_material,         ///< nothing has this material
  unused_class,            ///< nothing belongs to this default class
  arm_found,               ///< the arm, its tool frame and its gripper
  arm_missing,             ///< no arm in it
  arm_ambiguous,           ///< several arms or tool frames to choose from
  base_floats,             ///< the arm stands on a body that nothing holds
  tip_missing,             ///< no tool frame: the last link has to serve
  gripper_not_driven,      ///< joints beyond the arm that nothing moves
  home_missing,            ///< no keyframe to start from
  home_outside_limits,     ///< the home keyframe breaks a limit
  home_ctrl_differs,       ///< the home keyframe commands another position than it has
  home_self_contact,       ///< the arm touches itself at home
  home_contact,            ///< the arm touches its surroundings at home
  actuator_missing,        ///< a joint of the arm that nothing drives
  actuator_doubled,        ///< a joint of the arm with two actuators
  ctrl_range_differs,      ///< a servo whose commands do not match the range of its joint
  force_limit_missing,     ///< an actuator that may push without bound
  torque_too_small,        ///< an actuator too weak to hold the arm against gravity
  servo_sag,               ///< how far a resting servo hangs below its command
  servo_unstable,          ///< a servo that pushes away from its command
  servo_undamped,          ///< a servo without any damping
  timestep_large,          ///< a time step above 10 ms
  gravity_odd,             ///< gravity that is not about 9.8 m/s^2 along -z
  grip_creep,              ///< what the gripper holds creeps out of it
  grip_cone,               ///< the friction cone is pyramidal
  grip_impratio,           ///< friction softer than what holds
  pads_soft,               ///< pads whose contacts give way (solref, solimp)
  pads_slippery,           ///< pads of little friction
  pads_condim,             ///< pads that resist no twisting
  finger_damping,          ///< joints of the gripper damped much beside their inertia
  finger_slow,             ///< joints of the gripper damped so much that it closes slowly
  jaws_overlap,            ///< shapes of the open gripper that overlap, or fill its jaws
  grip_not_measured,       ///< the gripper does not hold a cube, or has no jaws to hold it in
  overlap_by_design,       ///< parts of the arm that overlap, or are sunk in what stands, always
};
/// The code as a word, such as `inertia_triangle`.
[[nodiscard]] std::string_view name(CheckCode code) noexcept;

/// One thing found in a description.
struct Finding {
  CheckCode code = CheckCode::not_loadable;
  Grade grade = Grade::error;
  std::string file;     ///< the file it stands in (an included one is named itself)
  int line = 0;         ///< from 1; 0 where there is no one line to name
  std::string element;  ///< such as `<joint "elbow">`; empty where it is about the whole file
  std::string what;     ///< one line in the user's language, with the numbers
};

/// All that was found, the worst first, then in the order of the checks.
struct CheckReport {
  std::string file;
  bool loads = false;  ///< the loader accepts the file
  std::vector<Finding> findings;
  GripMend grip_mend;  ///< what of a gripper can be mended, for export_mended()

  [[nodiscard]] int count(Grade grade) const;
};

/// How to check. Every default is usable as is.
struct CheckOptions {
  std::string tip;        ///< tool frame; empty = the arm's own
  LoadOptions load = {};  ///< where meshes are looked for
};

/// Reads a description as a careful colleague would and lists what is odd about it. Grades:
///
/// - error: it cannot be so (an inertia no body has, a range of 360 rad, a name given twice), or
///   the file does not load;
/// - warning: it loads, but surely not as was meant (mass or inertia far from what the shapes
///   allow, a servo so soft that the tool hangs 5 cm low, contact at home, assets nobody uses);
/// - note: facts a user wants. The sag of position servos is a note below 5 cm: industrial arms
///   under the servos of their usual models hang by 5 to 30 mm (the UR5e by 8 mm at home and 30 mm
///   stretched out), which is a property of such servos and not a fault of the file. So is a radius
///   of gyration up to three times the size of the body: figures identified from motion, like the
///   Panda's, go that far. And so is what a gripper lets creep: it is measured, on a cube that the
///   gripper closes on in a simulation of a few seconds, as the file is and with each setting that
///   would make it hold better (some tenths of a second of computing time).
///
/// A file that is well-formed XML but does not load is still searched for the faults its text
/// shows.
/// @return an error where the file cannot be read at all or `options.tip` names no frame.
[[nodiscard]] Result<CheckReport> check_model(const std::filesystem::path& file,
                                              const CheckOptions& options = {});

}  // namespace mjarm

#include "mjarm/model/check.hpp"

#include <algorithm>
#include <array>
#include <exception>

#include "mjarm/core/messages/check.hpp"
#include "mjarm/model/check_internal.hpp"
#include "mjarm/model/find_arm.hpp"

namespace mjarm {
namespace fs = std::filesystem;
namespace {

/// Names of the codes in the order of the enum.
constexpr std::array<std::string_view, 60> kNames = {"not_loadable",
                                                     "name_doubled",
                                                     "inertia_triangle",
                                                     "inertia_not_positive",
                                                     "inertia_implausible",
                                                     "inertial_missing",
                                                     "mass_zero",
                                                     "mass_implausible",
                                                     "com_outside",
                                                     "degrees_for_radians",
                                                     "radians_for_degrees",
                                                     "length_implausible",
                                                     "mesh_size_odd",
                                                     "limits_missing",
                                                     "limits_empty",
                                                     "limits_ignored",
                                                     "range_tiny",
                                                     "velocity_limit_missing",
                                                     "effort_limit_missing",
                                                     "axis_missing",
                                                     "axis_not_unit",
                                                     "mimic",
                                                     "collision_missing",
                                                     "material_unknown",
                                                     "unused_mesh",
                                                     "unused_texture",
                                                     "unused_material",
                                                     "unused_class",
                                                     "arm_found",
                                                     "arm_missing",
                                                     "arm_ambiguous",
                                                     "base_floats",
                                                     "tip_missing",
                                                     "gripper_not_driven",
                                                     "home_missing",
                                                     "home_outside_limits",
                                                     "home_ctrl_differs",
                                                     "home_self_contact",
                                                     "home_contact",
                                                     "actuator_missing",
                                                     "actuator_doubled",
                                                     "ctrl_range_differs",
                                                     "force_limit_missing",
                                                     "torque_too_small",
                                                     "servo_sag",
                                                     "servo_unstable",
                                                     "servo_undamped",
                                                     "timestep_large",
                                                     "gravity_odd",
                                                     "grip_creep",
                                                     "grip_cone",
                                                     "grip_impratio",
                                                     "pads_soft",
                                                     "pads_slippery",
                                                     "pads_condim",
                                                     "finger_damping",
                                                     "finger_slow",
                                                     "jaws_overlap",
                                                     "grip_not_measured",
                                                     "overlap_by_design"};
static_assert(kNames[static_cast<std::size_t>(CheckCode::overlap_by_design)] ==
              "overlap_by_design");

/// `FILE: what` or `FILE:LINE: <element>: what` taken apart.
Finding finding_of(const Error& error, const fs::path& file) {
  Finding finding;
  finding.file = file.string();
  finding.what = error.what;
  const std::string& what = error.what;
  // The first `:LINE:` parts the place from the words; the file may be an included one. A folder
  // may be called so as well.
  const std::size_t named = what.starts_with(finding.file) ? finding.file.size() : 0;
  for (std::size_t colon = what.find(':', named); colon != std::string::npos;
       colon = what.find(':', colon + 1)) {
    std::size_t end = colon + 1;
    while (end < what.size() && what[end] >= '0' && what[end] <= '9') ++end;
    const bool is_line = end > colon + 1 && end < colon + 9;
    if (!is_line) continue;
    finding.file = what.substr(0, colon);
    finding.line = std::stoi(what.substr(colon + 1, end - colon - 1));
    finding.what = what.substr(end);
    break;
  }
  if (finding.line == 0 && what.starts_with(finding.file)) {
    finding.what = what.substr(finding.file.size());
  }
  for (const std::string_view mark : {": ", "：", ":"}) {
    if (!finding.what.starts_with(mark)) continue;
    finding.what.erase(0, mark.size());
    break;
  }
  return finding;
}

void check_text(const CheckContext& context) {
  check_names(context);
  check_inertials(context);
  if (context.description.is_urdf()) {
    check_urdf_links(context);
    check_urdf_joints(context);
  }
  check_angles(context);
  check_unused(context);
}

Result<void> check_loaded(CheckContext context, const CheckOptions& options) {
  check_world(context);
  check_masses(context);
  const Result<Arm> arm = find_arm(*context.model, {.tip = options.tip});
  if (!arm && !options.tip.empty()) return fail(arm.error());
  if (!arm) {
    const bool choose = arm.error().code == Errc::usage;
    Finding why = finding_of(arm.error(), context.model->file());
    context.add(choose ? CheckCode::arm_ambiguous : CheckCode::arm_missing, Grade::note,
                context.description.root(), why.what);
    return {};
  }
  context.arm = &*arm;
  check_arm(context);
  check_actuators(context);
  check_sag(context);
  check_home(context);
  check_grip(context);
  return {};
}

}  // namespace

std::string_view name(Grade grade) noexcept {
  constexpr std::array<std::string_view, 3> kGrades = {"error", "warning", "note"};
  return kGrades[static_cast<std::size_t>(grade)];
}

std::string_view name(CheckCode code) noexcept { return kNames[static_cast<std::size_t>(code)]; }

int CheckReport::count(Grade grade) const {
  return static_cast<int>(std::count_if(findings.begin(), findings.end(),
                                        [&](const Finding& f) { return f.grade == grade; }));
}

Result<CheckReport> check_model(const fs::path& file, const CheckOptions& options) {
  try {
    const Result<Model> model = Model::load(file, options.load);
    const Description description(file, options.load.allow_outside);
    if (!model && description.empty()) return fail(model.error());
    CheckReport report;
    report.file = file.string();
    report.loads = model.has_value();
    const CheckContext context{.description = description,
                               .model = model ? &*model : nullptr,
                               .load = options.load,
                               .findings = report.findings,
                               .grip_mend = report.grip_mend};
    check_text(context);
    if (model) {
      if (auto done = check_loaded(context, options); !done) return fail(done.error());
    } else {
      report.findings.push_back(finding_of(model.error(), file));
    }
    std::stable_sort(report.findings.begin(), report.findings.end(),
                     [](const Finding& a, const Finding& b) { return a.grade < b.grade; });
    return report;
  } catch (const std::exception& problem) {
    return fail(Errc::system, text(msg::check_unexpected, file.string(), problem.what()));
  }
}

}  // namespace mjarm

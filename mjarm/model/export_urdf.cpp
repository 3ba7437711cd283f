#include <mujoco/mujoco.h>
#include <tinyxml2.h>

#include <map>
#include <set>
#include <utility>

#include "mjarm/core/messages/model.hpp"
#include "mjarm/core/nearest_word.hpp"
#include "mjarm/core/number.hpp"
#include "mjarm/core/rotation.hpp"
#include "mjarm/model/arm_parts_internal.hpp"
#include "mjarm/model/export_internal.hpp"
#include "mjarm/model/limits_table.hpp"

namespace mjarm {
namespace fs = std::filesystem;
namespace {

/// Mass and inertia of a link between two joints of one body: what Model::load gives to links
/// without any.
constexpr double kTinyMass = 1e-6;
constexpr double kTinyInertia = 1e-9;

std::string numbers(std::initializer_list<double> values) {
  std::string all;
  for (const double value : values) all += (all.empty() ? "" : " ") + number(value);
  return all;
}
std::string numbers(const Eigen::Vector3d& v) { return numbers({v.x(), v.y(), v.z()}); }

bool is_identity(const Pose& X) { return X.p.isZero(0) && X.R.isIdentity(0); }

/// Writes one URDF, link by link.
class UrdfWriter {
 public:
  UrdfWriter(const Model& model, const fs::path& folder)
      : model_(model), m_(model.raw()), folder_(folder) {
    const Result<Arm> arm = find_arm(model);
    if (arm) arm_ = *arm;
    for (int b = 0; b < m_->nbody; ++b) links_.push_back(unique(object_name(m_, mjOBJ_BODY, b)));
    for (int j = 0; j < m_->njnt; ++j) joint_names_.insert(joint_name(j));
  }

  Result<Exported> write() {
    for (int j = 0; j < m_->njnt; ++j) {
      if (m_->jnt_type[j] == mjJNT_BALL) {
        return fail(Errc::impossible, text(msg::model_not_exported, model_.file().string(),
                                           text(msg::model_urdf_ball, joint_name(j))));
      }
    }
    const std::string name(model_.name());
    out_.OpenElement("robot");
    out_.PushAttribute("name", name.empty() ? "robot" : name.c_str());
    for (int b = 0; b < m_->nbody; ++b) {
      if (b > 0) write_joints(b);
      write_link(b);
    }
    for (int s = 0; s < m_->nsite; ++s) write_site(s);
    out_.CloseElement();
    count_what_is_lost();
    return Exported{out_.CStr(), notes()};
  }

 private:
  [[nodiscard]] std::string joint_name(int j) const { return object_name(m_, mjOBJ_JOINT, j); }

  /// `name`, or with a number behind where a link has it already.
  std::string unique(const std::string& name) {
    std::string free = name;
    for (int n = 2; !link_names_.insert(free).second; ++n) free = name + "_" + std::to_string(n);
    if (free != name) renamed_.push_back(free);
    return free;
  }

  void element(const char* name, std::initializer_list<std::pair<const char*, std::string>> list) {
    out_.OpenElement(name);
    for (const auto& [key, value] : list) out_.PushAttribute(key, value.c_str());
    out_.CloseElement();
  }

  void write_origin(const Pose& X) {
    element("origin", {{"xyz", numbers(X.p)}, {"rpy", numbers(to_euler(X.R))}});
  }

  void open_joint(const std::string& name, const char* type, const std::string& parent,
                  const std::string& child, const Pose& X) {
    out_.OpenElement("joint");
    out_.PushAttribute("name", name.c_str());
    out_.PushAttribute("type", type);
    element("parent", {{"link", parent}});
    element("child", {{"link", child}});
    write_origin(X);
  }

  void write_fixed(const std::string& parent, const std::string& child, const Pose& X) {
    std::string name = child + "_fixed";
    while (!joint_names_.insert(name).second) name += "_";
    open_joint(name, "fixed", parent, child, X);
    out_.CloseElement();
  }

  /// The joints from the parent's link to that of body `b`, and the links between: MuJoCo moves a
  /// body about each joint's anchor by q - qpos0 in turn (Computation, Kinematics).
  void write_joints(int b) {
    std::string parent = links_[m_->body_parentid[b]];
    Pose X = pose_of(m_->body_pos + 3 * b, m_->body_quat + 4 * b);
    const int end = m_->body_jntadr[b] + m_->body_jntnum[b];
    for (int j = m_->body_jntadr[b]; j < end; ++j) {
      Pose after;
      if (m_->jnt_type[j] == mjJNT_HINGE || m_->jnt_type[j] == mjJNT_SLIDE) {
        const Eigen::Vector3d axis(m_->jnt_axis + 3 * j);
        const Eigen::Vector3d back = -m_->qpos0[m_->jnt_qposadr[j]] * axis;
        if (m_->jnt_type[j] == mjJNT_HINGE) {
          const Eigen::Vector3d anchor(m_->jnt_pos + 3 * j);
          X = X * Pose{anchor, rotation_exp(back)};
          after.p = -anchor;
        } else {
          X = X * Pose{back, Eigen::Matrix3d::Identity()};
        }
      }
      const bool last = j + 1 == end && is_identity(after);
      const std::string child = last ? links_[b] : unique(links_[b] + "_of_" + joint_name(j));
      write_joint(j, parent, child, X);
      if (!last) write_between(child, j + 1 < end);
      parent = child;
      X = after;
    }
    if (parent != links_[b]) write_fixed(parent, links_[b], X);
  }

  /// A link that no body stands for; it needs mass where a joint hangs on it.
  void write_between(const std::string& name, bool needs_mass) {
    out_.OpenElement("link");
    out_.PushAttribute("name", name.c_str());
    if (needs_mass) {
      write_inertial(Eigen::Vector3d::Zero(), kTinyMass,
                     kTinyInertia * Eigen::Matrix3d::Identity());
      between_.push_back(name);
    }
    out_.CloseElement();
  }

  void write_joint(int j, const std::string& parent, const std::string& child, const Pose& X) {
    const bool limited = m_->jnt_limited[j] != 0;
    const char* type = m_->jnt_type[j] == mjJNT_FREE    ? "floating"
                       : m_->jnt_type[j] == mjJNT_SLIDE ? "prismatic"
                       : limited                        ? "revolute"
                                                        : "continuous";
    open_joint(joint_name(j), type, parent, child, X);
    if (m_->jnt_type[j] != mjJNT_FREE) {
      element("axis", {{"xyz", numbers(Eigen::Vector3d(m_->jnt_axis + 3 * j))}});
      out_.OpenElement("limit");
      if (limited) {
        out_.PushAttribute("lower", number(m_->jnt_range[2 * j]).c_str());
        out_.PushAttribute("upper", number(m_->jnt_range[2 * j + 1]).c_str());
      }
      write_speed_and_effort(j);
      out_.CloseElement();
      const int dof = m_->jnt_dofadr[j];
      element("dynamics", {{"damping", number(m_->dof_damping[dof])},
                           {"friction", number(m_->dof_frictionloss[dof])}});
    }
    out_.CloseElement();
  }

  /// Both are demanded by the format. What the arm's limits are not known for gets the standard.
  void write_speed_and_effort(int j) {
    const JointType type = m_->jnt_type[j] == mjJNT_SLIDE ? JointType::slide : JointType::hinge;
    double velocity = standard_limits(type).velocity;
    double effort = standard_limits(type).torque;
    bool standard = true;
    for (int i = 0; i < arm_.dof(); ++i) {
      if (arm_.joints[i].dof != m_->jnt_dofadr[j]) continue;
      velocity = arm_.limits.velocity[i];
      effort = arm_.limits.torque[i];
      const LimitSources& from = arm_.limits.sources[i];
      standard = from.velocity == LimitSource::standard || from.torque == LimitSource::standard;
    }
    if (standard) standard_.push_back(joint_name(j));
    out_.PushAttribute("effort", number(effort).c_str());
    out_.PushAttribute("velocity", number(velocity).c_str());
  }

  void write_inertial(const Eigen::Vector3d& p, double mass, const Eigen::Matrix3d& I) {
    out_.OpenElement("inertial");
    write_origin({p, Eigen::Matrix3d::Identity()});
    element("mass", {{"value", number(mass)}});
    element("inertia", {{"ixx", number(I(0, 0))},
                        {"ixy", number(I(0, 1))},
                        {"ixz", number(I(0, 2))},
                        {"iyy", number(I(1, 1))},
                        {"iyz", number(I(1, 2))},
                        {"izz", number(I(2, 2))}});
    out_.CloseElement();
  }

  void write_link(int b) {
    out_.OpenElement("link");
    out_.PushAttribute("name", links_[b].c_str());
    if (b > 0 && m_->body_mass[b] > 0) {
      const Pose X = pose_of(m_->body_ipos + 3 * b, m_->body_iquat + 4 * b);
      const Eigen::Vector3d principal(m_->body_inertia + 3 * b);
      write_inertial(X.p, m_->body_mass[b], X.R * principal.asDiagonal() * X.R.transpose());
    }
    for (int g = m_->body_geomadr[b]; g < m_->body_geomadr[b] + m_->body_geomnum[b]; ++g) {
      const bool look = m_->geom_contype[g] == 0 && m_->geom_conaffinity[g] == 0;
      if (look || m_->geom_group[g] < 3) write_shape("visual", g);
      if (!look) write_shape("collision", g);
    }
    out_.CloseElement();
  }

  void write_shape(const char* kind, int g) {
    const mjtNum* size = m_->geom_size + 3 * g;
    Pose X = pose_of(m_->geom_pos + 3 * g, m_->geom_quat + 4 * g);
    const int type = m_->geom_type[g];
    const std::string mesh = type == mjGEOM_MESH ? mesh_file(m_->geom_dataid[g]) : "";
    const bool known = type == mjGEOM_SPHERE || type == mjGEOM_BOX || type == mjGEOM_CYLINDER ||
                       type == mjGEOM_CAPSULE || !mesh.empty();
    if (!known) {
      lost_shapes_.insert(g);
      return;
    }
    if (!mesh.empty()) {
      // The compiler moved the vertices into the mesh's own frame of inertia.
      const int id = m_->geom_dataid[g];
      const Pose moved = pose_of(m_->mesh_pos + 3 * id, m_->mesh_quat + 4 * id);
      X = X * Pose{-moved.R.transpose() * moved.p, moved.R.transpose()};
    }
    out_.OpenElement(kind);
    write_origin(X);
    out_.OpenElement("geometry");
    if (type == mjGEOM_SPHERE) element("sphere", {{"radius", number(size[0])}});
    if (type == mjGEOM_BOX) {
      element("box", {{"size", numbers({2 * size[0], 2 * size[1], 2 * size[2]})}});
    }
    if (type == mjGEOM_CYLINDER || type == mjGEOM_CAPSULE) {
      element(type == mjGEOM_CAPSULE ? "capsule" : "cylinder",
              {{"radius", number(size[0])}, {"length", number(2 * size[1])}});
    }
    if (!mesh.empty()) {
      const mjtNum* scale = m_->mesh_scale + 3 * m_->geom_dataid[g];
      element("mesh", {{"filename", mesh}, {"scale", numbers({scale[0], scale[1], scale[2]})}});
    }
    out_.CloseElement();
    if (std::string_view(kind) == "visual") write_colour(g);
    out_.CloseElement();
  }

  void write_colour(int g) {
    const int material = m_->geom_matid[g];
    const float* rgba = material >= 0 ? m_->mat_rgba + 4 * material : m_->geom_rgba + 4 * g;
    out_.OpenElement("material");
    out_.PushAttribute("name", ("colour_" + std::to_string(g)).c_str());
    std::string words;
    for (int i = 0; i < 4; ++i) words += (i > 0 ? " " : "") + number(rgba[i]);
    element("color", {{"rgba", words}});
    out_.CloseElement();
  }

  /// The file of a mesh as the URDF calls it; empty for a mesh that is written in the model itself.
  std::string mesh_file(int id) {
    if (id < 0 || m_->mesh_pathadr[id] < 0) return "";
    const fs::path path = m_->paths + m_->mesh_pathadr[id];
    const fs::path whole = fs::absolute(model_.file()).parent_path() / path;
    const std::string name = name_from(folder_, whole);
    files_stay_ = files_stay_ || fs::path(name).is_absolute();
    return name;
  }

  void write_site(int s) {
    const char* name = mj_id2name(m_, mjOBJ_SITE, s);
    if (name == nullptr) return;
    const std::string link = unique(name);
    write_fixed(links_[m_->site_bodyid[s]], link,
                pose_of(m_->site_pos + 3 * s, m_->site_quat + 4 * s));
    out_.OpenElement("link");
    out_.PushAttribute("name", link.c_str());
    out_.CloseElement();
  }

  void count_what_is_lost() {
    const auto lose = [&](const char* what, mjtSize count) {
      if (count > 0) lost_.push_back(what + (" " + std::to_string(count)));
    };
    mjtSize armature = 0, springs = 0, gravcomp = 0;
    for (int i = 0; i < m_->nv; ++i) armature += m_->dof_armature[i] != 0;
    for (int j = 0; j < m_->njnt; ++j) springs += m_->jnt_stiffness[j] != 0;
    for (int b = 0; b < m_->nbody; ++b) gravcomp += m_->body_gravcomp[b] != 0;
    if (model_.format() == ModelFormat::mjcf) lose("actuator", m_->nactuator);
    lose("tendon", m_->ntendon);
    lose("equality", m_->neq);
    lose("flex", m_->nflex);
    lose("skin", m_->nskin);
    lose("sensor", m_->nsensor);
    lose("camera", m_->ncam);
    lose("light", m_->nlight);
    lose("key", m_->nkey);
    lose("contact pair", m_->npair);
    lose("contact exclude", m_->nexclude);
    lose("geom", static_cast<mjtSize>(lost_shapes_.size()));
    lose("armature", armature);
    lose("stiffness", springs);
    lose("gravcomp", gravcomp);
    lose("mocap", m_->nmocap);
  }

  [[nodiscard]] std::vector<std::string> notes() const {
    std::vector<std::string> all;
    if (!lost_.empty()) all.push_back(text(msg::model_urdf_lost, listed(lost_)));
    if (!standard_.empty()) all.push_back(text(msg::model_urdf_standard, listed(standard_)));
    if (!between_.empty()) {
      all.push_back(text(msg::model_urdf_between, number(kTinyMass), listed(between_)));
    }
    if (!renamed_.empty()) all.push_back(text(msg::model_urdf_renamed, listed(renamed_)));
    if (files_stay_) all.push_back(text(msg::model_files_stay));
    return all;
  }

  const Model& model_;
  const mjModel* m_;
  fs::path folder_;
  Arm arm_;
  tinyxml2::XMLPrinter out_;
  std::set<std::string> link_names_;
  std::set<std::string> joint_names_;
  std::vector<std::string> links_;  ///< by body
  std::set<int> lost_shapes_;
  std::vector<std::string> lost_, standard_, between_, renamed_;
  bool files_stay_ = false;
};

}  // namespace

Result<Exported> export_urdf(const Model& model, const fs::path& folder) {
  return UrdfWriter(model, folder).write();
}

}  // namespace mjarm

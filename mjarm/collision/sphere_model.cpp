#include "mjarm/collision/sphere_model.hpp"

#include <algorithm>
#include <initializer_list>
#include <string_view>
#include <utility>
#include <variant>

#include "mjarm/core/messages/collision.hpp"
#include "mjarm/core/number.hpp"
#include "mjarm/core/rotation.hpp"

namespace mjarm {
namespace {

/// An attribute with its numbers: ` pos="1.0 2.0 3.0"`.
std::string attribute(std::string_view name, std::initializer_list<double> values) {
  std::string out = " " + std::string(name) + "=\"";
  for (const double value : values) {
    if (out.back() != '"') out += ' ';
    append_number(out, value);
  }
  return out + '"';
}

std::string position(const Eigen::Vector3d& p) { return attribute("pos", {p.x(), p.y(), p.z()}); }

std::string place(const Pose& X) {
  const Quat q = to_quat(X.R);
  return position(X.p) + attribute("quat", {q.w(), q.x(), q.y(), q.z()});
}

/// Type and size of a solid.
struct ShapeAttributes {
  std::string operator()(const BallShape& ball) const {
    return " type=\"sphere\"" + attribute("size", {ball.radius});
  }
  std::string operator()(const CapsuleShape& capsule) const {
    if (capsule.half_length == 0) return (*this)(BallShape{capsule.radius});
    return " type=\"capsule\"" + attribute("size", {capsule.radius, capsule.half_length});
  }
  std::string operator()(const BoxShape& box) const {
    return " type=\"box\"" + attribute("size", {box.half.x(), box.half.y(), box.half.z()});
  }
  std::string operator()(const CylinderShape& cylinder) const {
    return " type=\"cylinder\"" + attribute("size", {cylinder.radius, cylinder.half_length});
  }
  std::string operator()(const HalfSpaceShape&) const {
    return " type=\"plane\"" + attribute("size", {0, 0, 1});
  }
  template <class Shape>
  std::string operator()(const Shape&) const {
    return "";  // MuJoCo knows none that is exactly this
  }
};

std::string sphere_name(int link, std::size_t sphere) {
  return "s" + std::to_string(link) + "_" + std::to_string(sphere);
}

/// Sky and light of pictures. Two lights from different sides tell the faces of a box apart.
constexpr std::string_view kStudio = R"(
<visual><global fovy="42" offwidth="1920" offheight="1080"/>
<quality shadowsize="4096" offsamples="8" numslices="40" numstacks="24"/>
<headlight ambient="0.36 0.37 0.39" diffuse="0.30 0.30 0.30" specular="0.05 0.05 0.05"/>
<map znear="0.01" zfar="40" shadowclip="2"/></visual>
<asset><texture type="skybox" builtin="gradient" rgb1="0.80 0.85 0.90" rgb2="0.95 0.96 0.97"
 width="64" height="384"/></asset>)";
constexpr std::string_view kLights = R"(
<light type="directional" pos="0.6 -0.9 2.5" dir="-0.35 0.5 -0.9" diffuse="0.5 0.49 0.47"
 specular="0.1 0.1 0.1" castshadow="true"/>
<light type="directional" pos="-2 -1 2" dir="0.75 0.3 -0.5" diffuse="0.2 0.21 0.24"
 specular="0 0 0" castshadow="false"/>)";

constexpr double kSeeThrough = 0.3;  // how dense what hides something is

/// Colour of a solid in pictures: furniture is of boxes, what stands on it is round.
struct ShapeColor {
  double alpha = 1;
  std::string operator()(const BoxShape&) const {
    return attribute("rgba", {0.72, 0.60, 0.47, alpha});
  }
  std::string operator()(const HalfSpaceShape&) const {
    return attribute("rgba", {0.62, 0.65, 0.68, alpha});
  }
  template <class Shape>
  std::string operator()(const Shape&) const {
    return attribute("rgba", {0.45, 0.56, 0.60, alpha});
  }
};

/// Writes the model as MJCF.
class SphereModelWriter {
 public:
  SphereModelWriter(const Arm& arm, const SphereSet& set, const Obstacles& obstacles,
                    const SphereModelLook* look)
      : arm_(arm), set_(set), obstacles_(obstacles), look_(look) {}

  /// Names are numbered: those of links and obstacles need not differ.
  std::string write() {
    out_ = R"(<mujoco model="spheres"><compiler angle="radian"/>)";
    if (look_ != nullptr) out_ += kStudio;
    out_ += "<worldbody>";
    if (look_ != nullptr) out_ += kLights;
    write_obstacles();
    write_clouds();
    write_spheres(-1);
    write_chain(-1);
    for (int joint = 0; joint < arm_.dof(); ++joint) {
      write_joint(joint);
      write_spheres(joint);
      write_chain(joint);
    }
    for (int joint = 0; joint < arm_.dof(); ++joint) out_ += "</body>";
    out_ += "</worldbody>";
    if (look_ == nullptr) write_pairs();
    return out_ + "</mujoco>";
  }

  std::map<std::string, std::string>& parts() { return parts_; }

 private:
  void write_obstacles() {
    for (std::size_t i = 0; i < obstacles_.solids.size(); ++i) {
      const Obstacle& solid = obstacles_.solids[i];
      const std::string name = "o" + std::to_string(i);
      parts_[name] = solid.name.empty() ? std::to_string(i) : solid.name;
      out_ += "<geom name=\"" + name + "\"" + collides(0, 1) + place(solid.X_WO) +
              std::visit(ShapeAttributes(), solid.shape) + color_of(i) + "/>";
    }
  }

  [[nodiscard]] std::string color_of(std::size_t solid) const {
    if (look_ == nullptr) return "";
    const bool hides = std::ranges::count(look_->see_through, static_cast<int>(solid)) > 0;
    return std::visit(ShapeColor{hides ? kSeeThrough : 1.0}, obstacles_.solids[solid].shape);
  }

  void write_clouds() {
    for (std::size_t i = 0; i < obstacles_.clouds.size(); ++i) {
      const PointCloud& cloud = obstacles_.clouds[i];
      const int index = static_cast<int>(obstacles_.solids.size() + i);
      for (std::size_t k = 0; k < cloud.points_W.size(); ++k) {
        const std::string name = "c" + std::to_string(i) + "_" + std::to_string(k);
        parts_[name] = cloud.name.empty() ? std::to_string(index) : cloud.name;
        out_ += "<geom name=\"" + name + "\"" + collides(0, 1) + position(cloud.points_W[k]) +
                ShapeAttributes()(BallShape{cloud.radius}) +
                (look_ != nullptr ? ShapeColor()(BallShape()) : "") + "/>";
      }
    }
  }

  /// Masses mean nothing here, but a body that moves must have one.
  void write_joint(int index) {
    const ArmJoint& joint = arm_.joints[static_cast<std::size_t>(index)];
    const Eigen::Vector3d& axis = joint.axis;
    out_ += "<body" + place(joint.X_PJ) +
            R"(><inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/><joint type=")" +
            (joint.type == JointType::slide ? "slide\"" : "hinge\"") +
            attribute("axis", {axis.x(), axis.y(), axis.z()}) + "/>";
  }

  void write_spheres(int joint) {
    for (int i = 0; i < static_cast<int>(set_.links.size()); ++i) {
      const LinkSpheres& link = set_.links[static_cast<std::size_t>(i)];
      if (link.joint != joint) continue;
      for (std::size_t k = 0; k < link.spheres.size(); ++k) {
        const std::string name = sphere_name(i, k);
        parts_[name] = link.name;
        out_ += "<geom name=\"" + name + "\"" + collides(1, 0) +
                (look_ != nullptr ? R"( group="3")" : "") + position(link.spheres[k].center) +
                ShapeAttributes()(BallShape{link.spheres[k].radius}) + "/>";
      }
    }
  }

  [[nodiscard]] std::string collides(int type, int affinity) const {
    if (look_ != nullptr) return R"( contype="0" conaffinity="0")";
    return " contype=\"" + std::to_string(type) + "\" conaffinity=\"" + std::to_string(affinity) +
           "\"";
  }

  /// A rod from a joint (-1: from where the arm stands) to the next one or to the tool.
  void write_chain(int joint) {
    if (look_ == nullptr) return;
    const bool last = joint + 1 == arm_.dof();
    const Eigen::Vector3d end =
        last ? arm_.X_JT.p : arm_.joints[static_cast<std::size_t>(joint + 1)].X_PJ.p;
    constexpr double kShortest = 1e-3;  // [m]
    if (!(end.norm() > kShortest)) return;
    out_ +=
        R"(<geom type="capsule" contype="0" conaffinity="0" group="1" rgba="0.22 0.26 0.32 1")" +
        attribute("fromto", {0, 0, 0, end.x(), end.y(), end.z()}) +
        attribute("size", {last ? 0.012 : 0.018}) + "/>";
  }

  void write_pairs() {
    out_ += "<contact>";
    for (const auto& [a, b] : set_.pairs) {
      for (std::size_t k = 0; k < set_.links[static_cast<std::size_t>(a)].spheres.size(); ++k) {
        for (std::size_t l = 0; l < set_.links[static_cast<std::size_t>(b)].spheres.size(); ++l) {
          out_ += "<pair geom1=\"" + sphere_name(a, k) + "\" geom2=\"" + sphere_name(b, l) + "\"/>";
        }
      }
    }
    out_ += "</contact>";
  }

  const Arm& arm_;
  const SphereSet& set_;
  const Obstacles& obstacles_;
  const SphereModelLook* look_;  // null: for checks
  std::string out_;
  std::map<std::string, std::string> parts_;
};

}  // namespace

Result<SphereModel> sphere_model(const Arm& arm, const SphereSet& set, const Obstacles& obstacles,
                                 const SphereModelLook* look) {
  if (auto fits = check_sphere_set(set, arm); !fits) return fail(std::move(fits.error()));
  if (auto fits = check_obstacles(obstacles); !fits) return fail(std::move(fits.error()));
  for (const Obstacle& solid : obstacles.solids) {
    if (!std::visit(ShapeAttributes(), solid.shape).empty()) continue;
    return fail(Errc::not_available, text(msg::collision_no_geom, solid.name));
  }
  SphereModelWriter writer(arm, set, obstacles, look);
  Result<Model> model = Model::from_mjcf(writer.write());
  if (!model) return fail(std::move(model.error()));
  SphereModel out{std::move(*model), arm, std::move(writer.parts())};
  for (std::size_t i = 0; i < out.arm.joints.size(); ++i) {
    out.arm.joints[i].qpos = static_cast<int>(i);
    out.arm.joints[i].dof = static_cast<int>(i);
  }
  return out;
}

}  // namespace mjarm

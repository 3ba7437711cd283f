#include "mjarm/collision/sphere_model.hpp"

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

/// Writes the model as MJCF.
class SphereModelWriter {
 public:
  SphereModelWriter(const Arm& arm, const SphereSet& set, const Obstacles& obstacles)
      : arm_(arm), set_(set), obstacles_(obstacles) {}

  /// Names are numbered: those of links and obstacles need not differ.
  std::string write() {
    out_ = R"(<mujoco model="spheres"><compiler angle="radian"/><worldbody>)";
    write_obstacles();
    write_clouds();
    write_spheres(-1);
    for (int joint = 0; joint < arm_.dof(); ++joint) {
      write_joint(joint);
      write_spheres(joint);
    }
    for (int joint = 0; joint < arm_.dof(); ++joint) out_ += "</body>";
    out_ += "</worldbody>";
    write_pairs();
    return out_ + "</mujoco>";
  }

  std::map<std::string, std::string>& parts() { return parts_; }

 private:
  void write_obstacles() {
    for (std::size_t i = 0; i < obstacles_.solids.size(); ++i) {
      const Obstacle& solid = obstacles_.solids[i];
      const std::string name = "o" + std::to_string(i);
      parts_[name] = solid.name.empty() ? std::to_string(i) : solid.name;
      out_ += "<geom name=\"" + name + R"(" contype="0" conaffinity="1")" + place(solid.X_WO) +
              std::visit(ShapeAttributes(), solid.shape) + "/>";
    }
  }

  void write_clouds() {
    for (std::size_t i = 0; i < obstacles_.clouds.size(); ++i) {
      const PointCloud& cloud = obstacles_.clouds[i];
      const int index = static_cast<int>(obstacles_.solids.size() + i);
      for (std::size_t k = 0; k < cloud.points_W.size(); ++k) {
        const std::string name = "c" + std::to_string(i) + "_" + std::to_string(k);
        parts_[name] = cloud.name.empty() ? std::to_string(index) : cloud.name;
        out_ += "<geom name=\"" + name + R"(" contype="0" conaffinity="1")" +
                position(cloud.points_W[k]) + ShapeAttributes()(BallShape{cloud.radius}) + "/>";
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
        out_ += "<geom name=\"" + name + R"(" contype="1" conaffinity="0")" +
                position(link.spheres[k].center) +
                ShapeAttributes()(BallShape{link.spheres[k].radius}) + "/>";
      }
    }
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
  std::string out_;
  std::map<std::string, std::string> parts_;
};

}  // namespace

Result<SphereModel> sphere_model(const Arm& arm, const SphereSet& set, const Obstacles& obstacles) {
  if (auto fits = check_sphere_set(set, arm); !fits) return fail(std::move(fits.error()));
  if (auto fits = check_obstacles(obstacles); !fits) return fail(std::move(fits.error()));
  for (const Obstacle& solid : obstacles.solids) {
    if (!std::visit(ShapeAttributes(), solid.shape).empty()) continue;
    return fail(Errc::not_available, text(msg::collision_no_geom, solid.name));
  }
  SphereModelWriter writer(arm, set, obstacles);
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

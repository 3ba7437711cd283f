#pragma once

#include <mujoco/mujoco.h>

#include <array>
#include <string>
#include <vector>

#include "mjarm/collision/contact_rules.hpp"
#include "mjarm/model/arm.hpp"

namespace mjarm::detail {

/// Which bodies of a model an arm moves, those it holds included.
struct ArmBodies {
  /// @param attached  sound by check_contact_rules().
  ArmBodies(const mjModel& m, const Arm& arm, const std::vector<AttachedBody>& attached = {});

  /// Writes where the attached bodies are to the model's qpos.
  void place_attached(const Pose& X_WT, mjtNum* qpos) const;

  /// A free body that hangs on the tool.
  struct Attached {
    int address = 0;  ///< of its free joint in qpos
    Pose X_TB;
  };
  std::vector<int> addresses;  ///< of the arm's joints in qpos
  std::vector<int> bodies;     ///< that these joints are of
  std::vector<Attached> attached;
  std::vector<int> pieces;    ///< per body: how many joints of the arm move it
  std::vector<bool> carried;  ///< per body: it is attached, or hangs on what is
  bool matches = true;        ///< the arm is one of this model
};

/// Pairs of geoms that ContactRules let touch, and those that overlap by design.
class ContactFilter {
 public:
  ContactFilter(const mjModel& m, const Arm& arm, const ContactRules& rules);
  [[nodiscard]] bool may_touch(int geom1, int geom2) const;

 private:
  std::vector<std::array<std::vector<bool>, 2>> pairs_;  // per geom
};

/// home_configuration() to be changed; shape (nq,).
[[nodiscard]] std::vector<double> rest_configuration(const mjModel& m);

/// Name of a geom; BODY[k], the k-th (from 0) of its body, where it has none.
[[nodiscard]] std::string geom_name(const mjModel& m, int geom);
/// Name of a body; `#7`, its number, where it has none.
[[nodiscard]] std::string body_name(const mjModel& m, int body);
/// The body of that name; -1 where there is none.
[[nodiscard]] int find_body(const mjModel& m, const std::string& name);

}  // namespace mjarm::detail

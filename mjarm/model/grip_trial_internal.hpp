#pragma once

#include <mujoco/mujoco.h>

#include <memory>
#include <optional>
#include <vector>

#include "mjarm/core/result.hpp"
#include "mjarm/model/arm.hpp"
#include "mjarm/model/arm_parts_internal.hpp"
#include "mjarm/model/grip_check.hpp"
#include "mjarm/model/jaws.hpp"
#include "mjarm/model/load_internal.hpp"
#include "mjarm/model/model.hpp"

/// A cube held by a gripper, simulated.
namespace mjarm::detail {

/// The cube that a gripper is tried on: half as wide as the open jaws, of at most 60 mm [m].
[[nodiscard]] double trial_edge(const Jaws& jaws);
inline constexpr double kTrialMass = 0.1;  ///< [kg]

/// Another compiled copy of `model` with a free cube, its last body and geom. Its contacts are
/// MuJoCo's defaults, whatever the file has for its own, and everything collides with it.
/// @param edge  [m]
[[nodiscard]] Result<MjModelPtr> with_trial_cube(const Model& model, double edge,
                                                 const LoadOptions& options);

/// Parts of a hand that overlap where the cube alone should be between them.
struct JawOverlap {
  int geom[2] = {-1, -1};  ///< the second one -1: a hull that reaches to where the cube will be
  double depth = 0;        ///< [m]
  bool closing = false;  ///< the fingers have come up to the cube, or have been stopped on the way
};

/// What came of closing a gripper on the cube.
struct GripOutcome {
  bool touched = false;              ///< both sides have come to touch it
  bool held = false;                 ///< the cube is between two parts of the hand
  bool lost = false;                 ///< it was, and has left them
  double closing_time = 0;           ///< [s] from the command until both sides touch
  double creep = 0;                  ///< [m/s] along gravity, relative to the hand
  std::vector<int> pads;             ///< geoms of the fingers that touch it, ascending
  std::vector<JawOverlap> overlaps;  ///< that keep it from being held, or take part of the force
};

/// Closes a gripper on a cube while stiff springs hold the arm at home. Gravity points out of the
/// hand, along its approach, and acts on the cube alone, so that one measure serves every posture.
class GripTrial {
 public:
  /// @param m  made by `with_trial_cube` of the model of `arm`; must outlive this.
  GripTrial(const mjModel& m, const Model& model, const Arm& arm, const Jaws& jaws);

  /// False where the fingers do not come to rest open.
  [[nodiscard]] bool opens() const { return opens_; }
  [[nodiscard]] const std::vector<JawOverlap>& overlaps() const { return overlaps_; }

  /// The same steps for the same `mend`. Nothing held where MuJoCo gives up.
  [[nodiscard]] GripOutcome run(const GripMend& mend) const;

  /// Joints of the hand, hinges and slides.
  [[nodiscard]] const std::vector<int>& hand_joints() const { return hand_joints_; }
  /// Geoms that these move and that collide.
  [[nodiscard]] std::vector<int> finger_geoms() const;

 private:
  /// A copy in which only the hand and the cube move and collide.
  [[nodiscard]] MjModelPtr hand_alone(const GripMend& mend) const;
  void open();
  void place_cube(const mjModel& m);
  void look_for_overlaps();
  void note_stops(const mjData* d, GripOutcome& out) const;
  [[nodiscard]] std::vector<JawOverlap> overlaps_in(const mjData* d, double deeper) const;
  void step(const mjModel& m, mjData* d, double seconds) const;
  bool rest(const mjModel& m, mjData* d, double seconds) const;
  bool close(const mjModel& m, mjData* d, GripOutcome& out) const;
  [[nodiscard]] bool is_held(const mjModel& m, const mjData* d, std::vector<int>* pads) const;
  [[nodiscard]] double cube_along(const mjData* d) const;
  double creep(const mjModel& m, mjData* d) const;

  const mjModel& source_;
  Gripper gripper_;
  Jaws jaws_;
  TipFrame tip_;
  Pose X_WT_;  ///< at rest
  int cube_body_ = -1, cube_geom_ = -1, cube_qpos_ = -1;
  std::vector<char> hand_;        ///< per body
  std::vector<char> spring_dof_;  ///< per degree of freedom: of the arm and the scene
  std::vector<int> hand_joints_;
  std::vector<double> open_qpos_, open_act_;
  bool opens_ = false;
  std::vector<JawOverlap> overlaps_;
};

}  // namespace mjarm::detail

#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "mjarm/core/result.hpp"
#include "mjarm/model/robot.hpp"
#include "mjarm/perception/find_objects.hpp"
#include "mjarm/program/program_plan.hpp"

namespace mjarm::session {

/// What the camera of a SceneEye is like. Every default is usable as is.
struct SceneEyeOptions {
  double depth_sigma = 0.001;  ///< [m] as RgbdOptions has it, >= 0
  std::uint64_t seed = 1;      ///< of depth's noise
};

/// A camera of a robot's scene that finds the objects in it (the bodies that can be carried), so
/// that what is planned begins from what was seen. Used by one thread at a time.
class SceneEye {
 public:
  /// @param camera  of the model.
  /// @return bad_input with the nearest name, or where there is no object; fails as RgbdCamera and
  ///         ObjectFinder do.
  [[nodiscard]] static Result<SceneEye> open(const Robot& robot, const std::string& camera,
                                             const SceneEyeOptions& options = {});
  ~SceneEye();
  SceneEye(SceneEye&&) noexcept;
  SceneEye& operator=(SceneEye&&) noexcept;

  /// Draws `scene` and finds the objects in it. Those that look alike are one kind: a piece that is
  /// seen gets the name of the body that truly stands nearest, so that it is the simulation's own
  /// and stays from look to look. Those without a pose stand where they seem to be (where they were
  /// seen before, if that is near), else where they were last seen (before that, where the model
  /// has them), and nowhere (far below) where the camera sees that they do not.
  /// @param scene  how things truly stand, the fingers included; nothing attached is looked for.
  /// @param q      (dof,) [rad or m] where the arm stands.
  [[nodiscard]] Result<program::SeenScene> look(const SceneState& scene, std::span<const double> q);
  /// What the last look told, whole.
  [[nodiscard]] const perception::FoundScene& found() const;

 private:
  struct Impl;
  explicit SceneEye(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// One look with a SceneEye: does the instruction `look` of motion programs.
[[nodiscard]] Result<program::SeenScene> see_scene(const Robot& robot, const std::string& camera,
                                                   const SceneState& scene,
                                                   std::span<const double> q);

}  // namespace mjarm::session

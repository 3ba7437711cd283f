#pragma once

#include <memory>

#include "mjarm/core/result.hpp"
#include "mjarm/model/model.hpp"
#include "mjarm/render/camera.hpp"
#include "mjarm/render/overlay.hpp"
#include "mjarm/sim/sim.hpp"

struct mjData_;
struct mjvCamera_;
struct mjvOption_;
struct mjvPerturb_;
struct mjvScene_;

namespace mjarm::render {

/// How much work goes into a picture.
enum class RenderQuality {
  low,     ///< no shadows, reflections or smoothing: for many frames without a GPU
  medium,  ///< shadows; no reflections or smoothing
  high,    ///< shadows, reflections (with a GPU), 8 samples a pixel as far as OpenGL has them
  exact,   ///< as `low`, with round shapes in 128 faces around, so that depth is right to 1e-4 m
};

/// What is to be seen: a model in some state, an overlay and a camera, without any OpenGL. Shared
/// by pictures and windows; owns its copy of the simulated state.
class Scene {
 public:
  /// @param software  pictures are computed by the processor: round shapes get fewer faces, and the
  ///                  faint reflections, which double the work, are left out.
  Scene(const Model& model, RenderQuality quality, bool software = false);
  ~Scene();
  Scene(Scene&&) noexcept;
  Scene& operator=(Scene&&) noexcept;

  /// Puts the model into a state; one without numbers leaves it as it starts.
  /// @return bad_input where the snapshot belongs to another model.
  [[nodiscard]] Result<void> set_state(const Snapshot& snapshot);
  /// Chooses the camera; fails as `check_camera` does.
  [[nodiscard]] Result<void> set_camera(const Camera& camera);
  /// Where the camera stands. For a camera of the model: the same line of sight, about the point
  /// nearest to the middle of the model.
  [[nodiscard]] CameraView view() const;
  /// Rebuilds the list of what is drawn.
  void update(const Overlay& overlay);
  /// [m] Half the width of a shadow map that holds all shadows of directional lights, as of the
  /// last `update`. A map that is smaller than the model asks for stays sharp by it: its grid is
  /// never finer, and it never reaches farther, than the model's own.
  [[nodiscard]] double shadow_reach() const;

  /// Also computes contacts and forces from now on, which drawing them and picking need; this takes
  /// about as long as a step of the simulation. Off at first.
  void set_dynamics(bool on);
  /// Draws only the geoms that take part in collisions, of all groups. Off at first.
  void set_only_colliding(bool on) noexcept;

  /// For those who may include mujoco.h: the model with the quality set, the copy of the state,
  /// what is drawn of it, camera, what is selected and pushed, and scene.
  [[nodiscard]] const mjModel_& model() const noexcept;
  [[nodiscard]] mjData_& data() noexcept;
  [[nodiscard]] mjvOption_& option() noexcept;
  [[nodiscard]] mjvCamera_& camera() noexcept;
  [[nodiscard]] mjvPerturb_& perturb() noexcept;
  [[nodiscard]] mjvScene_& raw() noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace mjarm::render

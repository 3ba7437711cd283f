#pragma once

#include <string>
#include <vector>

#include "mjarm/core/messages.hpp"
#include "mjarm/model/drawn_model.hpp"
#include "mjarm/render/camera.hpp"

namespace mjarm::serve {

/// What a page shows besides the model, and what the application lets the user do.
struct SceneFacts {
  std::string title = {};  ///< of the page
  std::string name = {};   ///< of the model
  Language language = Language::english;
  render::CameraView view = {};    ///< where the page looks from at first
  int nq = 0;                      ///< size of qpos
  bool can_step = true;            ///< the application follows StepEvent
  bool can_reset = true;           ///< ... and ResetEvent
  bool can_push = true;            ///< ... and PushEvent
  bool can_target = false;         ///< ... and TargetEvent and drags of the target
  bool can_lead = false;           ///< ... and LeadEvent
  bool turns = true;               ///< the target has rings
  std::vector<int> jog_dofs = {};  ///< ... and JointEvent of these dofs
};

/// The sliders of a page: the joints of `model` at `facts.jog_dofs`, in the order of the model.
[[nodiscard]] std::vector<DrawnJoint> slider_joints(const DrawnModel& model,
                                                    const SceneFacts& facts);

/// The text of scene.json: all of a scene that does not change. Bodies, geoms and joints have the
/// numbers that messages of a page name them by; a geom that is named is its place in the list.
[[nodiscard]] std::string scene_json(const DrawnModel& model, const SceneFacts& facts);

/// A mesh as a page reads it: u32 vertices n, u32 triangles m, f32 xyz[3n], u32 corner[3m], little
/// endian.
[[nodiscard]] std::string mesh_bytes(const DrawnMesh& mesh);

}  // namespace mjarm::serve

#pragma once

#include <mujoco/mujoco.h>

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "mjarm/core/result.hpp"
#include "mjarm/model/model.hpp"

namespace tinyxml2 {
class XMLDocument;
}  // namespace tinyxml2

namespace mjarm {

struct DeleteMjModel {
  void operator()(mjModel* model) const { mj_deleteModel(model); }
};
struct DeleteMjSpec {
  void operator()(mjSpec* spec) const { mj_deleteSpec(spec); }
};
using MjModelPtr = std::unique_ptr<mjModel, DeleteMjModel>;
using MjSpecPtr = std::unique_ptr<mjSpec, DeleteMjSpec>;

/// What comes out of a file.
struct LoadedModel {
  MjSpecPtr spec;  ///< what `model` was compiled from
  MjModelPtr model;
  std::map<std::string, double, std::less<>> velocity_limits;  ///< URDF, by joint [rad/s or m/s]
  std::map<std::string, double, std::less<>> effort_limits;    ///< URDF, by joint [N m or N]
  std::vector<std::string> warnings;
};

/// A description before it is compiled.
struct SpecSource {
  std::filesystem::path file;         ///< as the user named it, for messages
  const std::string* text = nullptr;  ///< what to parse instead of the file; null = the file itself
};

/// Parses and compiles; MuJoCo's complaint becomes one line `FILE:LINE: <element>: what`.
/// @param prepare  changes the description between the two steps; may be null.
[[nodiscard]] Result<LoadedModel> compile_spec(const SpecSource& source, void (*prepare)(mjSpec*));

/// Gives every hinge and slide a motor of its name: ctrl = torque [N m or N], bounded by the
/// joint's own effort limit. A URDF has no actuators, and nothing moves an arm past its actuators.
void add_motors(mjSpec* spec);

/// Neighbouring shapes of a URDF overlap where they are joined, and convex hulls of meshes more so.
/// Links that touch in every one of many postures within the limits do not collide: the pairs are
/// excluded from contact, `loaded` is compiled again, and a warning names them.
[[nodiscard]] Result<void> leave_out_touching(const std::filesystem::path& file,
                                              LoadedModel& loaded);

/// Loads a description whose root element is `robot`; changes `document`.
[[nodiscard]] Result<LoadedModel> load_urdf(const std::filesystem::path& file,
                                            tinyxml2::XMLDocument& document,
                                            const LoadOptions& options);

}  // namespace mjarm

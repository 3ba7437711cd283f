#pragma once

#include <mujoco/mujoco.h>

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mjarm/core/result.hpp"
#include "mjarm/model/model.hpp"
#include "mjarm/model/xml_sources_internal.hpp"

namespace mjarm {

struct DeleteMjModel {
  void operator()(mjModel* model) const { mj_deleteModel(model); }
};
struct DeleteMjData {
  void operator()(mjData* data) const { mj_deleteData(data); }
};
struct DeleteMjSpec {
  void operator()(mjSpec* spec) const { mj_deleteSpec(spec); }
};
using MjModelPtr = std::unique_ptr<mjModel, DeleteMjModel>;
using MjDataPtr = std::unique_ptr<mjData, DeleteMjData>;
using MjSpecPtr = std::unique_ptr<mjSpec, DeleteMjSpec>;

/// What comes out of a file.
struct LoadedModel {
  MjModelPtr model;
  std::map<std::string, double, std::less<>> velocity_limits;  ///< URDF, by joint [rad/s or m/s]
  std::map<std::string, double, std::less<>> effort_limits;    ///< URDF, by joint [N m or N]
  std::vector<std::string> warnings;
  std::vector<std::string> read_files;  ///< names, without folder, of meshes and textures in use
  std::string urdf_text;                ///< what MuJoCo was given in place of a URDF
};

/// A description before it is compiled, which has passed `preflight`.
struct SpecSource {
  const XmlSources& files;            ///< as the user named them, for messages
  const std::string* text = nullptr;  ///< what to parse instead of the file; null = the file itself
  bool trusted = false;               ///< compile in this process
  std::function<void(mjSpec*)> prepare = {};  ///< changes the description before it is compiled
  bool looks = true;                          ///< as LoadOptions::looks

  [[nodiscard]] const std::string& name() const { return files.documents().front()->name; }
};

/// How far MuJoCo has come with a description.
enum class Stage : char { reading = 'r', compiling = 'c', stepping = 's' };

/// Names of pairs of bodies.
using BodyPairs = std::vector<std::pair<std::string, std::string>>;

/// Adds to a parsed URDF what MuJoCo does not take from it by itself: groups of geoms, light and
/// sky, and a motor of its name for every hinge and slide (ctrl = torque [N m or N], bounded by the
/// joint's own effort limit; a URDF has no actuators, and nothing moves an arm past its actuators).
/// @param apart  bodies that shall not collide.
void finish_urdf(mjSpec* spec, const BodyPairs& apart);

/// Parses, compiles and simulates one step; MuJoCo's complaint becomes one line
/// `FILE:LINE: <element>: what`. What is not trusted is compiled in a process of its own.
[[nodiscard]] Result<LoadedModel> compile_spec(const SpecSource& source);

/// The same in this process, whatever `source.trusted` says.
/// @param enter  called at the start of every stage; may be null.
[[nodiscard]] Result<LoadedModel> compile_here(const SpecSource& source,
                                               const std::function<void(Stage)>& enter);

/// Compiles MJCF that names no other file and that a program of ours has written, in this process.
[[nodiscard]] Result<LoadedModel> compile_text(const std::string& mjcf);

/// Loads a description whose root element is `robot`.
[[nodiscard]] Result<LoadedModel> load_urdf(const XmlSources& files, const LoadOptions& options);

/// True for files in the folders of shipped models, which need no guard.
[[nodiscard]] bool is_shipped(const std::filesystem::path& file);

/// A shipped file that an include of somebody's scene means: `universal_robots_ur5e/ur5e.xml`, with
/// or without `..` at its front, as the shipped scenes write it. None where there is no such file.
[[nodiscard]] std::optional<std::filesystem::path> find_shipped_include(
    const std::filesystem::path& name);

}  // namespace mjarm

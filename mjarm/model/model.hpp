#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "mjarm/core/result.hpp"

struct mjModel_;

namespace mjarm {

/// How to read a model file.
struct LoadOptions {
  /// Where `package://NAME` is looked for first.
  std::vector<std::filesystem::path> package_paths = {};
  /// Read meshes, textures and includes outside of the folder of the model (for a URDF: of its ROS
  /// packages) as well.
  bool allow_outside = false;
  /// Compile in this process. Files of others are compiled in a copy of it (fork) with bounds on
  /// time and memory, since MuJoCo may crash or hang on them; shipped models are trusted anyway.
  bool trusted = false;
  /// Keep what is only seen: geoms that collide with nothing, their meshes, materials and textures.
  /// A big file loads in a fraction of the time without; masses and all else stay.
  bool looks = true;
};

/// What of a model's physics is other than its file has it; what is not set stays.
struct PhysicsChange {
  std::optional<double> timestep = {};  ///< [s] > 0
  std::optional<double> friction = {};  ///< factor on all coefficients of friction, >= 0
};

/// Format of the file a model came from.
enum class ModelFormat { mjcf, urdf };

/// A compiled robot or scene; immutable and cheap to copy (copies share one compiled model), so it
/// may be used from many threads at once. Scratch memory belongs to the callers (Dynamics, Sim).
class Model {
 public:
  /// Loads MJCF or URDF (told apart by the root element). Meshes are looked for beside the file,
  /// `package://` in `options.package_paths`, ROS_PACKAGE_PATH, AMENT_PREFIX_PATH, then upwards
  /// from the file. A URDF keeps its fixed frames, and every joint of it gets a motor of the same
  /// name that is as strong as its effort limit. May be called from many threads at once.
  /// @return one line that names file and element. Never throws, never ends the process.
  [[nodiscard]] static Result<Model> load(const std::filesystem::path& file,
                                          const LoadOptions& options = {});

  /// A model that a program has written itself, as MJCF; it may name no other file.
  /// @return MuJoCo's complaint in one line. Never throws, never ends the process.
  [[nodiscard]] static Result<Model> from_mjcf(const std::string& text);

  /// A model that somebody else has compiled: a copy, so that it may change or end afterwards.
  /// @param model  not null; of the MuJoCo library that this process runs with.
  [[nodiscard]] static Model copy_of(const mjModel_* model);

  /// The same robot with a point mass at the origin of a frame (site or body): a load that the
  /// unchanged model does not know.
  /// @param mass  [kg] > 0
  /// @return an error for a frame that is none, with the nearest name, or is the world's.
  [[nodiscard]] Result<Model> with_point_mass(std::string_view frame, double mass) const;

  /// The same robot or scene in other physics.
  /// @return bad_input that names what is out of its range.
  [[nodiscard]] Result<Model> with_physics(const PhysicsChange& change) const;

  [[nodiscard]] const std::filesystem::path& file() const noexcept;
  [[nodiscard]] ModelFormat format() const noexcept;
  [[nodiscard]] std::string_view name() const noexcept;          ///< model name inside the file
  [[nodiscard]] double timestep() const noexcept;                ///< [s]
  [[nodiscard]] int nq() const noexcept;                         ///< size of qpos
  [[nodiscard]] int nv() const noexcept;                         ///< size of qvel
  [[nodiscard]] int nu() const noexcept;                         ///< size of ctrl
  [[nodiscard]] std::span<const double> qpos0() const noexcept;  ///< shape (nq,)

  /// Velocity limit of a joint as the URDF gives it [rad/s or m/s]; 0 where the file has none (MJCF
  /// has no such field).
  [[nodiscard]] double urdf_velocity_limit(std::string_view joint) const noexcept;
  /// Effort limit of a joint as the URDF gives it [N m or N]; 0 where the file has none.
  [[nodiscard]] double urdf_effort_limit(std::string_view joint) const noexcept;

  /// What was odd about the file though it loads (a mesh format that cannot be shown, a link
  /// without inertia): one line each, in the language of the time of loading.
  [[nodiscard]] std::span<const std::string> warnings() const noexcept;

  /// The compiled MuJoCo model, for the rooms that may include mujoco.h; never null.
  [[nodiscard]] const mjModel_* raw() const noexcept;
  /// The URDF as MuJoCo was given it (meshes by absolute path, odd values mended); empty for MJCF.
  [[nodiscard]] const std::string& urdf_text() const noexcept;

 private:
  struct Impl;
  explicit Model(std::shared_ptr<const Impl> impl);
  [[nodiscard]] static Result<Model> load_guarded(const std::filesystem::path& file,
                                                  LoadOptions options);
  [[nodiscard]] std::shared_ptr<Impl> own_copy() const;
  std::shared_ptr<const Impl> impl_;
};

/// Finds a model by name (`ur5e`, `panda`, ...: the shipped scene) or by path. Shipped models are
/// looked for in the folder that MJARM_MODELS in the environment names, in
/// `../share/mjarm/models` and in `models` beside the program.
/// @return the path of the file, or an error with the nearest known name.
[[nodiscard]] Result<std::filesystem::path> find_model_file(std::string_view name_or_path);

/// A model that comes with mjarm.
struct ShippedModel {
  std::string name;            ///< what a user calls it: `ur5e`, `panda`, `car`, ...
  std::filesystem::path file;  ///< absolute path of its scene
};
/// The shipped models that are found on this machine, sorted by name.
[[nodiscard]] std::vector<ShippedModel> shipped_models();

}  // namespace mjarm

#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "mjarm/core/pose.hpp"
#include "mjarm/core/result.hpp"
#include "mjarm/model/model.hpp"
#include "mjarm/model/surface.hpp"
#include "mjarm/perception/find_errc.hpp"
#include "mjarm/perception/plane.hpp"
#include "mjarm/render/rgbd_frame.hpp"

namespace mjarm::perception {

/// A tag on an object.
struct ObjectTag {
  int id = 0;       ///< of the family tag36h11, 0 to 586
  double size = 0;  ///< [m] edge of the black square, > 0
  Pose X_OT = {};   ///< the tag on the object, as tag_corners() has its frame
};

/// An object that may be there.
struct KnownObject {
  std::string name = {};
  Surface surface = {};               ///< in its frame O; 5 mm to 5 m across
  std::optional<ObjectTag> tag = {};  ///< without one it is known by its shape
  /// Objects of one kind are as good as each other: they have one surface, and no tag. Empty: there
  /// is none like it.
  std::string kind = {};
};

/// A body of a model as an object: its frame is the body's, its name the body's.
/// @return fails as body_surface().
[[nodiscard]] Result<KnownObject> known_object(const Model& model, std::string_view body);

/// What is known of the scene. Every default is usable as is.
struct FindOptions {
  std::optional<Plane> table = {};  ///< on which things stand; else the largest level plane
  double depth_sigma = 0.001;       ///< [m] standard deviation of depth 0.5 m away, >= 0
  std::uint64_t seed = 1;           ///< of the search for the table
  bool unknown = true;              ///< also measure what is none of the objects
};

/// Where an object is.
struct FoundPose {
  Pose X_WO = {};  ///< the object in the world; up to its shape's symmetry without a tag
  bool by_tag = false;
  double seen = 0;         ///< share of what it would show that is seen
  double residual = 0;     ///< [m] root mean square of depth there
  double uncertainty = 0;  ///< [m] standard deviation of its surface in the least certain direction
};
/// Why it has no pose, and the best one there was.
struct FindFailure {
  FindErrc code = FindErrc::not_seen;
  std::optional<FoundPose> best = {};
};
/// One of the objects asked for, with its pose or the reason why it has none.
struct FoundObject {
  std::string name;
  Result<FoundPose, FindFailure> pose;
};

/// Something that is none of the objects: the upright box or cylinder that explains it best.
struct UnknownObject {
  enum class Kind { box, cylinder } kind = Kind::box;
  Pose X_WO = {};                                  ///< its middle; z away from the table
  Eigen::Vector3d size = Eigen::Vector3d::Zero();  ///< [m] edges; diameter twice, then height
};

/// Everything one look tells.
struct FoundScene {
  std::optional<Plane> table = {};
  std::vector<FoundObject> objects = {};    ///< one each known object, in their order
  std::vector<UnknownObject> unknown = {};  ///< from the largest in the picture down
};

/// Finds known objects in what an RGB-D camera sees: by their tags, else by their shapes. An object
/// either has a pose with which the whole picture agrees, or a reason why not. Of one kind as many
/// are found as are seen, each piece under one name; where more are seen than there are, all are
/// ambiguous. Used by one thread at a time; the same frame gives the same answer.
class ObjectFinder {
 public:
  /// @return bad_input that names the object or option; not_available where objects have tags and
  ///         AprilTag is not built in.
  [[nodiscard]] static Result<ObjectFinder> create(std::vector<KnownObject> objects,
                                                   const FindOptions& options = {});
  ~ObjectFinder();
  ObjectFinder(ObjectFinder&&) noexcept;
  ObjectFinder& operator=(ObjectFinder&&) noexcept;

  /// @param known  [m] (height * width,) depth of what is known to be there besides objects and
  ///               table (the arm, walls), 0 where nothing is: what looks like that is no object;
  ///               empty: nothing is known.
  /// @param believed  (objects,) X_WO where each was, as far as that is known: of one kind the
  ///               nearest gets the name, so that names stay from look to look. Nothing else comes
  ///               of it. Empty: nothing is known.
  /// @return bad_input where the frame or the sizes do not fit together. Pixels without depth are
  ///         none.
  [[nodiscard]] Result<FoundScene> find(const render::RgbdFrame& frame,
                                        std::span<const float> known = {},
                                        std::span<const std::optional<Pose>> believed = {});

 private:
  struct Impl;
  explicit ObjectFinder(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace mjarm::perception

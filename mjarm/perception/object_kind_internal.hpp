#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "mjarm/perception/find_objects.hpp"
#include "mjarm/perception/shape_model_internal.hpp"

namespace mjarm::perception {

using ObjectPose = Result<FoundPose, FindFailure>;

/// Objects of one shape that are as good as each other, mostly one alone, and the pieces of them
/// that a frame shows: found once for all of them.
class ObjectKind {
 public:
  explicit ObjectKind(const Surface& surface) : shape(surface) {}

  ShapeModel shape;
  std::vector<std::size_t> objects = {};  ///< in the order of all objects

  /// Another frame.
  void begin();
  /// How many pieces may still be found.
  [[nodiscard]] std::size_t left() const { return objects.size() - found_.size(); }
  /// Whether two poses cannot be those of two pieces: one would stand in the other.
  [[nodiscard]] bool is_one_piece(const Pose& A, const Pose& B) const;
  /// Whether a piece is found there already.
  [[nodiscard]] bool is_found(const Pose& X_WO) const;

  void add(const FoundPose& found);
  /// Something that is no more than doubtful; it takes the place of what was so before.
  void add_doubtful(FindErrc code, const FoundPose& best);
  /// Something that touches others may be a piece: it counts where there is nothing better.
  void add_touching(const FoundPose& best);

  /// Gives each of the objects its piece, whatever is found first. A piece gets the name of the
  /// object that is believed nearest, the nearest of all pairs first; where nothing is believed,
  /// names are given in order.
  /// @param believed  (all objects,) X_WO, or empty.
  /// @param out       (all objects,) gets the poses; those that get none stay as they are.
  void name_pieces(std::span<const std::optional<Pose>> believed,
                   std::vector<ObjectPose>& out) const;

 private:
  std::vector<FoundPose> found_ = {};
  std::vector<FindFailure> doubtful_ = {};  ///< all with a pose; the last one counts most
};

/// Objects by kind; each that has none is one of its own.
[[nodiscard]] std::vector<ObjectKind> object_kinds(std::span<const KnownObject> objects);

}  // namespace mjarm::perception

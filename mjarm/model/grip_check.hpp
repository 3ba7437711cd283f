#pragma once

#include <filesystem>
#include <utility>
#include <vector>

#include "mjarm/core/result.hpp"
#include "mjarm/model/export.hpp"
#include "mjarm/model/model.hpp"

namespace mjarm {

/// Settings under which a gripper holds what it grips; what is empty or false stays as it is.
struct GripMend {
  bool elliptic = false;    ///< the elliptic friction cone
  bool impratio = false;    ///< friction stiffer than the normal force
  bool stiff = false;       ///< pads with a fast solref and solimp near 1, which count
  bool friction = false;    ///< pads that are not slippery
  bool condim = false;      ///< pads that resist twisting and rolling
  std::vector<int> pads{};  ///< geoms that touch what is held, by their number in the model
  /// Joints of the hand, by their number in the model, and their armature [kg m^2 or kg].
  std::vector<std::pair<int, double>> armature{};
  /// The same with their damping [N m s/rad or N s/m].
  std::vector<std::pair<int, double>> damping{};
  std::vector<std::pair<int, int>> exclude{};  ///< bodies that shall not collide

  [[nodiscard]] bool operator==(const GripMend&) const = default;
  [[nodiscard]] bool empty() const {
    return !elliptic && !impratio && !condim && !stiff && !friction && armature.empty() &&
           damping.empty() && exclude.empty();
  }
};

/// MJCF of `model` with `mend`, otherwise as export_model writes it.
/// @param folder  where the file will stand.
/// @return impossible where the description cannot be read any more, or has changed.
[[nodiscard]] Result<Exported> export_mended(const Model& model, const GripMend& mend,
                                             const std::filesystem::path& folder);

}  // namespace mjarm

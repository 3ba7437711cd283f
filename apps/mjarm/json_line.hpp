#pragma once

#include <nlohmann/json.hpp>
#include <string_view>
#include <vector>

#include "mjarm/core/pose.hpp"
#include "mjarm/core/result.hpp"

namespace mjarm::app {

/// Parses one line as a JSON object. Nesting deeper than any request of ours is refused before it
/// is parsed. @return what is wrong, without the place of the line; never throws.
[[nodiscard]] Result<nlohmann::json> parse_json_object(std::string_view line);

/// Member `key` of `object` as a list of `size` finite numbers.
[[nodiscard]] Result<std::vector<double>> number_list(const nlohmann::json& object,
                                                      const std::string& key, std::size_t size);

/// Pose from `"pos":[3]` and `"quat":[4]` of `object`. The quaternion may be off unit length by a
/// few rounded digits; it is normalised.
[[nodiscard]] Result<Pose> pose_of(const nlohmann::json& object);

/// Rotation of a quaternion `[w, x, y, z]` as a user writes it.
[[nodiscard]] Result<Eigen::Matrix3d> rotation_of_quat(const std::vector<double>& wxyz);

}  // namespace mjarm::app

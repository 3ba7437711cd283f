#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "mjarm/core/pose.hpp"
#include "mjarm/core/result.hpp"

namespace mjarm::detail {

struct JsonDeleter {
  void operator()(const nlohmann::json* json) const;
};
using JsonObject = std::unique_ptr<const nlohmann::json, JsonDeleter>;

/// Parses a JSON object. Nesting deeper than any file of ours is refused before it is parsed.
/// @return what is wrong, without the name of the file; never throws.
[[nodiscard]] Result<JsonObject> parse_json_object(std::string_view text);

/// Member `key` of `object` as a list of `size` finite numbers.
[[nodiscard]] Result<std::vector<double>> number_list(const nlohmann::json& object,
                                                      const std::string& key, std::size_t size);

/// The same of a value that has no name of its own; `name` stands for it in the error.
[[nodiscard]] Result<std::vector<double>> numbers_of(const nlohmann::json& value,
                                                     const std::string& name, std::size_t size);

/// Rotation of a quaternion `[w, x, y, z]` as a user writes it.
[[nodiscard]] Result<Eigen::Matrix3d> rotation_of_quat(const std::vector<double>& wxyz);

}  // namespace mjarm::detail

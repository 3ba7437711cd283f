#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "mjarm/core/pose.hpp"
#include "mjarm/core/result.hpp"

namespace mjarm::app {

struct JsonDeleter {
  void operator()(const nlohmann::json* json) const;
};
/// A parsed object, behind a pointer so that who only hands it on does without nlohmann's header,
/// which takes seconds to compile.
using JsonObject = std::unique_ptr<const nlohmann::json, JsonDeleter>;

/// Parses one line as a JSON object. Nesting deeper than any request of ours is refused before it
/// is parsed. @return what is wrong, without the place of the line; never throws.
[[nodiscard]] Result<JsonObject> parse_json_object(std::string_view line);

/// Gives `take` every line of a file, each one JSON object; blank lines are skipped.
/// @param longest_line  [bytes]
/// @return an error that begins with `file:line:` at the first line that is none, or that `take`
/// refuses.
[[nodiscard]] Result<void> read_json_lines(
    const std::filesystem::path& file, std::size_t longest_line,
    const std::function<Result<void>(const nlohmann::json& object)>& take);

[[nodiscard]] bool has_member(const nlohmann::json& object, const char* key);

/// Member `key` of `object` as a list of `size` finite numbers.
[[nodiscard]] Result<std::vector<double>> number_list(const nlohmann::json& object,
                                                      const std::string& key, std::size_t size);

/// The same of a value that has no name of its own; `name` stands for it in the error.
[[nodiscard]] Result<std::vector<double>> numbers_of(const nlohmann::json& value,
                                                     const std::string& name, std::size_t size);

/// Pose from `"pos":[3]` and `"quat":[4]` of `object`. The quaternion may be off unit length by a
/// few rounded digits; it is normalised.
[[nodiscard]] Result<Pose> pose_of(const nlohmann::json& object);

/// Rotation of a quaternion `[w, x, y, z]` as a user writes it.
[[nodiscard]] Result<Eigen::Matrix3d> rotation_of_quat(const std::vector<double>& wxyz);

}  // namespace mjarm::app

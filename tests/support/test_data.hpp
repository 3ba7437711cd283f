#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

/// Cases made by other programs, which lie outside the repository: the environment variable
/// MJARM_TEST_DATA names their folder. Without it the tests that need them are skipped.
namespace mjarm::support {

/// Path of `name` in the data folder; none where the variable is not set.
[[nodiscard]] std::optional<std::filesystem::path> test_data_file(const std::string& name);

/// Content of a file, unpacked where the name ends in `.gz`.
/// @throws std::runtime_error that names the file (a test fails by it).
[[nodiscard]] std::string read_data(const std::filesystem::path& file);

/// The text of an MJCF file with its parts (`<mujocoinclude>`) in the place of their `<include>`.
/// @throws std::runtime_error that names the file
[[nodiscard]] std::string read_mjcf(const std::filesystem::path& file);

/// A JSON file, plain or gzipped. @throws std::exception
[[nodiscard]] nlohmann::json load_json(const std::filesystem::path& file);

/// A file of JSON lines, plain or gzipped; blank lines are left out. @throws std::exception
[[nodiscard]] std::vector<nlohmann::json> load_json_lines(const std::filesystem::path& file);

/// Unpacks an archive (`.tar.xz`) into a folder. @throws std::runtime_error
void unpack(const std::filesystem::path& archive, const std::filesystem::path& folder);

#if defined(_WIN32)
inline constexpr bool kUnpacks = false;
#else
inline constexpr bool kUnpacks = true;
#endif

}  // namespace mjarm::support

/// Declares `variable`, the path of the data file `name`, or skips the test; fails it where the
/// folder is named but lacks the file.
#define MJARM_TEST_FILE(variable, name)                                                    \
  const std::filesystem::path variable =                                                   \
      ::mjarm::support::test_data_file(name).value_or(std::filesystem::path());            \
  if (variable.empty()) GTEST_SKIP() << "MJARM_TEST_DATA is not set; needed for " << name; \
  ASSERT_TRUE(std::filesystem::exists(variable)) << variable

/// The same for an archive; skips the test where nothing unpacks it.
#define MJARM_TEST_ARCHIVE(variable, name)                                     \
  if (!::mjarm::support::kUnpacks) GTEST_SKIP() << "nothing unpacks " << name; \
  MJARM_TEST_FILE(variable, name)

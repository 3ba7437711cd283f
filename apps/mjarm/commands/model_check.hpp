#pragma once

#include <string>

#include "apps/mjarm/cli/options.hpp"
#include "mjarm/core/long_result.hpp"
#include "mjarm/model/check.hpp"

namespace mjarm::app {

/// The findings for people, one a line, in the language in use.
[[nodiscard]] std::string to_text(const CheckReport& report);
/// The findings as one JSON document.
[[nodiscard]] std::string to_json(const CheckReport& report);

/// What `mjarm model check --fix` was asked for.
struct FixOptions {
  std::string out;  ///< file to write; empty = none
  Replace replace = {};
};

/// Checks `file`, prints what is found; exit code 0 where there is no error, 1 where there is, 2
/// where the file does not load. Warnings do not change it: what works may be used. With
/// `fix.out` writes the model with a gripper that holds better, or tells that nothing is to be
/// written.
[[nodiscard]] Result<int> check_file(const std::filesystem::path& file, const CheckOptions& options,
                                     bool json, const FixOptions& fix);

/// Compares the forward kinematics of two descriptions and prints the difference and its likely
/// cause; exit code 0 where they agree to 1e-9 m and rad (masses and limits may still differ), else
/// 1. Where `other` has no frame `options.tip`, its own tool frame is taken.
[[nodiscard]] Result<int> check_against(const std::filesystem::path& file,
                                        const std::filesystem::path& other,
                                        const CheckOptions& options, bool json);

}  // namespace mjarm::app

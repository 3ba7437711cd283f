#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "mjarm/core/result.hpp"
#include "mjarm/install/http.hpp"
#include "mjarm/install/install_state.hpp"

namespace mjarm::install {

/// The package of npm that carries the strokes of Chinese characters.
struct HanziPackage {
  std::string project = "hanzi-writer-data";
  std::string file = "hanzi-writer-data-2.0.1.tgz";
  std::uint64_t size = 13484680;  ///< [bytes]
  std::string sha256 = "72baf3d82b114e60d6e40ea05f24d2262a05cd39d544e2f322ba2fceb7beff15";
  std::string licence = "Arphic Public License";
  std::string licence_file = "ARPHICPL.TXT";
  std::size_t characters = 9574;
  /// Of what is made from it, see hanzi_file().
  std::string strokes_sha256 = "8393dffe9f1d3034db0d7bb7627f3f2191b16643ecd4d225f14a30a5de136f87";
};

/// Which npm registry this machine uses: npm_config_registry, else `registry` of ~/.npmrc (or what
/// NPM_CONFIG_USERCONFIG names), else npm's own.
[[nodiscard]] std::string npm_registry();

/// Folder of the strokes and their licence in the data folder `data`.
[[nodiscard]] std::filesystem::path hanzi_folder(const std::filesystem::path& data);

/// Reads every file and compares its hash.
[[nodiscard]] InstallState check_hanzi(const std::filesystem::path& data,
                                       const HanziPackage& package = {});

/// Fetches the package and keeps the middle lines of all strokes, with the licence. Everything is
/// verified before it appears under its name. May be ended at any moment: the next call goes on
/// with what was fetched. The caller holds the lock of `data`.
/// @param from  address of a folder with the package in it; empty = the registry is asked.
[[nodiscard]] Result<void> install_hanzi(const std::filesystem::path& data, const HttpOptions& http,
                                         const std::string& from, const HanziPackage& package = {});

/// Takes all of it away, with whatever an unfinished install left. @return whether there was
/// anything.
[[nodiscard]] Result<bool> remove_hanzi(const std::filesystem::path& data);

}  // namespace mjarm::install

#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <system_error>

#include "mjarm/core/result.hpp"
#include "mjarm/install/http.hpp"

namespace mjarm::install {

/// Folders of one install in progress, all in one of its own that is kept until it is done.
struct Stage {
  std::filesystem::path work;   ///< of what is installed
  std::filesystem::path stage;  ///< in `work`: becomes the folder of the result
  std::filesystem::path part;   ///< in `work`: what was downloaded

  /// @param data  data folder of mjarm.
  /// @param file  what is downloaded.
  Stage(const std::filesystem::path& data, const std::string& folder, const std::string& file);
  /// Takes away what an install before left of its result, and makes the folders.
  [[nodiscard]] Result<void> begin() const;
  /// What is downloaded.
  struct Source {
    std::string url;
    ByteRange range;
    std::string name;  ///< for the progress bar
  };
  /// Downloads `source` to `part` and has it unpacked. A part left by an earlier run may have been
  /// damaged since: where `unpack` finds it so (not_available) all is fetched anew, once.
  [[nodiscard]] Result<void> fetch(const Source& source, const HttpOptions& http,
                                   const std::function<Result<void>()>& unpack) const;
  /// Puts the verified stage in its place. Ended half way, nothing or what was there before is
  /// there, and the next install has all it needs in `work`.
  [[nodiscard]] Result<void> publish(const std::filesystem::path& target) const;
  /// After a failure only what was downloaded stays.
  void tidy() const;
};

[[nodiscard]] Error write_error(const std::filesystem::path& path, const std::error_code& code);
[[nodiscard]] Result<void> make_folders(const std::filesystem::path& folder);
/// Takes both folders away, and those above them in `data` that are empty then. @return whether
/// there was anything.
[[nodiscard]] Result<bool> remove_installed(const std::filesystem::path& data,
                                            const std::filesystem::path& target,
                                            const std::string& folder);

}  // namespace mjarm::install

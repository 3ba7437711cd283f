#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "mjarm/core/result.hpp"

namespace mjarm {

/// A zip archive whose entries are stored as they are, as stable-baselines3 and torch write them.
/// Entries are views of its bytes: nothing is unpacked, so no archive can grow.
class StoredZip {
 public:
  /// Reads the directory of an archive and checks that every entry lies within it.
  /// @param bytes   the archive; must outlive this object.
  /// @param source  name of the file, for messages.
  /// @return bad_input where it is damaged, or names an entry twice.
  [[nodiscard]] static Result<StoredZip> open(std::string_view bytes, std::string source);

  /// Content of an entry, as it stands there.
  /// @return bad_input where it is missing, compressed or encrypted.
  [[nodiscard]] Result<std::string_view> read(std::string_view name) const;
  /// Content of an entry; also fails where it has another CRC-32.
  [[nodiscard]] Result<std::string_view> read_checked(std::string_view name) const;
  [[nodiscard]] bool contains(std::string_view name) const { return entries_.contains(name); }
  /// The name that ends in `end`; empty where none or more than one does.
  [[nodiscard]] std::string_view name_ending_in(std::string_view end) const;
  /// Names of all entries, sorted; they live as long as this object.
  [[nodiscard]] std::vector<std::string_view> names() const;

 private:
  struct Entry {
    std::string_view content;
    std::uint32_t crc = 0;
    bool plain = false;  ///< neither compressed nor encrypted
  };
  bool add_entry(std::string_view bytes, std::size_t& at, std::size_t directory,
                 std::string& twice);

  std::string source_;
  std::map<std::string, Entry, std::less<>> entries_;
};

/// Writes such an archive, whose bytes depend on names and contents alone: every entry bears the
/// date 1 January 1980. Eighty lines over the CRC-32 of zlib, which is needed anyway: a library
/// (libzip, minizip) would be one more package on every system to set time stamps and nothing else,
/// as pictures are compressed already and numbers are small beside them.
class StoredZipWriter {
 public:
  /// @param name     UTF-8, none twice, at most 65535 bytes; at most 65535 entries.
  /// @param content  all together below 4 GB.
  void add(std::string_view name, std::string_view content);
  /// The archive.
  [[nodiscard]] std::string finish() &&;

 private:
  std::string bytes_, directory_;
  std::size_t count_ = 0;
};

}  // namespace mjarm

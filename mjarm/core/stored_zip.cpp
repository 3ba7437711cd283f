#include "mjarm/core/stored_zip.hpp"

#include <zlib.h>

#include <utility>

#include "mjarm/core/byte_order.hpp"
#include "mjarm/core/in_quotes.hpp"
#include "mjarm/core/messages/zip.hpp"

// Records and their fields: PKWARE, APPNOTE.TXT - .ZIP File Format Specification 6.3, section 4.3.
namespace mjarm {
namespace {

constexpr std::size_t kEndRecord = 22;
constexpr std::size_t kDirectoryRecord = 46;
constexpr std::size_t kLocalRecord = 30;
constexpr std::size_t kLongestComment = 0xFFFF;
constexpr unsigned kEncrypted = 1;

constexpr unsigned kVersion = 20;          // of the format that is needed: 2.0
constexpr unsigned kUtf8Names = 1U << 11;  // bit 11 of the flags
constexpr unsigned kFirstDay = 0x21;       // 1 January 1980, as MS-DOS writes dates

std::size_t word16(std::string_view bytes, std::size_t at) {
  return load_little<std::uint16_t>(bytes, at);
}
std::size_t word32(std::string_view bytes, std::size_t at) {
  return load_little<std::uint32_t>(bytes, at);
}

void put16(std::string& out, std::size_t value) {
  append_little(out, static_cast<std::uint16_t>(value));
}
void put32(std::string& out, std::size_t value) {
  append_little(out, static_cast<std::uint32_t>(value));
}

/// What local and directory records share, from the version needed on to the length of the extra
/// field.
void put_entry_head(std::string& out, std::string_view name, std::size_t crc, std::size_t size) {
  put16(out, kVersion);
  put16(out, kUtf8Names);
  put16(out, 0);  // stored
  put16(out, 0);  // midnight
  put16(out, kFirstDay);
  put32(out, crc);
  put32(out, size);
  put32(out, size);
  put16(out, name.size());
  put16(out, 0);
}

/// True where `count` bytes from `at` on lie before `end`.
bool fits_in(std::size_t at, std::size_t count, std::size_t end) {
  return at <= end && count <= end - at;
}

bool has_zip_signature(std::string_view bytes, std::size_t at, char third, char fourth) {
  return bytes.substr(at, 2) == "PK" && bytes[at + 2] == third && bytes[at + 3] == fourth;
}

/// Where the last record stands, whose comment must end with the file; npos where there is none.
std::size_t end_record(std::string_view bytes) {
  const std::size_t least = kEndRecord + kLongestComment;
  const std::size_t first = bytes.size() > least ? bytes.size() - least : 0;
  std::size_t end = bytes.size();
  while (end >= first + kEndRecord) {
    const std::size_t at = bytes.rfind("PK\5\6", end - kEndRecord);
    if (at == std::string_view::npos || at < first) break;
    if (word16(bytes, at + 20) == bytes.size() - at - kEndRecord) return at;
    end = at + kEndRecord - 1;
  }
  return std::string_view::npos;
}

}  // namespace

/// Takes the directory's entry at `at`, and moves `at` behind it; false where it is damaged.
bool StoredZip::add_entry(std::string_view bytes, std::size_t& at, std::size_t directory,
                          std::string& twice) {
  if (!fits_in(at, kDirectoryRecord, bytes.size()) || !has_zip_signature(bytes, at, 1, 2))
    return false;
  const std::size_t name_size = word16(bytes, at + 28);
  const std::size_t size = word32(bytes, at + 20);
  const std::size_t local = word32(bytes, at + 42);
  const bool stored = word16(bytes, at + 10) == 0 && word32(bytes, at + 24) == size;
  const bool plain = stored && (word16(bytes, at + 8) & kEncrypted) == 0;
  const auto crc = load_little<std::uint32_t>(bytes, at + 16);
  if (!fits_in(at + kDirectoryRecord, name_size, bytes.size())) return false;
  const std::string_view name = bytes.substr(at + kDirectoryRecord, name_size);
  at += kDirectoryRecord + name_size + word16(bytes, at + 30) + word16(bytes, at + 32);
  if (at > bytes.size()) return false;

  // The local record may leave the sizes open, but not the name.
  if (!fits_in(local, kLocalRecord, directory) || !has_zip_signature(bytes, local, 3, 4))
    return false;
  const std::size_t begin = local + kLocalRecord + name_size + word16(bytes, local + 28);
  if (word16(bytes, local + 26) != name_size || !fits_in(begin, size, directory) ||
      bytes.substr(local + kLocalRecord, name_size) != name) {
    return false;
  }
  const bool added =
      entries_.emplace(std::string(name), Entry{bytes.substr(begin, size), crc, plain}).second;
  if (!added) twice = in_quotes(name);
  return true;
}

Result<StoredZip> StoredZip::open(std::string_view bytes, std::string source) {
  StoredZip zip;
  zip.source_ = std::move(source);
  const std::size_t end = end_record(bytes);
  if (end == std::string_view::npos) {
    return fail(Errc::bad_input, text(msg::zip_none, zip.source_));
  }
  const std::size_t count = word16(bytes, end + 10);
  const std::size_t directory = word32(bytes, end + 16);
  // One part only; what lies between the directory and the last record is of no concern.
  if (word16(bytes, end + 4) != 0 || word16(bytes, end + 8) != count ||
      !fits_in(directory, word32(bytes, end + 12), end)) {
    return fail(Errc::bad_input, text(msg::zip_none, zip.source_));
  }
  std::size_t at = directory;
  const std::string_view records = bytes.substr(0, directory + word32(bytes, end + 12));
  std::string twice;
  for (std::size_t i = 0; i < count; ++i) {
    if (!zip.add_entry(records, at, directory, twice)) {
      return fail(Errc::bad_input, text(msg::zip_entry, zip.source_, i + 1));
    }
    if (!twice.empty()) {
      return fail(Errc::bad_input, text(msg::zip_twice, zip.source_, twice));
    }
  }
  if (at != records.size()) {
    return fail(Errc::bad_input, text(msg::zip_entry, zip.source_, count + 1));
  }
  return zip;
}

Result<std::string_view> StoredZip::read(std::string_view name) const {
  const auto found = entries_.find(name);
  if (found == entries_.end()) {
    return fail(Errc::bad_input, text(msg::zip_missing, source_, in_quotes(name)));
  }
  const Entry& entry = found->second;
  if (!entry.plain) {
    return fail(Errc::bad_input, text(msg::zip_packed, source_, in_quotes(name)));
  }
  return entry.content;
}

Result<std::string_view> StoredZip::read_checked(std::string_view name) const {
  const Result<std::string_view> content = read(name);
  if (!content) return content;
  const auto* first = reinterpret_cast<const Bytef*>(content->data());
  if (crc32_z(0, first, content->size()) != entries_.find(name)->second.crc) {
    return fail(Errc::bad_input, text(msg::zip_crc, source_, in_quotes(name)));
  }
  return content;
}

std::string_view StoredZip::name_ending_in(std::string_view end) const {
  std::string_view found;
  for (const auto& [name, entry] : entries_) {
    if (!name.ends_with(end)) continue;
    if (!found.empty()) return {};
    found = name;
  }
  return found;
}

std::vector<std::string_view> StoredZip::names() const {
  std::vector<std::string_view> out;
  for (const auto& [name, entry] : entries_) out.emplace_back(name);
  return out;
}

void StoredZipWriter::add(std::string_view name, std::string_view content) {
  const auto* first = reinterpret_cast<const Bytef*>(content.data());
  const std::size_t crc = crc32_z(0, first, content.size());
  const std::size_t at = bytes_.size();
  bytes_ += "PK\3\4";
  put_entry_head(bytes_, name, crc, content.size());
  bytes_ += name;
  bytes_ += content;
  directory_ += "PK\1\2";
  put16(directory_, kVersion);
  put_entry_head(directory_, name, crc, content.size());
  put16(directory_, 0);  // no comment
  put16(directory_, 0);  // in this part
  put16(directory_, 0);  // bytes
  put32(directory_, 0);  // no attributes
  put32(directory_, at);
  directory_ += name;
  ++count_;
}

std::string StoredZipWriter::finish() && {
  const std::size_t at = bytes_.size();
  bytes_ += directory_;
  bytes_ += "PK\5\6";
  put32(bytes_, 0);  // one part
  put16(bytes_, count_);
  put16(bytes_, count_);
  put32(bytes_, directory_.size());
  put32(bytes_, at);
  put16(bytes_, 0);  // no comment
  return std::move(bytes_);
}

}  // namespace mjarm

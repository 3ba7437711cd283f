#include <cstring>

#include "mjarm/collision/cover_cache_internal.hpp"

namespace mjarm::detail {
namespace {

/// To be raised when fit_cover() gives something else for the same.
constexpr const char* kCovers = "mjarm covers 1\n";

/// Reads numbers from bytes; all that follow one that is not there are zero.
class ByteReader {
 public:
  explicit ByteReader(const std::string& bytes) : bytes_(bytes) {}
  template <class Number>
  void read(Number& value) {
    value = {};
    if (bytes_.size() - at_ < sizeof(value)) {
      fine_ = false;
      return;
    }
    std::memcpy(&value, bytes_.data() + at_, sizeof(value));
    at_ += sizeof(value);
  }
  /// A length, with room for so many values of at least `each` bytes.
  std::size_t read_length(std::size_t each) {
    std::size_t length = 0;
    read(length);
    if (length > (bytes_.size() - at_) / each) fine_ = false;
    return fine_ ? length : 0;
  }
  [[nodiscard]] bool is_done() const { return fine_ && at_ == bytes_.size(); }

 private:
  const std::string& bytes_;
  std::size_t at_ = 0;
  bool fine_ = true;
};

}  // namespace

std::string key_of_covers(const std::vector<std::vector<CoverSolid>>& covers, double bound) {
  ByteKey key(kCovers);
  key.add(bound, covers.size());
  for (const std::vector<CoverSolid>& solids : covers) {
    key.add(solids.size());
    for (const CoverSolid& solid : solids) solid.append_to(key);
  }
  return key.bytes();
}

std::string bytes_of(const std::vector<FittedCover>& covers) {
  ByteKey out("");
  for (const FittedCover& cover : covers) {
    out.add(cover.bound, cover.spheres.size());
    for (const Sphere& sphere : cover.spheres) out.add(sphere.center, sphere.radius);
  }
  return out.bytes();
}

std::optional<std::vector<FittedCover>> covers_of(const std::string& bytes, std::size_t count) {
  ByteReader reader(bytes);
  std::vector<FittedCover> out(count);
  for (FittedCover& cover : out) {
    reader.read(cover.bound);
    cover.spheres.resize(reader.read_length(4 * sizeof(double)));
    for (Sphere& sphere : cover.spheres) {
      for (int k = 0; k < 3; ++k) reader.read(sphere.center[k]);
      reader.read(sphere.radius);
    }
  }
  if (!reader.is_done()) return {};
  return out;
}

std::string bytes_of(const Meetings& meetings) {
  ByteKey out("");
  out.add(meetings.pairs, meetings.apart, meetings.standing.size());
  for (const Meetings::Standing& one : meetings.standing) out.add(one.obstacle, one.ignored);
  return out.bytes();
}

std::optional<Meetings> meetings_of(const std::string& bytes, const GeomGroups& groups) {
  ByteReader reader(bytes);
  Meetings out;
  bool known = true;
  const auto read_link = [&](int& link) {
    reader.read(link);
    known = known && link >= 0 && link < std::ssize(groups.links);
  };
  out.pairs.resize(reader.read_length(2 * sizeof(int)));
  for (auto& [a, b] : out.pairs) read_link(a), read_link(b);
  reader.read(out.apart);
  out.standing.resize(reader.read_length(2 * sizeof(std::size_t)));
  for (Meetings::Standing& one : out.standing) {
    reader.read(one.obstacle);
    known = known && one.obstacle < groups.obstacles.size();
    one.ignored.resize(reader.read_length(sizeof(int)));
    for (int& link : one.ignored) read_link(link);
  }
  if (!known || !reader.is_done()) return {};
  return out;
}

}  // namespace mjarm::detail

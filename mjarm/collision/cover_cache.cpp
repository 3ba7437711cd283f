#include "mjarm/collision/cover_cache_internal.hpp"

namespace mjarm::detail {
namespace {

/// To be raised when fit_cover() gives something else for the same.
constexpr const char* kCovers = "mjarm covers 1\n";

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

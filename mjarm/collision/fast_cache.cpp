#include <algorithm>
#include <utility>

#include "mjarm/collision/byte_key_internal.hpp"
#include "mjarm/collision/fast_cache_internal.hpp"

namespace mjarm::detail {
namespace {

/// To be raised when add_pairs() or add_apart() gives something else for the same.
constexpr const char* kPairTables = "mjarm pairs 1\n";

/// What is kept of a robot.
struct PairTables {
  std::vector<FastPair> pairs, every_pair;
  std::vector<FastRow> rows;
  std::vector<FastPartPair> part_pairs;
  std::vector<FastPartners> partners;
  std::vector<FastApart> apart;
  std::vector<std::uint8_t> cells;
};

/// Calls visit(value) for each number of an entry that is kept.
template <class Visit>
void each_number(FastPair& x, const Visit& visit) {
  visit(x.a), visit(x.b), visit(x.first), visit(x.count), visit(x.reach), visit(x.apart);
}
template <class Visit>
void each_number(FastRow& x, const Visit& visit) {
  visit(x.part), visit(x.reach), visit(x.first), visit(x.count);
}
template <class Visit>
void each_number(FastPartPair& x, const Visit& visit) {
  visit(x.a), visit(x.b), visit(x.reach), visit(x.first), visit(x.count);
}
template <class Visit>
void each_number(FastPartners& x, const Visit& visit) {
  visit(x.a), visit(x.b), visit(x.reach), visit(x.minus_reach2);
}
template <class Visit>
void each_number(FastApart& x, const Visit& visit) {
  visit(x.side), visit(x.unit), visit(x.first);
  for (std::size_t k = 0; k < 2; ++k) visit(x.joint[k]), visit(x.low[k]), visit(x.per_unit[k]);
}
template <class Visit>
void each_number(std::uint8_t& x, const Visit& visit) {
  visit(x);
}

/// Calls visit(list) for all lists.
template <class Visit>
void each_list(PairTables& tables, const Visit& visit) {
  visit(tables.pairs), visit(tables.every_pair), visit(tables.rows), visit(tables.part_pairs);
  visit(tables.partners), visit(tables.apart), visit(tables.cells);
}

bool is_index(int index, std::size_t count) {
  return index >= 0 && static_cast<std::size_t>(index) < count;
}
bool is_run(int first, int count, std::size_t of) {
  return first >= 0 && count >= 0 && static_cast<std::size_t>(first) <= of &&
         static_cast<std::size_t>(count) <= of - static_cast<std::size_t>(first);
}

/// Whether nothing points to what is not there.
bool is_sound(const PairTables& tables, const FastRobotData& data) {
  const auto pair = [&](const FastPair& x) {
    return is_index(x.a, data.groups.size()) && is_index(x.b, data.groups.size()) &&
           is_run(x.first, x.count, tables.rows.size()) &&
           (x.apart == -1 || is_index(x.apart, tables.apart.size()));
  };
  const auto row = [&](const FastRow& x) {
    return is_index(x.part, data.parts.size()) &&
           is_run(x.first, x.count, tables.part_pairs.size());
  };
  const auto parts = [&](const FastPartPair& x) {
    return is_index(x.a, data.parts.size()) && is_index(x.b, data.parts.size()) &&
           is_run(x.first, x.count, tables.partners.size());
  };
  const auto both = [&](const FastPartners& x) {
    return is_index(x.a, data.spheres.size()) && is_index(x.b, data.spheres.size());
  };
  const auto table = [&](const FastApart& x) {
    const auto joint = [&](int k) { return is_index(k, static_cast<std::size_t>(data.arm.dof())); };
    const int rows = x.per_unit[1] == 0 ? 1 : x.side;
    return is_index(x.side, kFastSpheres) && joint(x.joint[0]) && joint(x.joint[1]) &&
           is_run(x.first, x.side * rows + 3, tables.cells.size());  // gather() reads whole words
  };
  return std::ranges::all_of(tables.pairs, pair) && std::ranges::all_of(tables.every_pair, pair) &&
         std::ranges::all_of(tables.rows, row) && std::ranges::all_of(tables.part_pairs, parts) &&
         std::ranges::all_of(tables.partners, both) && std::ranges::all_of(tables.apart, table);
}

}  // namespace

std::string key_of_pairs(const FastRobotData& data, const LinkChain& chain) {
  ByteKey key(kPairTables);
  key.add(chain.dof, data.margins.obstacles, data.margins.links);
  for (int k = 0; k < chain.dof; ++k) {
    const Link& link = chain.links[k];
    const FastLimits limits = fast_limits(data.arm, k);
    key.add(link.t[0], link.t[1], link.t[2], link.tilt_cos, link.tilt_sin, link.offset, link.slide,
            limits.lower, limits.upper);
  }
  key.add(data.set.pairs, data.set.links.size());
  for (const LinkSpheres& link : data.set.links) {
    key.add(link.joint, link.spheres.size());
    for (const Sphere& sphere : link.spheres) key.add(sphere.center, sphere.radius);
  }
  // What has been made of these up to now, in the order in which the pairs count it.
  key.add(data.spheres.size());
  for (const FastSphere& s : data.spheres) key.add(s.x, s.y, s.z, s.radius);
  key.add(data.levers_of_sphere);
  return key.bytes();
}

std::string bytes_of_pairs(const FastRobotData& data) {
  PairTables tables{data.pairs,    data.every_pair, data.rows,       data.part_pairs,
                    data.partners, data.apart,      data.apart_cells};
  ByteKey out("");
  each_list(tables, [&](auto& list) {
    out.add(list.size());
    for (auto& entry : list) each_number(entry, [&](const auto& number) { out.add(number); });
  });
  return out.bytes();
}

bool read_pairs(const std::string& bytes, FastRobotData& data) {
  ByteReader reader(bytes);
  PairTables tables;
  each_list(tables, [&](auto& list) {
    list.resize(reader.read_length(1));
    for (auto& entry : list) each_number(entry, [&](auto& number) { reader.read(number); });
  });
  if (!reader.is_done() || !is_sound(tables, data)) return false;
  data.pairs = std::move(tables.pairs);
  data.every_pair = std::move(tables.every_pair);
  data.rows = std::move(tables.rows);
  data.part_pairs = std::move(tables.part_pairs);
  data.partners = std::move(tables.partners);
  data.apart = std::move(tables.apart);
  data.apart_cells = std::move(tables.cells);
  return true;
}

}  // namespace mjarm::detail

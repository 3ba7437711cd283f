#include <algorithm>
#include <optional>
#include <utility>

#include "mjarm/path/track_search_internal.hpp"

namespace mjarm::detail {
namespace {

constexpr std::size_t kSegment = 512;  // layers that are kept at a time
constexpr std::size_t kKnown = 1024;   // poses of which branches are kept: 20 MB at most

/// The branches of the first poses, for all tracks that are looked at.
using KnownBranches = std::vector<std::vector<PathLayers::Branch>>;

/// Where a segment of layers begins.
struct Checkpoint {
  std::size_t at = 0;
  Layer layer;
};

/// Walks from node `index` of the last of `layers` back to the first of them, which is that of pose
/// `at`. @return the index in the layer before it.
int walk_back(std::span<const Layer> layers, std::size_t at, int index, std::vector<JointVec>& q) {
  for (std::size_t k = layers.size(); k-- > 0;) {
    const TrackNode& node = layers[k][static_cast<std::size_t>(index)];
    q[at + k] = node.q;
    index = node.parent;
  }
  return index;
}

/// The best track from the answers to the first pose that are given, of those better than `bound`
/// where that is given. Only the layers of one segment are kept; to walk back through the ones
/// before, each is made again from its first layer.
Track track_from(const PathLayers& layers, std::span<const Pose> poses, KnownBranches& known,
                 Layer first, const std::optional<TrackRank>& bound) {
  const auto next = [&](std::size_t at, const Layer& before) {
    std::vector<PathLayers::Branch> unkept;
    Layer layer =
        layers.next(poses[at - 1], poses[at], before, at < known.size() ? known[at] : unkept);
    if (bound) std::erase_if(layer, [&](const TrackNode& node) { return !(node.rank < *bound); });
    return layer;
  };
  Track track;
  const StopCheck& stop = layers.options().stop;
  std::vector<Checkpoint> checkpoints;
  std::vector<Layer> segment;
  segment.push_back(std::move(first));
  std::size_t at = 1;
  for (; at < poses.size(); ++at) {
    if (is_stopped(stop)) return {.is_stopped = true};
    Layer layer = next(at, segment.back());
    if (layer.empty()) break;
    if (segment.size() == kSegment) {
      checkpoints.push_back({at - kSegment, std::move(segment.front())});
      segment.clear();
    }
    segment.push_back(std::move(layer));
  }
  track.q.resize(at);
  track.last = segment.back();
  int index = walk_back(segment, at - segment.size(), 0, track.q);
  for (; !checkpoints.empty(); checkpoints.pop_back()) {
    segment.assign(1, std::move(checkpoints.back().layer));
    const std::size_t from = checkpoints.back().at;
    while (segment.size() < kSegment) {
      if (is_stopped(stop)) return {.is_stopped = true};
      segment.push_back(next(from + segment.size(), segment.back()));
    }
    index = walk_back(segment, from, index, track.q);
  }
  return track;
}

/// The best track as if joints had no limits, where it keeps them: no other can be better. Of an
/// arm of six axes it takes one answer a branch, in place of as many as that has windings.
std::optional<Track> track_without_limits(const PathLayers& layers, std::span<const Pose> poses,
                                          KnownBranches& known, const JointVec& q_start) {
  const PathOptions& options = layers.options();
  if (!layers.ik().six_axis() || options.keep_start || options.best_posture) return std::nullopt;
  const IkSolver ik = layers.boundless().with(layers.ik().options());
  const PathLayers free(ik, options);
  Layer first = free.first(poses[0], q_start);
  if (first.empty()) return std::nullopt;
  Track track = track_from(free, poses, known, std::move(first), {});
  if (track.is_stopped || track.q.size() < poses.size()) return std::nullopt;
  const double tightness = track.last.front().rank.tightness;
  const auto fits = [&](const JointVec& q) { return layers.fits(q, tightness); };
  if (!std::ranges::all_of(track.q, fits)) return std::nullopt;
  return track;
}

}  // namespace

/// Tracks only get worse on their way: one that is better in the end than an answer to the first
/// pose is better than all that begin there, and what is worse on the way need not be followed.
Track find_track(const PathLayers& layers, std::span<const Pose> poses, const JointVec& q_start) {
  if (is_stopped(layers.options().stop)) return {.is_stopped = true};
  Layer first = layers.first(poses[0], q_start);
  if (first.empty()) return {};
  KnownBranches known(std::min(poses.size(), kKnown));
  Track one = track_from(layers, poses, known, {first.front()}, {});
  const bool whole = one.q.size() == poses.size();
  if (first.size() == 1 || one.is_stopped) return one;
  if (whole && one.last.front().rank < first[1].rank) return one;
  if (auto free = track_without_limits(layers, poses, known, q_start)) return std::move(*free);
  if (!whole) return track_from(layers, poses, known, std::move(first), {});
  Track better = track_from(layers, poses, known, std::move(first), one.last.front().rank);
  return better.is_stopped || better.q.size() == poses.size() ? better : one;
}

}  // namespace mjarm::detail

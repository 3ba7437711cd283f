#include <utility>

#include "mjarm/path/track_search_internal.hpp"

namespace mjarm::detail {
namespace {

constexpr std::size_t kSegment = 512;  // layers that are kept at a time

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

}  // namespace

/// Only the layers of one segment are kept; to walk back through the ones before, each is made
/// again from its first layer.
Track find_track(const PathLayers& layers, std::span<const Pose> poses, const JointVec& q_start) {
  Track track;
  const StopCheck& stop = layers.options().stop;
  std::vector<Checkpoint> checkpoints;
  std::vector<Layer> segment;
  std::size_t at = 0;
  for (; at < poses.size(); ++at) {
    if (is_stopped(stop)) return {.is_stopped = true};
    Layer layer = at == 0 ? layers.first(poses[0], q_start)
                          : layers.next(poses[at - 1], poses[at], segment.back());
    if (layer.empty()) break;
    if (segment.size() == kSegment) {
      checkpoints.push_back({at - kSegment, std::move(segment.front())});
      segment.clear();
    }
    segment.push_back(std::move(layer));
  }
  if (at == 0) return track;
  track.q.resize(at);
  track.last = segment.back();
  int index = walk_back(segment, at - segment.size(), 0, track.q);
  for (; !checkpoints.empty(); checkpoints.pop_back()) {
    segment.assign(1, std::move(checkpoints.back().layer));
    const std::size_t from = checkpoints.back().at;
    while (segment.size() < kSegment) {
      if (is_stopped(stop)) return {.is_stopped = true};
      const std::size_t next = from + segment.size();
      segment.push_back(layers.next(poses[next - 1], poses[next], segment.back()));
    }
    index = walk_back(segment, from, index, track.q);
  }
  return track;
}

}  // namespace mjarm::detail

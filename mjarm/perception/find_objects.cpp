#include "mjarm/perception/find_objects.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "mjarm/core/messages/perception.hpp"
#include "mjarm/perception/check_frame_internal.hpp"
#include "mjarm/perception/check_objects_internal.hpp"
#include "mjarm/perception/object_kind_internal.hpp"
#include "mjarm/perception/shape_search_internal.hpp"
#include "mjarm/perception/tag_pose.hpp"
#include "mjarm/perception/unknown_shape_internal.hpp"

namespace mjarm::perception {
namespace {

constexpr double kMostMissing = 0.1;       // share of its pixels through which more is seen
constexpr double kMostUnexplained = 0.1;   // share of a cluster's pixels that are not it
constexpr double kMostMisfit = 1.2;        // of the pixels that it explains
constexpr double kTouching = 0.6;          // the same where it may be a part of the cluster
constexpr double kLeastSeen = 0.6;         // of an object without a tag
constexpr double kMostOutside = 0.05;      // of it, outside of the picture
constexpr double kWhole = 0.95;            // of one that nothing hides
constexpr double kMostUncertain = 0.0006;  // [m]
constexpr double kSunk = 0.005;            // [m] below the table
constexpr double kPieceJump = 0.1;         // [m] between pieces of one object

/// Two explanations of what is seen that differ by less than this cannot be told apart.
double margin(double cost) { return 20 + 0.05 * cost; }

FoundPose found_pose(const DepthScene& scene, const ShapeFit& fit, bool by_tag) {
  return {.X_WO = scene.X_WC * fit.X_CO,
          .by_tag = by_tag,
          .seen = fit.seen,
          .residual = fit.residual,
          .uncertainty = fit.uncertainty};
}

bool is_sunk(const DepthScene& scene, const ShapeModel& shape, const Pose& X_CO) {
  return sunk_depth(scene, shape.fine.surface, X_CO) > kSunk;
}

/// Nothing speaks against it but what may hide it.
bool is_possible(const DepthScene& scene, const ShapeModel& shape, const ShapeFit& fit) {
  return fit.missing <= kMostMissing && fit.misfit <= kMostMisfit && fit.seen > 0 &&
         !is_sunk(scene, shape, fit.X_CO);
}
bool is_whole(const ShapeFit& fit) { return fit.unexplained <= kMostUnexplained; }

/// One piece of a kind in one cluster.
struct Match {
  std::size_t kind;
  int cluster;
  ShapeFit fit;
  bool twofold;  ///< another pose explains it as well
};

/// Inverse depth of an object in the whole picture.
std::vector<float> whole_drawing(const DepthScene& scene, const ShapeModel& shape, const Pose& X_CO,
                                 Raster& raster) {
  raster.clear(scene.lens);
  raster.draw(shape.fine.surface, X_CO, shape.fine.sides);
  return raster.inverse();
}

/// The cluster that most pixels of a drawing show; -1 for none.
int cluster_under(const DepthScene& scene, const std::vector<float>& drawn) {
  std::map<int, int> votes;
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    if (drawn[i] > 0 && scene.label[i] >= 0) ++votes[scene.label[i]];
  }
  const auto most = std::max_element(
      votes.begin(), votes.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  return most == votes.end() ? -1 : most->first;
}

/// False where the cluster is larger than the shape can look.
bool may_hold(const DepthScene& scene, int cluster, const ShapeModel& shape) {
  constexpr double kSlack = 6;  // [px]
  const Cluster& box = scene.clusters[static_cast<std::size_t>(cluster)];
  const double across = std::max(box.x1 - box.x0, box.y1 - box.y0);
  return (across - kSlack) / (box.middle * scene.lens.fx) < 2 * shape.radius;
}

/// A kind of which a cluster may be, with poses to refine, the best first.
struct Rival {
  std::size_t kind;
  std::vector<Start> starts;
};

void drop_hopeless(std::vector<Rival>& rivals) {
  constexpr double kFarBetter = 2.5;  // times the cost of the best
  double best = 1e18;
  for (const Rival& rival : rivals) best = std::min(best, rival.starts.front().cost);
  std::erase_if(rivals,
                [&](const Rival& rival) { return rival.starts.front().cost > kFarBetter * best; });
}

}  // namespace

struct ObjectFinder::Impl {
  std::vector<KnownObject> objects;
  std::vector<ObjectKind> kinds;
  FindOptions options;
  DepthModel model;
  std::optional<TagDetector> tags = {};
  Raster raster = {};

  /// The tag of the object that a kind is for itself; null where it is known by its shape.
  [[nodiscard]] const ObjectTag* tag_of(const ObjectKind& kind) const {
    const std::optional<ObjectTag>& tag = objects[kind.objects.front()].tag;
    return tag ? &*tag : nullptr;
  }
  ObjectPose pose_by_tag(const ObjectKind& kind, const std::vector<SeenTag>& seen,
                         const render::RgbdFrame& frame, const DepthScene& scene);
  void find_by_tags(const render::RgbdFrame& frame, DepthScene& scene,
                    std::vector<ObjectPose>& out);
  void find_by_shapes(DepthScene& scene, bool last);
  std::vector<Rival> rivals(const DepthScene& scene, int cluster);
  std::vector<Match> matches(const DepthScene& scene);
  void add(std::vector<Match>& found, const Match& match) const;
  [[nodiscard]] bool is_ambiguous(const std::vector<Match>& found, const Match& match) const;
  void claim(DepthScene& scene, const ObjectKind& kind, const Pose& X_WO) {
    take_out(scene, whole_drawing(scene, kind.shape, scene.X_WC.inverse() * X_WO, raster));
  }
};

ObjectPose ObjectFinder::Impl::pose_by_tag(const ObjectKind& kind, const std::vector<SeenTag>& seen,
                                           const render::RgbdFrame& frame,
                                           const DepthScene& scene) {
  const ObjectTag& tag = *tag_of(kind);
  const auto is_it = [&](const SeenTag& other) { return other.id == tag.id; };
  const auto count = std::count_if(seen.begin(), seen.end(), is_it);
  if (count != 1) {
    return fail(FindFailure{.code = count == 0 ? FindErrc::not_seen : FindErrc::tag_twice});
  }
  const Result<TagPose, FindErrc> at = tag_pose(*std::find_if(seen.begin(), seen.end(), is_it),
                                                tag.size, frame, options.depth_sigma);
  if (!at) return fail(FindFailure{.code = at.error()});
  const Pose X_CO = at->X_CT * tag.X_OT.inverse();
  const int cluster = cluster_under(scene, whole_drawing(scene, kind.shape, X_CO, raster));
  const ShapeFit fit = check_shape(scene, cluster, kind.shape, X_CO, raster);
  const FoundPose pose = found_pose(scene, fit, true);
  if (!is_possible(scene, kind.shape, fit)) {
    return fail(FindFailure{.code = FindErrc::disagrees, .best = pose});
  }
  return pose;
}

void ObjectFinder::Impl::find_by_tags(const render::RgbdFrame& frame, DepthScene& scene,
                                      std::vector<ObjectPose>& out) {
  if (!tags) return;
  const std::vector<SeenTag> seen = tags->find(frame.color);
  for (const ObjectKind& kind : kinds) {
    if (tag_of(kind)) out[kind.objects.front()] = pose_by_tag(kind, seen, frame, scene);
  }
  for (const ObjectKind& kind : kinds) {
    if (const ObjectPose& pose = out[kind.objects.front()]) claim(scene, kind, pose->X_WO);
  }
}

/// Kinds without a tag of which the cluster may be, as coarse pictures show: none that another one
/// explains far better.
std::vector<Rival> ObjectFinder::Impl::rivals(const DepthScene& scene, int cluster) {
  std::vector<Rival> out;
  for (std::size_t k = 0; k < kinds.size(); ++k) {
    const ObjectKind& kind = kinds[k];
    if (tag_of(kind) || kind.left() == 0 || !may_hold(scene, cluster, kind.shape)) continue;
    out.push_back({k, rough_search(scene, cluster, kind.shape, raster)});
  }
  drop_hopeless(out);
  for (Rival& rival : out) {
    rival.starts =
        coarse_search(scene, cluster, kinds[rival.kind].shape, std::move(rival.starts), raster);
  }
  drop_hopeless(out);
  return out;
}

std::vector<Match> ObjectFinder::Impl::matches(const DepthScene& scene) {
  std::vector<Match> found;
  for (int c = 0; c < static_cast<int>(scene.clusters.size()); ++c) {
    std::vector<Match> here;
    double best = 1e18;
    for (auto& [k, starts] : rivals(scene, c)) {
      ObjectKind& kind = kinds[k];
      const std::vector<ShapeFit> fits =
          fine_search(scene, c, kind.shape, std::move(starts), raster);
      if (!is_possible(scene, kind.shape, fits[0])) continue;
      if (kind.is_found(scene.X_WC * fits[0].X_CO)) continue;
      if (!is_whole(fits[0])) {
        if (fits[0].seen >= kLeastSeen && fits[0].unexplained < kTouching) {
          kind.add_touching(found_pose(scene, fits[0], false));
        }
        continue;
      }
      const bool twofold = fits.size() > 1 && is_possible(scene, kind.shape, fits[1]) &&
                           is_whole(fits[1]) && fits[1].cost < fits[0].cost + margin(fits[0].cost);
      here.push_back({k, c, fits[0], twofold});
      best = std::min(best, fits[0].cost);
    }
    for (const Match& match : here) {
      if (match.fit.cost <= best + margin(best)) add(found, match);
    }
  }
  return found;
}

/// Two pieces of one object tell of the same pose: it is one match, the more certain one.
void ObjectFinder::Impl::add(std::vector<Match>& found, const Match& match) const {
  const auto known = std::find_if(found.begin(), found.end(), [&](const Match& other) {
    return other.kind == match.kind &&
           is_same(kinds[match.kind].shape, other.fit.X_CO, match.fit.X_CO);
  });
  if (known == found.end()) {
    found.push_back(match);
  } else if (match.fit.uncertainty < known->fit.uncertainty) {
    *known = match;
  }
}

/// Another pose, another kind, or more pieces than there are left explain what is seen as well.
bool ObjectFinder::Impl::is_ambiguous(const std::vector<Match>& found, const Match& match) const {
  const ObjectKind& kind = kinds[match.kind];
  std::size_t pieces = 0;
  for (const Match& other : found) {
    if (other.kind != match.kind) {
      if (other.cluster == match.cluster) return true;
      continue;
    }
    ++pieces;
    if (&other != &match && kind.is_one_piece(other.fit.X_CO, match.fit.X_CO)) return true;
  }
  return match.twofold || pieces > kind.left();
}

/// @param last  no later round will look at what is doubtful once more
void ObjectFinder::Impl::find_by_shapes(DepthScene& scene, bool last) {
  const std::vector<Match> found = matches(scene);
  std::vector<std::optional<FindErrc>> faults;
  for (const Match& match : found) {
    std::optional<FindErrc> fault;
    if (is_ambiguous(found, match)) fault = FindErrc::ambiguous;
    if (match.fit.uncertainty > kMostUncertain || match.fit.seen < kLeastSeen ||
        match.fit.outside > kMostOutside) {
      fault = match.fit.seen < kWhole ? FindErrc::occluded : FindErrc::ambiguous;
    }
    faults.push_back(fault);
  }
  for (std::size_t i = 0; i < found.size(); ++i) {
    ObjectKind& kind = kinds[found[i].kind];
    const FoundPose pose = found_pose(scene, found[i].fit, false);
    if (faults[i]) {
      kind.add_doubtful(*faults[i], pose);
    } else {
      kind.add(pose);
    }
    if (!faults[i] || last) claim(scene, kind, pose.X_WO);
  }
}

Result<KnownObject> known_object(const Model& model, std::string_view body) {
  Result<Surface> surface = body_surface(model, body);
  if (!surface) return fail(std::move(surface.error()));
  return KnownObject{.name = std::string(body), .surface = std::move(*surface)};
}

Result<ObjectFinder> ObjectFinder::create(std::vector<KnownObject> objects,
                                          const FindOptions& options) {
  if (Result<void> checked = check_objects(objects); !checked) {
    return fail(std::move(checked.error()));
  }
  if (Result<void> checked = check_options(options); !checked) {
    return fail(std::move(checked.error()));
  }
  std::vector<ObjectKind> kinds = object_kinds(objects);
  auto impl = std::make_unique<Impl>(Impl{.objects = std::move(objects),
                                          .kinds = std::move(kinds),
                                          .options = options,
                                          .model = DepthModel(options.depth_sigma)});
  for (const KnownObject& object : impl->objects) {
    if (!object.tag || impl->tags) continue;
    Result<TagDetector> tags = TagDetector::create();
    if (!tags) return fail(std::move(tags.error()));
    impl->tags = std::move(*tags);
  }
  return ObjectFinder(std::move(impl));
}

ObjectFinder::ObjectFinder(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
ObjectFinder::~ObjectFinder() = default;
ObjectFinder::ObjectFinder(ObjectFinder&&) noexcept = default;
ObjectFinder& ObjectFinder::operator=(ObjectFinder&&) noexcept = default;

Result<FoundScene> ObjectFinder::find(const render::RgbdFrame& frame, std::span<const float> known,
                                      std::span<const std::optional<Pose>> believed) {
  if (Result<void> checked = check_frame(frame); !checked) return fail(std::move(checked.error()));
  if (!known.empty() && known.size() != frame.depth.size()) {
    return fail(Errc::bad_input, text(msg::perception_bad_known, known.size(), frame.depth.size()));
  }
  if (!believed.empty() && believed.size() != impl_->objects.size()) {
    return fail(Errc::bad_input,
                text(msg::perception_bad_believed, believed.size(), impl_->objects.size()));
  }
  Rng rng(impl_->options.seed);
  DepthScene scene = depth_scene(frame, impl_->model, impl_->options.table, rng);
  if (!known.empty()) {
    std::vector<float> inverse(known.size());
    std::ranges::transform(known, inverse.begin(), inverse_depth);
    leave_out(scene, inverse);
  }
  std::vector<ObjectPose> poses(impl_->objects.size(), fail(FindFailure{}));
  for (ObjectKind& kind : impl_->kinds) kind.begin();
  impl_->find_by_tags(frame, scene, poses);
  // First what is seen in one piece of one hue, in one piece of any, and then pieces that may be
  // parts of one thing, the nearer part hiding how they are joined.
  gather(scene, kSmoothJump, &frame.color);
  impl_->find_by_shapes(scene, false);
  for (const double jump : {kSmoothJump, kPieceJump}) {
    gather(scene, jump);
    impl_->find_by_shapes(scene, jump == kPieceJump);
  }
  gather(scene, kSmoothJump);
  for (const ObjectKind& kind : impl_->kinds) kind.name_pieces(believed, poses);
  FoundScene out{.table = scene.table};
  for (std::size_t i = 0; i < poses.size(); ++i) {
    out.objects.push_back({impl_->objects[i].name, std::move(poses[i])});
  }
  if (!impl_->options.unknown) return out;
  std::vector<std::pair<int, int>> rest;  // pixels, number
  for (std::size_t c = 0; c < scene.clusters.size(); ++c) {
    rest.emplace_back(-scene.clusters[c].pixels, static_cast<int>(c));
  }
  std::sort(rest.begin(), rest.end());
  for (const auto& [pixels, cluster] : rest) {
    if (auto thing = measure_unknown(scene, cluster, impl_->raster)) out.unknown.push_back(*thing);
  }
  return out;
}

}  // namespace mjarm::perception

#include "mjarm/perception/find_objects.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "mjarm/core/messages/perception.hpp"
#include "mjarm/perception/check_frame_internal.hpp"
#include "mjarm/perception/check_objects_internal.hpp"
#include "mjarm/perception/shape_search_internal.hpp"
#include "mjarm/perception/tag_pose.hpp"
#include "mjarm/perception/unknown_shape_internal.hpp"

namespace mjarm::perception {
namespace {

using ObjectPose = Result<FoundPose, FindFailure>;

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

/// One object in one cluster.
struct Match {
  std::size_t object;
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

/// An object that a cluster may be, with poses to refine, the best first.
struct Rival {
  std::size_t object;
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
  std::vector<ShapeModel> shapes = {};
  FindOptions options;
  DepthModel model;
  std::optional<TagDetector> tags = {};
  Raster raster = {};
  std::vector<char> settled = {};  ///< of the frame: objects that are found, or known by a tag

  ObjectPose pose_by_tag(std::size_t i, const std::vector<SeenTag>& seen,
                         const render::RgbdFrame& frame, const DepthScene& scene);
  void find_by_tags(const render::RgbdFrame& frame, DepthScene& scene,
                    std::vector<ObjectPose>& out);
  void find_by_shapes(DepthScene& scene, bool last, std::vector<ObjectPose>& out);
  std::vector<Rival> rivals(const DepthScene& scene, int cluster);
  std::vector<Match> matches(const DepthScene& scene, std::vector<ObjectPose>& out);
  void add(std::vector<Match>& found, const Match& match) const;
  void claim(DepthScene& scene, std::size_t i, const Pose& X_WO) {
    take_out(scene, whole_drawing(scene, shapes[i], scene.X_WC.inverse() * X_WO, raster));
  }
};

ObjectPose ObjectFinder::Impl::pose_by_tag(std::size_t i, const std::vector<SeenTag>& seen,
                                           const render::RgbdFrame& frame,
                                           const DepthScene& scene) {
  const ObjectTag& tag = *objects[i].tag;
  const auto is_it = [&](const SeenTag& other) { return other.id == tag.id; };
  const auto count = std::count_if(seen.begin(), seen.end(), is_it);
  if (count != 1) {
    return fail(FindFailure{.code = count == 0 ? FindErrc::not_seen : FindErrc::tag_twice});
  }
  const Result<TagPose, FindErrc> at = tag_pose(*std::find_if(seen.begin(), seen.end(), is_it),
                                                tag.size, frame, options.depth_sigma);
  if (!at) return fail(FindFailure{.code = at.error()});
  const Pose X_CO = at->X_CT * tag.X_OT.inverse();
  const int cluster = cluster_under(scene, whole_drawing(scene, shapes[i], X_CO, raster));
  const ShapeFit fit = check_shape(scene, cluster, shapes[i], X_CO, raster);
  const FoundPose pose = found_pose(scene, fit, true);
  if (!is_possible(scene, shapes[i], fit)) {
    return fail(FindFailure{.code = FindErrc::disagrees, .best = pose});
  }
  return pose;
}

void ObjectFinder::Impl::find_by_tags(const render::RgbdFrame& frame, DepthScene& scene,
                                      std::vector<ObjectPose>& out) {
  settled.assign(objects.size(), 0);
  for (std::size_t i = 0; i < objects.size(); ++i) settled[i] = objects[i].tag ? 1 : 0;
  if (!tags) return;
  const std::vector<SeenTag> seen = tags->find(frame.color);
  for (std::size_t i = 0; i < objects.size(); ++i) {
    if (objects[i].tag) out[i] = pose_by_tag(i, seen, frame, scene);
  }
  for (std::size_t i = 0; i < objects.size(); ++i) {
    if (out[i]) claim(scene, i, out[i]->X_WO);
  }
}

/// Objects without a tag that may be the cluster, as coarse pictures show: none that another one
/// explains far better.
std::vector<Rival> ObjectFinder::Impl::rivals(const DepthScene& scene, int cluster) {
  std::vector<Rival> out;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    if (settled[i] || !may_hold(scene, cluster, shapes[i])) continue;
    out.push_back({i, rough_search(scene, cluster, shapes[i], raster)});
  }
  drop_hopeless(out);
  for (Rival& rival : out) {
    rival.starts =
        coarse_search(scene, cluster, shapes[rival.object], std::move(rival.starts), raster);
  }
  drop_hopeless(out);
  return out;
}

std::vector<Match> ObjectFinder::Impl::matches(const DepthScene& scene,
                                               std::vector<ObjectPose>& out) {
  std::vector<Match> found;
  for (int c = 0; c < static_cast<int>(scene.clusters.size()); ++c) {
    std::vector<Match> here;
    double best = 1e18;
    for (auto& [i, starts] : rivals(scene, c)) {
      const std::vector<ShapeFit> fits =
          fine_search(scene, c, shapes[i], std::move(starts), raster);
      if (!is_possible(scene, shapes[i], fits[0])) continue;
      if (!is_whole(fits[0])) {
        const bool unseen = !out[i] && out[i].error().code == FindErrc::not_seen;
        if (unseen && fits[0].seen >= kLeastSeen && fits[0].unexplained < kTouching) {
          out[i] = fail(
              FindFailure{.code = FindErrc::touching, .best = found_pose(scene, fits[0], false)});
        }
        continue;
      }
      const bool twofold = fits.size() > 1 && is_possible(scene, shapes[i], fits[1]) &&
                           is_whole(fits[1]) && fits[1].cost < fits[0].cost + margin(fits[0].cost);
      here.push_back({i, c, fits[0], twofold});
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
    return other.object == match.object &&
           is_same(shapes[match.object], other.fit.X_CO, match.fit.X_CO);
  });
  if (known == found.end()) {
    found.push_back(match);
  } else if (match.fit.uncertainty < known->fit.uncertainty) {
    *known = match;
  }
}

/// @param last  no later round will look at what is doubtful once more
void ObjectFinder::Impl::find_by_shapes(DepthScene& scene, bool last,
                                        std::vector<ObjectPose>& out) {
  const std::vector<Match> found = matches(scene, out);
  const auto alone = [&](const Match& match) {
    return std::none_of(found.begin(), found.end(), [&](const Match& other) {
      return (other.object == match.object) != (other.cluster == match.cluster);
    });
  };
  std::vector<std::pair<std::size_t, Pose>> claims;
  for (const Match& match : found) {
    const FoundPose pose = found_pose(scene, match.fit, false);
    std::optional<FindErrc> fault;
    if (match.twofold || !alone(match)) fault = FindErrc::ambiguous;
    if (match.fit.uncertainty > kMostUncertain || match.fit.seen < kLeastSeen ||
        match.fit.outside > kMostOutside) {
      fault = match.fit.seen < kWhole ? FindErrc::occluded : FindErrc::ambiguous;
    }
    if (fault) {
      out[match.object] = fail(FindFailure{.code = *fault, .best = pose});
    } else {
      out[match.object] = pose;
    }
    if (!fault || last) claims.emplace_back(match.object, pose.X_WO);
  }
  for (const auto& [object, X_WO] : claims) {
    settled[object] = 1;
    claim(scene, object, X_WO);
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
  auto impl = std::make_unique<Impl>(Impl{
      .objects = std::move(objects), .options = options, .model = DepthModel(options.depth_sigma)});
  for (const KnownObject& object : impl->objects) {
    impl->shapes.emplace_back(object.surface);
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

Result<FoundScene> ObjectFinder::find(const render::RgbdFrame& frame,
                                      std::span<const float> known) {
  if (Result<void> checked = check_frame(frame); !checked) return fail(std::move(checked.error()));
  if (!known.empty() && known.size() != frame.depth.size()) {
    return fail(Errc::bad_input, text(msg::perception_bad_known, known.size(), frame.depth.size()));
  }
  Rng rng(impl_->options.seed);
  DepthScene scene = depth_scene(frame, impl_->model, impl_->options.table, rng);
  if (!known.empty()) {
    std::vector<float> inverse(known.size());
    std::ranges::transform(known, inverse.begin(), inverse_depth);
    leave_out(scene, inverse);
  }
  std::vector<ObjectPose> poses(impl_->objects.size(), fail(FindFailure{}));
  impl_->find_by_tags(frame, scene, poses);
  // First what is seen in one piece of one hue, in one piece of any, and then pieces that may be
  // parts of one thing, the nearer part hiding how they are joined.
  gather(scene, kSmoothJump, &frame.color);
  impl_->find_by_shapes(scene, false, poses);
  for (const double jump : {kSmoothJump, kPieceJump}) {
    gather(scene, jump);
    impl_->find_by_shapes(scene, jump == kPieceJump, poses);
  }
  gather(scene, kSmoothJump);
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

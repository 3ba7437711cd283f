#include "mjarm/session/see_scene.hpp"

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "mjarm/core/messages/show.hpp"
#include "mjarm/core/rng.hpp"
#include "mjarm/model/scene_bodies.hpp"
#include "mjarm/model/surface.hpp"
#include "mjarm/perception/symmetry.hpp"
#include "mjarm/render/rgbd.hpp"
#include "mjarm/sim/sim.hpp"

namespace mjarm::session {
namespace {

constexpr double kAway = -50;  // [m] height at which nothing is seen

/// All that can be carried; those that look alike are one kind, named after the first of them.
Result<std::vector<perception::KnownObject>> known_objects(
    const Robot& robot, const std::vector<SceneObject>& objects) {
  std::vector<perception::KnownObject> out;
  for (const SceneObject& object : objects) {
    Result<perception::KnownObject> known = perception::known_object(robot.model, object.name);
    if (!known) return fail(std::move(known.error()));
    const auto alike = std::ranges::find_if(out, [&](const perception::KnownObject& other) {
      return look_alike(robot.model, other.name, object.name);
    });
    known->kind = alike == out.end() ? object.name : alike->kind;
    out.push_back(std::move(*known));
  }
  if (out.empty()) return fail(Errc::bad_input, text(msg::show_nothing_to_see));
  return out;
}

/// Whether the camera looks through a point of the world: something farther is seen there.
bool sees_through(const render::RgbdFrame& frame, const Eigen::Vector3d& p_W) {
  const Eigen::Vector3d p_C = frame.X_WC.inverse() * p_W;
  if (!(p_C.z() > 0)) return false;
  const Eigen::Vector2d at = frame.intrinsics.project(p_C).array().round();
  const bool inside = at.x() >= 0 && at.y() >= 0 && at.x() < frame.intrinsics.width &&
                      at.y() < frame.intrinsics.height;
  if (!inside) return false;
  const auto pixel =
      static_cast<std::size_t>(at.y()) * static_cast<std::size_t>(frame.intrinsics.width) +
      static_cast<std::size_t>(at.x());
  return frame.depth[pixel] > p_C.z();
}

/// Where an object without a pose stands.
struct Belief {
  Pose X_WB;
  bool anywhere = false;  ///< nothing is known of it
};

}  // namespace

struct SceneEye::Impl {
  Robot robot;
  Sim sim;
  render::RgbdCamera camera;
  render::RgbdCamera bare;  ///< for what is known without looking: all but the objects
  perception::ObjectFinder finder;
  std::vector<SceneObject> objects;               ///< in the finder's order
  std::map<std::string, std::vector<Pose>> same;  ///< by name
  std::map<std::string, Pose> home;               ///< where the model has them, by name
  std::map<std::string, Pose> last = {};          ///< where they were last seen, by name
  Rng noise;
  perception::FoundScene found = {};

  [[nodiscard]] Belief believed(const perception::FoundObject& unseen,
                                const render::RgbdFrame& frame) const;
};

/// A doubtful pose is no news where a sure one is known.
Belief SceneEye::Impl::believed(const perception::FoundObject& unseen,
                                const render::RgbdFrame& frame) const {
  constexpr double kSamePlace = 0.02;  // [m]
  const auto sure = last.find(unseen.name);
  const bool known = sure != last.end();
  if (const std::optional<perception::FoundPose>& best = unseen.pose.error().best) {
    const bool near = known && (sure->second.p - best->X_WO.p).norm() < kSamePlace;
    return {.X_WB = near ? sure->second : best->X_WO};
  }
  Belief out{.X_WB = known ? sure->second : home.at(unseen.name), .anywhere = !known};
  if (sees_through(frame, out.X_WB.p)) {
    out.X_WB.p.z() = kAway;
    out.anywhere = true;
  }
  return out;
}

SceneEye::SceneEye(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
SceneEye::~SceneEye() = default;
SceneEye::SceneEye(SceneEye&&) noexcept = default;
SceneEye& SceneEye::operator=(SceneEye&&) noexcept = default;

Result<SceneEye> SceneEye::open(const Robot& robot, const std::string& camera,
                                const SceneEyeOptions& options) {
  std::vector<SceneObject> objects = scene_bodies(robot.model, robot.arm).objects;
  Result<std::vector<perception::KnownObject>> known = known_objects(robot, objects);
  if (!known) return fail(std::move(known.error()));
  std::map<std::string, std::vector<Pose>> same;
  std::map<std::string, Pose> home;
  Sim sim(robot.model);
  sim.reset_home();
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const perception::KnownObject& object = (*known)[i];
    home[object.name] = sim.body_pose(objects[i].body);
    const auto alike = same.find(object.kind);
    same[object.name] =
        alike == same.end() ? perception::symmetries(object.surface) : alike->second;
  }
  Result<render::RgbdCamera> eye = render::RgbdCamera::create(
      robot.model, camera,
      {.depth_sigma = options.depth_sigma, .quality = render::RenderQuality::low});
  if (!eye) return fail(std::move(eye.error()));
  auto bare = render::RgbdCamera::create(robot.model, camera,
                                         {.depth_sigma = 0, .quality = render::RenderQuality::low});
  if (!bare) return fail(std::move(bare.error()));
  auto finder = perception::ObjectFinder::create(
      std::move(*known), {.depth_sigma = options.depth_sigma, .seed = options.seed});
  if (!finder) return fail(std::move(finder.error()));
  return SceneEye(std::make_unique<Impl>(Impl{robot,
                                              std::move(sim),
                                              std::move(*eye),
                                              std::move(*bare),
                                              std::move(*finder),
                                              std::move(objects),
                                              std::move(same),
                                              std::move(home),
                                              {},
                                              Rng(options.seed)}));
}

Result<program::SeenScene> SceneEye::look(const SceneState& scene, std::span<const double> q) {
  Sim& sim = impl_->sim;
  sim.reset_home();
  if (!scene.qpos.empty()) {
    const std::vector<double> still(sim.qvel().size(), 0.0);
    sim.set_state(scene.qpos, still);
  }
  sim.place(impl_->robot.arm, q);
  const Result<render::RgbdFrame> frame = impl_->camera.look(sim.snapshot(), impl_->noise);
  if (!frame) return fail(frame.error());
  const Snapshot full = sim.snapshot();
  std::vector<std::optional<Pose>> believed;
  for (const SceneObject& object : impl_->objects) {
    believed.emplace_back(sim.body_pose(object.body));
  }
  for (const auto& [name, poses] : impl_->same) sim.place_free(name, {.p = {0, 0, kAway}});
  const Result<render::RgbdFrame> known = impl_->bare.look(sim.snapshot(), impl_->noise);
  if (!known) return fail(known.error());
  if (Result<void> back = sim.restore(full); !back) return fail(std::move(back.error()));
  Result<perception::FoundScene> found = impl_->finder.find(*frame, known->depth, believed);
  if (!found) return fail(std::move(found.error()));
  impl_->found = std::move(*found);
  program::SeenScene out;
  for (const perception::FoundObject& one : impl_->found.objects) {
    if (one.pose) {
      sim.place_free(one.name, one.pose->X_WO);
      impl_->last[one.name] = one.pose->X_WO;
      if (!one.pose->by_tag) out.same[one.name] = impl_->same[one.name];
      continue;
    }
    const Belief belief = impl_->believed(one, *frame);
    sim.place_free(one.name, belief.X_WB);
    if (belief.anywhere) out.anywhere.insert(one.name);
    out.unseen[one.name] = perception::describe(one.pose.error().code);
  }
  out.scene = {.qpos = {sim.qpos().begin(), sim.qpos().end()}, .attached = scene.attached};
  return out;
}

const perception::FoundScene& SceneEye::found() const { return impl_->found; }

Result<program::SeenScene> see_scene(const Robot& robot, const std::string& camera,
                                     const SceneState& scene, std::span<const double> q) {
  Result<SceneEye> eye = SceneEye::open(robot, camera);
  if (!eye) return fail(std::move(eye.error()));
  return eye->look(scene, q);
}

}  // namespace mjarm::session

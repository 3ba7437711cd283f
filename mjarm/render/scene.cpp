#include "mjarm/render/scene.hpp"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "mjarm/core/messages/render.hpp"
#include "mjarm/core/units.hpp"
#include "mjarm/model/mujoco_guard.hpp"
#include "mjarm/render/ghost_internal.hpp"
#include "mjarm/render/overlay_internal.hpp"
#include "mjarm/sim/raw_state.hpp"

namespace mjarm::render {
namespace {

struct DeleteData {
  void operator()(mjData* data) const { mj_deleteData(data); }
};

/// A copy of the model's head that shares its arrays, with the quality set. Where the processor
/// draws, faces cost most: with half as many in each direction nobody sees a difference at the
/// usual sizes, and a frame takes half the time.
mjModel with_quality(const mjModel& original, RenderQuality quality, bool software) {
  mjModel m = original;
  auto& asked = m.vis.quality;
  const auto at_most = [&asked](int slices, int stacks) {
    asked.numslices = std::min(asked.numslices, slices);
    asked.numstacks = std::min(asked.numstacks, stacks);
  };
  if (quality == RenderQuality::exact) {
    asked.numslices = 128;  // a ball of 0.3 m is flattened by 0.09 mm
    asked.numstacks = 64;
  } else if (quality == RenderQuality::low) {
    // Not used at first; a window may switch shadows on.
    asked.shadowsize = std::min(asked.shadowsize, 1024);
    software ? at_most(12, 6) : at_most(16, 8);
  } else if (software) {
    const int max = quality == RenderQuality::high ? 2048 : 1024;
    asked.shadowsize = std::min(asked.shadowsize, max);
    at_most(24, 12);
  }
  asked.offsamples = quality == RenderQuality::high ? std::max(asked.offsamples, 8) : 0;
  return m;
}

bool is_infinite_plane(const mjvGeom& geom) {
  return geom.type == mjGEOM_PLANE && geom.size[0] == 0 && geom.size[1] == 0;
}

bool is_floor(const mjvGeom& geom) {
  constexpr float kLarge = 2;  // [m] from its middle to its edges
  return is_infinite_plane(geom) ||
         (geom.type == mjGEOM_PLANE && geom.size[0] >= kLarge && geom.size[1] >= kLarge);
}

/// [m] Radius about its position in which all of a geom lies; infinite where that is not known.
double radius_of(const mjModel& m, const mjvGeom& geom) {
  if (geom.type == mjGEOM_PLANE || geom.type >= mjGEOM_FLEX) return mjMAXVAL;
  if (geom.objtype == mjOBJ_GEOM) return m.geom_rbound[geom.objid];
  return geom.size[0] + geom.size[1] + geom.size[2];
}

/// [m] From the axis of a light to the farthest end of what casts shadows.
double reach_of(const mjModel& m, const mjvScene& scene, const mjvLight& light) {
  const Eigen::Vector3f origin = Eigen::Map<const Eigen::Vector3f>(light.pos);
  const Eigen::Vector3f axis = Eigen::Map<const Eigen::Vector3f>(light.dir);
  double reach = 0;
  for (const mjvGeom& geom : std::span(scene.geoms, static_cast<std::size_t>(scene.ngeom))) {
    if (geom.castshadow == 0) continue;
    const Eigen::Vector3f way = Eigen::Map<const Eigen::Vector3f>(geom.pos) - origin;
    const double across = (way - way.dot(axis) * axis).norm();
    reach = std::max(reach, across + radius_of(m, geom));
  }
  return reach;
}

/// Geoms that the model alone may fill, with room for what MuJoCo adds (frames, tendons, contacts).
std::size_t geoms_of(const mjModel& m) {
  return 2000 + static_cast<std::size_t>(m.ngeom + 2 * m.nsite + 4 * m.nwrap + 2 * m.njnt);
}

/// True where a geom of the scene belongs to one of the model that nothing can touch.
bool is_for_show(const mjModel& m, const mjvGeom& geom) {
  return geom.objtype == mjOBJ_GEOM && geom.objid >= 0 && m.geom_contype[geom.objid] == 0 &&
         m.geom_conaffinity[geom.objid] == 0;
}

mjvCamera free_camera(const CameraView& view) {
  mjvCamera camera;
  mjv_defaultCamera(&camera);
  camera.type = mjCAMERA_FREE;
  Eigen::Map<Eigen::Vector3d>(camera.lookat) = view.lookat_W;
  camera.distance = view.distance;
  camera.azimuth = view.azimuth / kRadPerDeg;
  camera.elevation = view.elevation / kRadPerDeg;
  return camera;
}

}  // namespace

struct Scene::Impl {
  Impl(const Model& source, RenderQuality quality_asked, bool software)
      : owner(source),
        quality(quality_asked),
        reflections(quality_asked == RenderQuality::high && !software),
        m(with_quality(*source.raw(), quality_asked, software)),
        d(mj_makeData(&m)) {
    mjv_defaultOption(&option);
    mjv_defaultPerturb(&perturb);
    mjv_defaultScene(&scene);
    camera = free_camera(default_view(owner));
    make_room(1000);
    update_positions();
  }
  ~Impl() { mjv_freeScene(&scene); }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  /// Makes room for an overlay of this many geoms beside the model.
  void make_room(std::size_t overlay_geoms) {
    const std::size_t needed = geoms_of(m) + overlay_geoms;
    if (static_cast<std::size_t>(scene.maxgeom) >= needed) return;
    const mjvScene before = scene;
    mjv_freeScene(&scene);
    mjv_defaultScene(&scene);
    mjv_makeScene(&m, &scene, static_cast<int>(needed + overlay_geoms));
    if (before.maxgeom > 0) {
      std::copy(std::begin(before.flags), std::end(before.flags), scene.flags);
      return;
    }
    scene.flags[mjRND_SHADOW] = quality == RenderQuality::medium || quality == RenderQuality::high;
    scene.flags[mjRND_REFLECTION] = reflections;
  }

  /// Puts the floor behind everything else, so that what is hidden of it costs nothing (not with
  /// reflections: MuJoCo reflects in the first that can). It casts no shadow, nor does a large one
  /// that ends: nothing lies below, and on itself that would be specks.
  void tame_floors() {
    const std::span geoms(scene.geoms, static_cast<std::size_t>(scene.ngeom));
    for (mjvGeom& geom : geoms) {
      if (is_floor(geom)) geom.castshadow = 0;
    }
    if (scene.flags[mjRND_REFLECTION] != 0) return;
    std::stable_partition(geoms.begin(), geoms.end(),
                          [](const mjvGeom& geom) { return !is_infinite_plane(geom); });
  }

  /// All that drawing needs of a state; contacts and forces are computed only where asked for.
  void update_positions() {
    if (dynamics && !call_mujoco([this] { mj_forward(&m, d.get()); }).failed) return;
    mj_kinematics(&m, d.get());
    mj_comPos(&m, d.get());
    mj_camlight(&m, d.get());
    mj_flex(&m, d.get());
    mj_tendon(&m, d.get());
    mj_transmission(&m, d.get());
  }

  Model owner;  ///< keeps the arrays of `m` alive
  RenderQuality quality;
  bool reflections;
  mjModel m;
  std::unique_ptr<mjData, DeleteData> d;
  mjvOption option{};
  mjvCamera camera{};
  mjvPerturb perturb{};
  mjvScene scene{};
  Ghosts ghosts{m};
  bool dynamics = false;
  bool only_colliding = false;
};

Scene::Scene(const Model& model, RenderQuality quality, bool software)
    : impl_(std::make_unique<Impl>(model, quality, software)) {}
Scene::~Scene() = default;
Scene::Scene(Scene&&) noexcept = default;
Scene& Scene::operator=(Scene&&) noexcept = default;

Result<void> Scene::set_state(const Snapshot& snapshot) {
  if (!raw::set_state_or_start(impl_->m, snapshot, *impl_->d)) {
    return fail(Errc::bad_input, text(msg::render_bad_snapshot, snapshot.state.size(),
                                      mj_stateSize(&impl_->m, mjSTATE_INTEGRATION)));
  }
  impl_->update_positions();
  return {};
}

Result<void> Scene::set_camera(const Camera& camera) {
  if (Result<void> checked = check_camera(impl_->owner, camera); !checked) return checked;
  if (camera.view || camera.name.empty()) {
    impl_->camera = free_camera(camera.view.value_or(default_view(impl_->owner)));
    return {};
  }
  mjv_defaultCamera(&impl_->camera);
  impl_->camera.type = mjCAMERA_FIXED;
  impl_->camera.fixedcamid = mj_name2id(&impl_->m, mjOBJ_CAMERA, camera.name.c_str());
  return {};
}

CameraView Scene::view() const {
  const mjvCamera& camera = impl_->camera;
  if (camera.type != mjCAMERA_FIXED) {
    return {.lookat_W = Eigen::Map<const Eigen::Vector3d>(camera.lookat),
            .distance = camera.distance,
            .azimuth = camera.azimuth * kRadPerDeg,
            .elevation = camera.elevation * kRadPerDeg};
  }
  using Eigen::Vector3d;
  const Vector3d p_WC = Eigen::Map<const Vector3d>(impl_->d->cam_xpos + 3 * camera.fixedcamid);
  const mjtNum* R_WC = impl_->d->cam_xmat + 9 * camera.fixedcamid;  // row by row; looks along -z
  const Vector3d forward(-R_WC[2], -R_WC[5], -R_WC[8]);
  const Vector3d middle = Eigen::Map<const Vector3d>(impl_->m.stat.center);
  const double nearest = 0.1 * impl_->m.stat.extent;
  const double distance = std::max((middle - p_WC).dot(forward), nearest);
  return {.lookat_W = p_WC + distance * forward,
          .distance = distance,
          .azimuth = std::atan2(forward.y(), forward.x()),
          .elevation = std::asin(std::clamp(forward.z(), -1.0, 1.0))};
}

void Scene::update(const Overlay& overlay) {
  impl_->make_room(geoms_of(overlay, impl_->m));
  const mjModel& m = impl_->m;
  mjvScene& scene = impl_->scene;
  mjvOption option = impl_->option;
  if (impl_->only_colliding) std::fill_n(option.geomgroup, mjNGROUP, mjtByte{1});
  mjv_updateScene(&m, impl_->d.get(), &option, &impl_->perturb, &impl_->camera, mjCAT_ALL, &scene);
  if (impl_->only_colliding) {
    mjvGeom* end = std::remove_if(scene.geoms, scene.geoms + scene.ngeom,
                                  [&m](const mjvGeom& geom) { return is_for_show(m, geom); });
    scene.ngeom = static_cast<int>(end - scene.geoms);
  }
  impl_->tame_floors();
  impl_->ghosts.draw(overlay.ghosts, option, *impl_->d, scene);
  add_overlay(overlay, scene);
}

void Scene::set_dynamics(bool on) {
  if (on && !impl_->dynamics) {
    impl_->dynamics = true;
    impl_->update_positions();
  }
  impl_->dynamics = on;
}
void Scene::set_only_colliding(bool on) noexcept { impl_->only_colliding = on; }

double Scene::shadow_reach() const {
  const mjModel& m = impl_->m;
  const mjvScene& scene = impl_->scene;
  constexpr double kMargin = 1.02;  // the map's border holds nothing
  double reach = 0;
  for (const mjvLight& light : std::span(scene.lights, static_cast<std::size_t>(scene.nlight))) {
    if (light.castshadow == 0 || light.type != mjLIGHT_DIRECTIONAL) continue;
    reach = std::max(reach, kMargin * reach_of(m, scene, light));
  }
  const mjVisual& vis = impl_->owner.raw()->vis;
  const double asked = vis.map.shadowclip * m.stat.extent;
  if (reach == 0 || vis.quality.shadowsize <= 0) return asked;
  // A finer grid than the model asks for would let surfaces shade themselves.
  const double finest = asked * m.vis.quality.shadowsize / vis.quality.shadowsize;
  return std::min(std::max(reach, finest), asked);
}

const mjModel& Scene::model() const noexcept { return impl_->m; }
mjData& Scene::data() noexcept { return *impl_->d; }
mjvOption& Scene::option() noexcept { return impl_->option; }
mjvCamera& Scene::camera() noexcept { return impl_->camera; }
mjvPerturb& Scene::perturb() noexcept { return impl_->perturb; }
mjvScene& Scene::raw() noexcept { return impl_->scene; }

}  // namespace mjarm::render

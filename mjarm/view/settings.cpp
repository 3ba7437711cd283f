#include "mjarm/view/settings.hpp"

#include <mujoco/mujoco.h>

#include <algorithm>

#include "mjarm/core/messages/view.hpp"
#include "mjarm/view/settings_internal.hpp"

namespace mjarm::view {
namespace {

constexpr SettingRow kRows[] = {
    {ViewFlag::contact_points, 'C', msg::view_label_contact_points, msg::view_set_contact_points},
    {ViewFlag::contact_forces, 'F', msg::view_label_contact_forces, msg::view_set_contact_forces},
    {ViewFlag::contact_split, 'P', msg::view_label_contact_split, msg::view_set_contact_split},
    {ViewFlag::transparent, 'T', msg::view_label_transparent, msg::view_set_transparent},
    {ViewFlag::joints, 'J', msg::view_label_joints, msg::view_set_joints},
    {ViewFlag::actuators, 'U', msg::view_label_actuators, msg::view_set_actuators},
    {ViewFlag::center_of_mass, 'M', msg::view_label_center_of_mass, msg::view_set_center_of_mass},
    {ViewFlag::inertia, 'I', msg::view_label_inertia, msg::view_set_inertia},
    {ViewFlag::convex_hull, 'H', msg::view_label_convex_hull, msg::view_set_convex_hull},
    {ViewFlag::collision_geoms, 'N', msg::view_label_collision_geoms,
     msg::view_set_collision_geoms},
    {ViewFlag::static_bodies, 'D', msg::view_label_static_bodies, msg::view_set_static_bodies},
    {ViewFlag::auto_connect, 'A', msg::view_label_auto_connect, msg::view_set_auto_connect},
    {ViewFlag::constraints, 'E', msg::view_label_constraints, msg::view_set_constraints},
    {ViewFlag::tendons, 'V', msg::view_label_tendons, msg::view_set_tendons},
    {ViewFlag::range_finders, 'Y', msg::view_label_range_finders, msg::view_set_range_finders},
    {ViewFlag::cameras, 'Q', msg::view_label_cameras, msg::view_set_cameras},
    {ViewFlag::lights, 'Z', msg::view_label_lights, msg::view_set_lights},
    {ViewFlag::push_force, 'B', msg::view_label_push_force, msg::view_set_push_force},
    {ViewFlag::push_object, 'O', msg::view_label_push_object, msg::view_set_push_object},
    {ViewFlag::texture, 'X', msg::view_label_texture, msg::view_set_texture},
    {ViewFlag::shadow, 'S', msg::view_label_shadow, msg::view_set_shadow},
    {ViewFlag::reflection, 'R', msg::view_label_reflection, msg::view_set_reflection},
    {ViewFlag::wireframe, 'W', msg::view_label_wireframe, msg::view_set_wireframe},
    {ViewFlag::skybox, 'K', msg::view_label_skybox, msg::view_set_skybox},
    {ViewFlag::fog, 'G', msg::view_label_fog, msg::view_set_fog},
    {ViewFlag::haze, '/', msg::view_label_haze, msg::view_set_haze},
};
static_assert(std::size(kRows) == kViewFlags);

/// Where MuJoCo keeps a flag: among those of mjvOption, among those of mjvScene, or nowhere.
struct Place {
  int option = -1;
  int scene = -1;
};
constexpr Place kPlaces[] = {
    {mjVIS_CONTACTPOINT},  {mjVIS_CONTACTFORCE},
    {mjVIS_CONTACTSPLIT},  {mjVIS_TRANSPARENT},
    {mjVIS_JOINT},         {mjVIS_ACTUATOR},
    {mjVIS_COM},           {mjVIS_INERTIA},
    {mjVIS_CONVEXHULL},    {-1},
    {mjVIS_STATIC},        {mjVIS_AUTOCONNECT},
    {mjVIS_CONSTRAINT},    {mjVIS_TENDON},
    {mjVIS_RANGEFINDER},   {mjVIS_CAMERA},
    {mjVIS_LIGHT},         {mjVIS_PERTFORCE},
    {mjVIS_PERTOBJ},       {mjVIS_TEXTURE},
    {-1, mjRND_SHADOW},    {-1, mjRND_REFLECTION},
    {-1, mjRND_WIREFRAME}, {-1, mjRND_SKYBOX},
    {-1, mjRND_FOG},       {-1, mjRND_HAZE},
};
static_assert(std::size(kPlaces) == kViewFlags);

}  // namespace

std::span<const SettingRow> setting_rows() noexcept { return kRows; }
std::span<const char* const> view_label_names() noexcept { return mjLABELSTRING; }
std::span<const char* const> view_frame_names() noexcept { return mjFRAMESTRING; }

ViewSettings settings_of(render::Scene& scene) {
  ViewSettings settings;
  const mjvOption& option = scene.option();
  for (std::size_t i = 0; i < kViewFlags; ++i) {
    const Place& place = kPlaces[i];
    if (place.option >= 0) settings.flags[i] = option.flags[place.option] != 0;
    if (place.scene >= 0) settings.flags[i] = scene.raw().flags[place.scene] != 0;
  }
  for (std::size_t i = 0; i < kViewGroups; ++i) {
    settings.geom_groups[i] = option.geomgroup[i] != 0;
    settings.site_groups[i] = option.sitegroup[i] != 0;
  }
  settings.label = option.label;
  settings.frame = option.frame;
  return settings;
}

void apply(const ViewSettings& settings, render::Scene& scene) {
  mjvOption& option = scene.option();
  for (std::size_t i = 0; i < kViewFlags; ++i) {
    const Place& place = kPlaces[i];
    const mjtByte on = settings.flags[i] ? 1 : 0;
    if (place.option >= 0) option.flags[place.option] = on;
    if (place.scene >= 0) scene.raw().flags[place.scene] = on;
  }
  for (std::size_t i = 0; i < kViewGroups; ++i) {
    option.geomgroup[i] = settings.geom_groups[i] ? 1 : 0;
    option.sitegroup[i] = settings.site_groups[i] ? 1 : 0;
  }
  option.label = std::clamp(settings.label, 0, mjNLABEL - 1);
  option.frame = std::clamp(settings.frame, 0, mjNFRAME - 1);
  scene.set_only_colliding(settings.shows(ViewFlag::collision_geoms));
}

bool needs_dynamics(const ViewSettings& settings) {
  return settings.shows(ViewFlag::contact_points) || settings.shows(ViewFlag::contact_forces) ||
         settings.label == mjLABEL_CONTACTPOINT || settings.label == mjLABEL_CONTACTFORCE ||
         settings.label == mjLABEL_ISLAND || settings.frame == mjFRAME_CONTACT;
}

}  // namespace mjarm::view

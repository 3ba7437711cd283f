#include "mjarm/view/settings.hpp"

#include <mujoco/mujoco.h>

#include <algorithm>

#include "mjarm/core/messages/view.hpp"
#include "mjarm/view/settings_internal.hpp"

namespace mjarm::view {
namespace {

constexpr SettingRow kRows[] = {
    {ViewFlag::contact_points, 'C', "Contact points", msg::view_set_contact_points},
    {ViewFlag::contact_forces, 'F', "Contact forces", msg::view_set_contact_forces},
    {ViewFlag::contact_split, 'P', "Split forces", msg::view_set_contact_split},
    {ViewFlag::transparent, 'T', "Transparent", msg::view_set_transparent},
    {ViewFlag::joints, 'J', "Joint axes", msg::view_set_joints},
    {ViewFlag::actuators, 'U', "Actuators", msg::view_set_actuators},
    {ViewFlag::center_of_mass, 'M', "Mass centres", msg::view_set_center_of_mass},
    {ViewFlag::inertia, 'I', "Inertia", msg::view_set_inertia},
    {ViewFlag::convex_hull, 'H', "Convex hulls", msg::view_set_convex_hull},
    {ViewFlag::collision_geoms, 'N', "Collision", msg::view_set_collision_geoms},
    {ViewFlag::static_bodies, 'D', "Static bodies", msg::view_set_static_bodies},
    {ViewFlag::auto_connect, 'A', "Auto connect", msg::view_set_auto_connect},
    {ViewFlag::constraints, 'E', "Equalities", msg::view_set_constraints},
    {ViewFlag::tendons, 'V', "Tendons", msg::view_set_tendons},
    {ViewFlag::range_finders, 'Y', "Range finders", msg::view_set_range_finders},
    {ViewFlag::cameras, 'Q', "Cameras", msg::view_set_cameras},
    {ViewFlag::lights, 'Z', "Lights", msg::view_set_lights},
    {ViewFlag::push_force, 'B', "Push force", msg::view_set_push_force},
    {ViewFlag::push_object, 'O', "Push object", msg::view_set_push_object},
    {ViewFlag::texture, 'X', "Textures", msg::view_set_texture},
    {ViewFlag::shadow, 'S', "Shadows", msg::view_set_shadow},
    {ViewFlag::reflection, 'R', "Reflections", msg::view_set_reflection},
    {ViewFlag::wireframe, 'W', "Wireframe", msg::view_set_wireframe},
    {ViewFlag::skybox, 'K', "Skybox", msg::view_set_skybox},
    {ViewFlag::fog, 'G', "Fog", msg::view_set_fog},
    {ViewFlag::haze, '/', "Haze", msg::view_set_haze},
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

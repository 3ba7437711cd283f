#include "mjarm/serve/scene_json.hpp"

#include <algorithm>
#include <cmath>

#include "mjarm/core/json_writer.hpp"
#include "mjarm/serve/byte_order_internal.hpp"

namespace mjarm::serve {
namespace {

const char* word_of(DrawnShape shape) {
  switch (shape) {
    case DrawnShape::plane:
      return "plane";
    case DrawnShape::sphere:
      return "sphere";
    case DrawnShape::capsule:
      return "capsule";
    case DrawnShape::cylinder:
      return "cylinder";
    case DrawnShape::ellipsoid:
      return "ellipsoid";
    case DrawnShape::box:
      return "box";
    case DrawnShape::mesh:
      break;
  }
  return "mesh";
}

void add_options(JsonWriter& json, const DrawnModel& model, const SceneFacts& facts) {
  json.key("options").object();
  json.member("can_step", facts.can_step).member("can_reset", facts.can_reset);
  json.member("can_push", facts.can_push).member("can_target", facts.can_target);
  json.member("can_lead", facts.can_lead);
  json.member("turns", facts.turns).key("joints").list();
  for (const DrawnJoint& joint : slider_joints(model, facts)) {
    json.object().member("dof", joint.dof).member("qpos", joint.qpos).member("name", joint.name);
    json.member("lower", joint.lower).member("upper", joint.upper);  // null where there is no stop
    json.member("angle", joint.angle).end_object();
  }
  json.end_list().end_object();
}

void add_geom(JsonWriter& json, const DrawnGeom& geom) {
  json.line_break().object().member("body", geom.body).member("name", geom.name);
  json.member("group", geom.group).member("kind", word_of(geom.shape)).member("size", geom.size);
  json.pose_members(geom.X_BG).key("rgba").list();
  for (const float part : geom.rgba) json.value(std::round(1e4 * part) / 1e4);
  json.end_list();
  if (geom.shape == DrawnShape::mesh) json.member("mesh", geom.mesh);
  json.end_object();
}

void add_view(JsonWriter& json, const render::CameraView& view) {
  json.key("view").object().member("lookat", view.lookat_W).member("distance", view.distance);
  json.member("azimuth", view.azimuth).member("elevation", view.elevation).end_object();
}

}  // namespace

std::vector<DrawnJoint> slider_joints(const DrawnModel& model, const SceneFacts& facts) {
  std::vector<DrawnJoint> out;
  for (const DrawnJoint& joint : model.joints) {
    if (std::ranges::find(facts.jog_dofs, joint.dof) != facts.jog_dofs.end()) out.push_back(joint);
  }
  return out;
}

std::string scene_json(const DrawnModel& model, const SceneFacts& facts) {
  std::string out;
  JsonWriter json(out);
  json.object().member("protocol", 1).member("title", facts.title).member("name", facts.name);
  json.member("language", facts.language == Language::chinese ? "zh" : "en");
  add_options(json, model, facts);
  json.key("bodies").list();
  for (const DrawnBody& body : model.bodies) json.value(body.name);
  json.end_list().key("masses").list();
  for (const DrawnBody& body : model.bodies) json.value(body.moves ? body.mass : 0);
  json.end_list().key("geoms").list();
  for (const DrawnGeom& geom : model.geoms) add_geom(json, geom);
  json.end_list().key("meshes").list();
  for (const DrawnMesh& mesh : model.meshes) {
    json.object().member("vertices", mesh.xyz.size() / 3);
    json.member("triangles", mesh.corners.size() / 3).end_object();
  }
  json.end_list().key("cameras").list();
  for (const DrawnCamera& camera : model.cameras) {
    json.object().member("name", camera.name).member("body", camera.body);
    json.pose_members(camera.X_BC).member("fovy", camera.fovy).end_object();
  }
  json.end_list();
  add_view(json, facts.view);
  json.member("nq", facts.nq).end_object();
  return out;
}

std::string mesh_bytes(const DrawnMesh& mesh) {
  std::string out;
  out.reserve(8 + 4 * (mesh.xyz.size() + mesh.corners.size()));
  append_whole(out, static_cast<std::uint32_t>(mesh.xyz.size() / 3));
  append_whole(out, static_cast<std::uint32_t>(mesh.corners.size() / 3));
  for (const float value : mesh.xyz) append_f32(out, value);
  for (const std::uint32_t corner : mesh.corners) append_whole(out, corner);
  return out;
}

}  // namespace mjarm::serve

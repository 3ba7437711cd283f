#include "mjarm/episode/led_episode.hpp"

#include <utility>
#include <vector>

#include "mjarm/core/file.hpp"
#include "mjarm/core/messages/episode.hpp"
#include "mjarm/episode/archive_internal.hpp"
#include "mjarm/episode/episode_file.hpp"
#include "mjarm/kinematics/fk.hpp"
#include "mjarm/model/mujoco_library.hpp"
#include "mjarm/model/scene_bodies.hpp"

namespace mjarm::episode {
namespace {

/// The samples as those of a demonstration.
Result<Demonstration> as_demonstration(const Robot& robot, const std::vector<SceneObject>& objects,
                                       std::span<const LedSample> samples) {
  Demonstration out;
  Sim sim(robot.model);
  for (const LedSample& from : samples) {
    if (from.q_ref.size() != robot.arm.dof()) return fail(Errc::bad_input, text(msg::episode_led));
    if (auto done = sim.restore(from.world); !done) return fail(std::move(done.error()));
    const JointState state = sim.arm_state(robot.arm);
    Sample one{.state = from.world,
               .qpos = {sim.qpos().begin(), sim.qpos().end()},
               .qvel = {sim.qvel().begin(), sim.qvel().end()},
               .ctrl = {sim.ctrl().begin(), sim.ctrl().end()},
               .q = state.q,
               .v = state.v,
               .q_ref = from.q_ref,
               .X_WT = sim.tool(robot.arm),
               .X_WT_ref = fk(robot.arm, as_span(from.q_ref)),
               .grip = from.grip,
               .objects = {}};
    for (const SceneObject& object : objects) one.objects.push_back(sim.body_pose(object.body));
    out.samples.push_back(std::move(one));
  }
  return out;
}

std::string led_json(const Robot& robot, const LedEpisode& about, std::uint64_t number,
                     const std::string& hash, const std::vector<SceneObject>& objects,
                     const Demonstration& done) {
  std::vector<std::string> joints;
  for (const ArmJoint& joint : robot.arm.joints) joints.push_back(joint.name);
  std::vector<JsonDoc> things;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    JsonDoc one = pose_json(done.samples.front().objects[i]);
    one.set("name", objects[i].name);
    things.push_back(std::move(one));
  }
  JsonDoc doc{{"schema", kSchema},
              {"task", kLedTask},
              {"language", {{"en", about.language}, {"zh", about.language}}},
              {"robot", about.robot},
              {"number", static_cast<std::size_t>(number)},
              {"fps", about.fps},
              {"rows", done.samples.size()},
              {"success", true},
              {"reason", ""}};
  doc.set_all({{"model", std::string(robot.model.name())},
               {"model_hash", hash},
               {"mujoco", mujoco_library().version},
               {"timestep", robot.model.timestep()},
               {"tool", robot.arm.tip},
               {"joints", joints},
               {"columns", columns_doc()},
               {"cameras", std::vector<JsonDoc>()},
               {"scene", {{"objects", std::move(things)}, {"start", done.samples.front().q}}}});
  return doc.document();
}

std::uint64_t free_number(const std::filesystem::path& folder) {
  std::uint64_t number = 0;
  std::error_code code;
  while (std::filesystem::exists(folder / episode_name(number), code)) ++number;
  return number;
}

}  // namespace

Result<std::filesystem::path> keep_led_episode(const std::filesystem::path& folder,
                                               const Robot& robot, const LedEpisode& about,
                                               std::span<const LedSample> samples) {
  if (samples.empty()) return fail(Errc::bad_input, text(msg::episode_led));
  const std::vector<SceneObject> objects = scene_bodies(robot.model, robot.arm).objects;
  const Result<Demonstration> done = as_demonstration(robot, objects, samples);
  if (!done) return fail(done.error());
  const Result<std::string> hash = hash_of_model(robot.model);
  if (!hash) return fail(hash.error());
  if (auto made = make_folder(folder); !made) return fail(std::move(made.error()));
  const std::uint64_t number = free_number(folder);
  StoredZipWriter archive;
  archive.add("episode.json", led_json(robot, about, number, *hash, objects, *done));
  add_columns(*done, archive);
  std::filesystem::path file = folder / episode_name(number);
  if (auto written = write_file(file, std::move(archive).finish()); !written) {
    return fail(std::move(written.error()));
  }
  return file;
}

}  // namespace mjarm::episode

#include <algorithm>
#include <utility>

#include "apps/bench/messages/bench.hpp"
#include "apps/bench/plan_near.hpp"
#include "apps/bench/robots.hpp"
#include "mjarm/core/file.hpp"
#include "mjarm/core/log.hpp"
#include "mjarm/core/messages/core.hpp"
#include "mjarm/core/os.hpp"
#include "mjarm/core/os_program.hpp"

namespace mjarm::app {
namespace {

namespace fs = std::filesystem;

constexpr const char* kArchive = "franka_emika_panda.tar.xz";

/// Copies the folder of a shipped model; gives the copy.
Result<fs::path> copy_shipped(const std::string& robot, const fs::path& folder) {
  const Result<fs::path> scene = find_model_file(robot);
  if (!scene) return fail(scene.error());
  std::error_code failed;
  fs::copy(scene->parent_path(), folder, fs::copy_options::recursive, failed);
  if (failed)
    return fail(Errc::system, text(msg::core_at_place, folder.string(), failed.message()));
  return folder;
}

/// Puts `what` in front of the first `before` that follows `after`; false where there is none.
bool insert(std::string& text, const std::string& after, const std::string& before,
            const std::string& what) {
  std::size_t at = text.find(after);
  if (at == std::string::npos) return false;
  at = text.find(before, at + after.size());
  if (at == std::string::npos) return false;
  text.insert(at, what);
  return true;
}

Result<NearRobot> shipped_ur5e(const fs::path& folder) {
  const Result<fs::path> copy = copy_shipped("ur5e", folder);
  if (!copy) return fail(copy.error());
  return NearRobot{"ur5e, gripper", *copy / "ur5e_gripper.xml", "gripper_tcp"};
}

Result<NearRobot> shipped_panda(const fs::path& folder) {
  const Result<fs::path> copy = copy_shipped("panda", folder);
  if (!copy) return fail(copy.error());
  return NearRobot{"panda, hand", *copy / "panda.xml", "hand_tcp"};
}

/// The archive of Menagerie's Panda; empty where there is none.
fs::path find_archive(const fs::path& data) {
  std::vector<fs::path> places;
  if (!data.empty()) places = {data / "menagerie", data};
  if (const auto named = environment("MJARM_TEST_DATA"); named && !named->empty()) {
    places.push_back(fs::path(*named) / "menagerie");
  }
  const auto found = std::ranges::find_if(
      places, [](const fs::path& place) { return is_there(place / kArchive); });
  return found == places.end() ? fs::path() : *found / kArchive;
}

/// Its hand has no site: the tool is between the tips of the fingers.
Result<NearRobot> menagerie_panda(const fs::path& archive, const fs::path& folder) {
  if (auto made = make_folder(folder); !made) return fail(std::move(made.error()));
  const Result<int> code = run_program("tar", {"-xJf", archive.string(), "-C", folder.string()});
  if (!code) return fail(code.error());
  const fs::path file = folder / "franka_emika_panda" / "panda.xml";
  Result<std::string> content =
      *code == 0 ? read_file(file) : Result<std::string>(fail(no_cases(archive)));
  if (!content) return fail(std::move(content.error()));
  if (!insert(*content, R"(<body name="hand")", "<geom",
              R"(<site name="grasp" pos="0 0 0.1034"/>)")) {
    return fail(Errc::bad_input, text(msg::bench_plan_near_no_flange, file.string()));
  }
  if (auto written = write_file(file, *content); !written) return fail(std::move(written.error()));
  return NearRobot{"panda, Menagerie", file, "grasp"};
}

}  // namespace

Result<std::vector<NearRobot>> near_robots(const fs::path& data, const fs::path& folder) {
  std::vector<NearRobot> robots;
  for (Result<NearRobot> robot : {shipped_ur5e(folder / "ur5e"), shipped_panda(folder / "panda")}) {
    if (!robot) return fail(std::move(robot.error()));
    robots.push_back(std::move(*robot));
  }
  const fs::path archive = find_archive(data);
  if (archive.empty()) {
    log_warning(text(msg::bench_plan_near_no_menagerie, kArchive));
    return robots;
  }
  Result<NearRobot> robot = menagerie_panda(archive, folder / "menagerie");
  if (!robot) return fail(std::move(robot.error()));
  robots.push_back(std::move(*robot));
  return robots;
}

}  // namespace mjarm::app
